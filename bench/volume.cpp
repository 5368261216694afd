// SPDX-License-Identifier: MIT
// Volumes whose ends are held and moved: bars, and models in any format of impl/files/volume/read_volume.hpp, whose
// ends are the first and last tenth along their longest axis. Twisted, stretched and bent; bars then lead a handle over
// 60 frames.
//   taut_bench_volume [--quick] [--json FILE] [--only ends|session|compare] [--motion twist|stretch|bend]
//                     [--poisson 0.3,0.45] [--compare SECONDS] [CUBES_ACROSS|NXxNYxNZ|MESH...]
// A bar has 30 n^3 tetrahedra for n cubes across, or 6 nx ny nz; without arguments 8 and 16. Kernels are compiled
// before anything is measured. Of several bars the exponents are printed by which seconds grow with tetrahedra.
//   --poisson  a neo-Hookean solid of these ratios, with either stand-in for its Hessian, in the place of the isometric
//              energy
//   --compare  other solvers of the stretch, from an untangled start, each for so long; ratios of their times to the
//              library's, from the same start and from the shape at rest
//   --only     nothing else
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/deform.hpp>
#include <taut/energies.hpp>
#include <taut/volume_file.hpp>

#include "measure.hpp"
#include "peak_memory.hpp"
#include "volume_problem.hpp"
#include "volume_solvers.hpp"

namespace
{

using namespace taut;
using namespace taut::impl;
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

const std::vector<std::string> all_motions{"twist", "stretch", "bend"};

void deform_ends(queue& q, const bench::volume_problem& p, const std::vector<std::string>& motions,
                 const std::vector<double>& poisson, nlohmann::ordered_json& results)
{
    for (const std::string& motion : motions)
        for (const auto& [name, energy] : energies(poisson))
        {
            deform_params<tetrahedron> params;
            params.energy = energy;
            params.constraints = p.held(motion);
            const bench::peak_memory memory;
            session_result<tetrahedron> r;
            const double cpu_before = bench::cpu_seconds();
            const double seconds = bench::seconds([&] { r = deform(q, p.mesh, params); });
            const double cpu = bench::cpu_seconds() - cpu_before;
            const auto& report = r.report;
            const bool good = report.converged && report.pins_held;
            std::printf("%-12s %8zu %-8s %-14s %3d steps  E %.6f  gradient %.1e  %s  %zu inverted  %6.2f s (processor "
                        "%.2f s): start %.2f "
                        "follow %.2f repair %.2f solve %.2f certificate %.2f  %zu MB\n",
                        p.name.c_str(), p.mesh.cells().size(), motion.c_str(), name.c_str(), report.steps,
                        report.energy, report.gradient, good ? "converged" : "NOT CONVERGED", report.flips.flipped,
                        seconds, cpu, report.seconds.start, report.seconds.follow, report.seconds.repair,
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
                               {"processor_seconds", cpu},
                               {"follow_seconds", report.seconds.follow},
                               {"solve_seconds", report.seconds.solve},
                               {"peak_bytes", memory.bytes()}});
        }
}

/// The exponents by which the times of one motion grow from each bar to the next larger one.
void print_slopes(const nlohmann::ordered_json& results, const std::string& motion)
{
    std::map<double, nlohmann::ordered_json> by_size;
    for (const auto& r : results)
        if (r.value("model", "") == "bar" && r.value("motion", "") == motion && r.contains("processor_seconds"))
            by_size[r["tetrahedra"].get<double>()] = r;
    if (by_size.size() < 2) return;
    for (auto next = std::next(by_size.begin()), last = by_size.begin(); next != by_size.end(); last = next++)
    {
        const auto exponent = [&](const char* key)
        {
            return std::log(next->second[key].get<double>() / last->second[key].get<double>()) /
                   std::log(next->first / last->first);
        };
        std::printf("%-8s from %.0f to %.0f tetrahedra: exponent %.2f of seconds, %.2f of processor seconds\n",
                    motion.c_str(), last->first, next->first, exponent("seconds"), exponent("processor_seconds"));
    }
}

