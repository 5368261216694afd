// SPDX-License-Identifier: MIT
// Volumes whose ends are held and moved: bars, and models in any format of io/read_volume.hpp, whose ends are the first
// and last tenth along their longest axis. Twisted, stretched and bent; bars then lead a handle over 60 frames.
//   taut_bench_volume [--quick] [--json FILE] [--poisson 0.3,0.45] [--compare SECONDS] [CUBES_ACROSS|MESH...]
// A bar has 30 n^3 tetrahedra for n cubes across; without arguments 8 and 16. --poisson: a neo-Hookean solid of these
// ratios, with either stand-in for its Hessian, in the place of the isometric energy. --compare: other solvers of the
// stretch, from an untangled start, each for so long.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/energy/neo_hookean.hpp>
#include <taut/io/read_volume.hpp>
#include <taut/map/deform.hpp>

#include "measure.hpp"
#include "peak_memory.hpp"
#include "volume_problem.hpp"
#include "volume_solvers.hpp"

namespace
{

using namespace taut;
using taut::idx;

/// The energies of a run, by name.
std::vector<std::pair<std::string, any_energy>> energies(const std::vector<double>& poisson)
{
    if (poisson.empty()) return {{"isometric", default_energy()}};
    std::vector<std::pair<std::string, any_energy>> all;
    for (const double ratio : poisson)
        for (const auto treated : {negative_eigenvalues::clamped, negative_eigenvalues::absolute})
        {
            std::ostringstream name;
            name << ratio << (treated == negative_eigenvalues::clamped ? " clamped" : " absolute");
            const auto lame = energy::neo_hookean::of_poisson(ratio);
            all.emplace_back(name.str(), any_energy(energy::neo_hookean_of_parameters{})
                                             .with_parameters({lame.begin(), lame.end()})
                                             .with_eigenvalues(treated));
        }
    return all;
}

void deform_ends(queue& q, const bench::volume_problem& p, const std::vector<double>& poisson,
                 nlohmann::ordered_json& results)
{
    for (const std::string motion : {"twist", "stretch", "bend"})
        for (const auto& [name, energy] : energies(poisson))
        {
            deform_params<tetrahedron> params;
            params.energy = energy;
            params.constraints = p.held(motion);
            const bench::peak_memory memory;
            session_result<tetrahedron> r;
            const double seconds = bench::seconds([&] { r = deform(q, p.mesh, params); });
            const auto& report = r.report;
            const bool good = report.converged && report.pins_held;
            std::printf("%-12s %8zu %-8s %-14s %3d steps  E %.6f  gradient %.1e  %s  %zu inverted  %6.2f s: start %.2f "
                        "follow %.2f repair %.2f solve %.2f certificate %.2f  %zu MB\n",
                        p.name.c_str(), p.mesh.cells().size(), motion.c_str(), name.c_str(), report.steps,
                        report.energy, report.gradient, good ? "converged" : "NOT CONVERGED", report.flips.flipped,
                        seconds, report.seconds.start, report.seconds.follow, report.seconds.repair,
                        report.seconds.solve, report.seconds.certificate, memory.bytes() >> 20);
            for (const auto& note : report.notes) std::printf("%22s%s\n", "", note.c_str());
            std::fflush(stdout);
            results.push_back({{"model", p.name},
                               {"tetrahedra", p.mesh.cells().size()},
                               {"motion", motion},
                               {"energy_name", name},
                               {"steps", report.steps},
                               {"energy", report.energy},
                               {"gradient", report.gradient},
                               {"converged", good},
                               {"inverted", report.flips.flipped},
                               {"seconds", seconds},
                               {"follow_seconds", report.seconds.follow},
                               {"solve_seconds", report.seconds.solve},
                               {"peak_bytes", memory.bytes()}});
        }
}

void compare(queue& q, const bench::volume_problem& p, double limit, nlohmann::ordered_json& results)
{
    bench::volume_solvers solvers(q, p, "stretch", limit);
    solvers.library(); // compiles kernels
    const auto ours = solvers.library();
    const double rest = 2, enough = ours.energy + 1e-6 * (ours.energy - rest); // errors are by what it is above rest
    std::vector<std::pair<std::string, bench::solver_run>> runs{
        {"library", ours}, {"lbfgs", solvers.lbfgs(enough)}, {"direct newton", solvers.direct_newton(enough)}};
    double best = ours.energy;
    for (const auto& [name, run] : runs)
        if (run.valid) best = std::min(best, run.energy);
    for (const auto& [name, run] : runs)
    {
        if (!run.valid) continue;
        std::printf("%-12s %8zu %-14s E %.6f after %d steps, %.2f s, %s; to", p.name.c_str(), p.mesh.cells().size(),
                    name.c_str(), run.energy, run.iterations, run.seconds.solve, run.stop.c_str());
        nlohmann::ordered_json row = {{"model", p.name},         {"tetrahedra", p.mesh.cells().size()},
                                      {"solver", name},          {"energy", run.energy},
                                      {"steps", run.iterations}, {"seconds", run.seconds.solve}};
        for (const double error : {1e-2, 1e-3, 1e-6})
        {
            const auto reached = bench::effort(run, best, error * (best - rest) / best);
            std::printf(" %g: %d / %.2f s", error, reached ? reached->iterations : -1,
                        reached ? reached->seconds : NAN);
            if (reached) row["to"][std::to_string(error)] = {reached->iterations, reached->seconds};
        }
        std::printf("\n");
        std::fflush(stdout);
        results.push_back(std::move(row));
    }
}

void frames(queue& q, int n, nlohmann::ordered_json& results)
{
    const auto p = bench::bar(n);
    const auto& m = p.mesh;
    session s(q, m, {.constraints = constraints<tetrahedron>(m).fix(p.low)});
    s.solve();
    const auto home = s.x();
    std::vector<double> times;
    std::size_t inverted = 0;
    for (int frame = 1; frame <= 60; ++frame)
    {
        std::vector<vec3> places;
        for (const idx v : p.high)
            places.push_back(home[static_cast<std::size_t>(v)] + vec3(0.02 * frame, 0.01 * frame, -0.005 * frame));
        times.push_back(
            1000 *
            bench::seconds([&] { inverted += s.move(p.high, places).solve({.steps = 2}).report.flips.flipped; }));
    }
    std::sort(times.begin(), times.end());
    const auto rest = s.solve();
    deform_params<tetrahedron> params;
    params.constraints = s.constraints();
    const auto scratch = deform(q, m, params);
    std::printf("%9zu session  60 frames of 2 steps: median %.1f ms, 95 %% %.1f ms, %zu inverted; E at rest %.7f, from "
                "scratch %.7f\n",
                m.cells().size(), times[30], times[57], inverted, rest.report.energy, scratch.report.energy);
    results.push_back({{"tetrahedra", m.cells().size()},
                       {"motion", "session"},
                       {"median_ms", times[30]},
                       {"p95_ms", times[57]},
                       {"inverted", inverted},
                       {"energy", rest.report.energy},
                       {"energy_from_scratch", scratch.report.energy}});
}

} // namespace

int main(int argc, char** argv)
try
{
    const bench::options options(argc, argv, {"--poisson", "--compare"});
    std::vector<double> poisson;
    std::istringstream ratios(options.value("--poisson", ""));
    for (std::string ratio; std::getline(ratios, ratio, ',');) poisson.push_back(std::stod(ratio));
    const double limit = std::stod(options.value("--compare", "0"));
    auto paths = options.paths;
    if (paths.empty()) paths = options.quick ? std::vector<std::string>{"3"} : std::vector<std::string>{"8", "16"};
    queue q;
    auto report = bench::circumstances(q);
    auto& results = report["results"];
    for (const auto& path : paths)
    {
        const bool is_bar = path.find_first_not_of("0123456789") == std::string::npos;
        const auto p =
            is_bar ? bench::bar(std::stoi(path))
                   : bench::volume_problem(std::filesystem::path(path).stem().string(), io::read_volume(path), 0.1);
        deform_ends(q, p, poisson, results);
        if (limit > 0) compare(q, p, limit, results);
        if (is_bar && poisson.empty()) frames(q, std::stoi(path), results);
    }
    options.write(report);
}
catch (const std::exception& e)
{
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