void compare(queue& q, const bench::volume_problem& p, double limit, nlohmann::ordered_json& results)
{
    bench::volume_solvers solvers(q, p, "stretch", limit);
    constexpr double at_once = std::numeric_limits<double>::infinity();
    solvers.library(), solvers.lbfgs(at_once), solvers.direct_newton(at_once); // compile kernels
    const auto ours = solvers.library();
    const double rest = 2, enough = ours.energy + 1e-6 * (ours.energy - rest); // errors are by what it is above rest
    std::vector<std::pair<std::string, bench::solver_run>> runs{{"library", ours},
                                                                {"library, from rest", solvers.library_from_rest()},
                                                                {"lbfgs", solvers.lbfgs(enough)},
                                                                {"direct newton", solvers.direct_newton(enough)}};
    double best = ours.energy;
    for (const auto& [name, run] : runs)
        if (run.valid) best = std::min(best, run.energy);
    const auto to = [&](const bench::solver_run& run, double error)
    { return bench::effort(run, best, error * (best - rest) / best); };
    for (const auto& [name, run] : runs)
    {
        if (!run.valid) continue;
        std::printf("%-12s %8zu %-18s E %.6f after %d steps, %.2f s (processor %.2f s), %s; to", p.name.c_str(),
                    p.mesh.cells().size(), name.c_str(), run.energy, run.iterations, run.seconds.solve, run.cpu_seconds,
                    run.stop.c_str());
        nlohmann::ordered_json row = {{"model", p.name},
                                      {"tetrahedra", p.mesh.cells().size()},
                                      {"solver", name},
                                      {"energy", run.energy},
                                      {"steps", run.iterations},
                                      {"seconds", run.seconds.solve},
                                      {"processor", run.cpu_seconds}};
        for (const double error : {1e-2, 1e-3, 1e-6})
        {
            const auto reached = to(run, error);
            std::printf(" %g: %d / %.2f s (%.2f s)", error, reached ? reached->iterations : -1,
                        reached ? reached->seconds : NAN, reached ? reached->cpu_seconds : NAN);
            if (reached)
                row["to"][std::to_string(error)] = {reached->iterations, reached->seconds, reached->cpu_seconds};
        }
        std::printf("\n");
        results.push_back(std::move(row));
    }
    constexpr double error = 1e-3;
    for (std::size_t peer = 2; peer < runs.size(); ++peer)
        for (std::size_t own = 0; own < 2; ++own)
        {
            const auto& [name, run] = runs[peer];
            const auto fast = to(runs[own].second, error), slow = to(run, error);
            if (!run.valid || !fast) continue;
            const double seconds = slow ? slow->seconds : run.seconds.solve,
                         cpu = slow ? slow->cpu_seconds : run.cpu_seconds;
            std::printf("%-12s %8zu to %g: %s takes %s%.1f times as long as %s, %s%.1f times by processor seconds\n",
                        p.name.c_str(), p.mesh.cells().size(), error, name.c_str(), slow ? "" : "more than ",
                        seconds / fast->seconds, runs[own].first.c_str(), slow ? "" : "more than ",
                        cpu / fast->cpu_seconds);
            results.push_back({{"model", p.name},
                               {"tetrahedra", p.mesh.cells().size()},
                               {"peer", name},
                               {"against", runs[own].first},
                               {"error", error},
                               {"at_least", !slow},
                               {"ratio", seconds / fast->seconds},
                               {"processor_ratio", cpu / fast->cpu_seconds}});
        }
    std::fflush(stdout);
}

void frames(queue& q, const bench::volume_problem& p, nlohmann::ordered_json& results)
{
    const auto& m = p.mesh;
    session s(q, m, {.constraints = constraints<tetrahedron>(m).fix(p.low)});
    s.solve();
    const auto home = s.x();
    std::vector<double> times;
    std::size_t inverted = 0;
    const double cpu_before = bench::cpu_seconds();
    for (int frame = 1; frame <= 60; ++frame)
    {
        std::vector<vec3> places;
        for (const idx v : p.high)
            places.push_back(home[static_cast<std::size_t>(v)] + vec3(0.02 * frame, 0.01 * frame, -0.005 * frame));
        times.push_back(
            1000 *
            bench::seconds([&] { inverted += s.move(p.high, places).solve({.steps = 2}).report.flips.flipped; }));
    }
    const double cpu = 1000 * (bench::cpu_seconds() - cpu_before) / double(times.size());
    std::sort(times.begin(), times.end());
    const auto rest = s.solve();
    deform_params<tetrahedron> params;
    params.constraints = s.constraints();
    const auto scratch = deform(q, m, params);
    std::printf("%9zu session  60 frames of 2 steps: median %.1f ms, 95 %% %.1f ms, processor %.1f ms a frame, %zu "
                "inverted; E at rest %.7f, from "
                "scratch %.7f\n",
                m.cells().size(), times[30], times[57], cpu, inverted, rest.report.energy, scratch.report.energy);
    results.push_back({{"tetrahedra", m.cells().size()},
                       {"motion", "session"},
                       {"median_ms", times[30]},
                       {"p95_ms", times[57]},
                       {"processor_ms", cpu},
                       {"inverted", inverted},
                       {"energy", rest.report.energy},
                       {"energy_from_scratch", scratch.report.energy}});
}

} // namespace

int main(int argc, char** argv)
try
{
    const bench::options options(argc, argv, {"--poisson", "--compare", "--only", "--motion"});
    std::vector<double> poisson;
    std::istringstream ratios(options.value("--poisson", ""));
    for (std::string ratio; std::getline(ratios, ratio, ',');) poisson.push_back(std::stod(ratio));
    const std::string only = options.value("--only", ""), motion = options.value("--motion", "");
    const auto chosen = [&](const std::string& part) { return only.empty() || only == part; };
    const auto motions = motion.empty() ? all_motions : std::vector<std::string>{motion};
    if (!only.empty() && only != "ends" && only != "session" && only != "compare")
        throw std::invalid_argument("--only takes ends, session or compare");
    if (std::find(all_motions.begin(), all_motions.end(), motions[0]) == all_motions.end())
        throw std::invalid_argument("--motion takes twist, stretch or bend");
    const double limit = std::stod(options.value("--compare", only == "compare" ? "300" : "0"));
    auto paths = options.paths;
    if (paths.empty()) paths = options.quick ? std::vector<std::string>{"3"} : std::vector<std::string>{"8", "16"};
    queue q;
    auto report = bench::circumstances(q);
    auto& results = report["results"];
    {
        const auto small = bench::bar(2, 2, 10);
        deform(q, small.mesh, deform_params<tetrahedron>{.constraints = small.held("stretch")}); // compiles kernels
    }
    for (const auto& path : paths)
    {
        auto p = bench::bar_of(path);
        const bool is_bar = p.has_value();
        if (!is_bar) p.emplace(std::filesystem::path(path).stem().string(), io::read_volume(path), 0.1);
        if (chosen("ends")) deform_ends(q, *p, motions, poisson, results);
        if (limit > 0 && chosen("compare")) compare(q, *p, limit, results);
        if (is_bar && poisson.empty() && chosen("session")) frames(q, *p, results);
    }
    if (poisson.empty())
        for (const auto& m : motions) print_slopes(results, m);
    options.write(report);
}
catch (const std::exception& e)
{
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
