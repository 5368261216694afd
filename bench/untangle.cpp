// SPDX-License-Identifier: MIT
// The untangling stack over folders of .prob files: what each problem ended with, by which stage and how soon, and
// totals by class and feasibility where the folder has an INDEX.tsv (name, dim, ..., class, feasibility by headings).
// With --optimize, the isometric energy of each map that was found is then minimised under the same pins.
//   taut_bench_untangle [--limit SECONDS] [--stages NAME,NAME] [--optimize ITERATIONS] [--json FILE] [FOLDER|FILE...]
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <support/meshes.hpp>

#include <taut/deform.hpp>
#include <taut/impl/core/untangle/untangle_host.hpp>
#include <taut/parameterize.hpp>
#include <taut/surface_file.hpp>
#include <taut/untangle.hpp>
#include <taut/volume_file.hpp>

#include "measure.hpp"

namespace
{

using namespace taut;
using namespace taut::impl;
namespace fs = std::filesystem;

std::vector<std::string> split(const std::string& text, char separator)
{
    std::vector<std::string> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
    return parts;
}

/// What an INDEX.tsv says of problems, by their names: class and feasibility.
std::map<std::string, std::array<std::string, 2>> read_index(const fs::path& folder)
{
    std::map<std::string, std::array<std::string, 2>> result;
    std::ifstream in(folder / "INDEX.tsv");
    std::string line;
    std::getline(in, line);
    const auto headings = split(line, '\t');
    const auto column = [&](const char* name)
    { return static_cast<std::size_t>(std::find(headings.begin(), headings.end(), name) - headings.begin()); };
    const std::size_t name = column("name"), kind = column("class"), feasible = column("feasibility");
    while (std::getline(in, line))
    {
        const auto cells = split(line, '\t');
        if (std::max({name, kind, feasible}) < cells.size()) result[cells[name]] = {cells[kind], cells[feasible]};
    }
    return result;
}

struct tally
{
    int problems = 0, injective = 0, infeasible = 0;
    double seconds = 0;
};

/// Runs over problems and sums up.
class untangle_bench
{
public:
    /// steps: of the optimisation afterwards; 0: none
    untangle_bench(queue& q, untangle_params params, run_limits limits, int steps)
        : queue_(q), params_(std::move(params)), limits_(std::move(limits)), steps_(steps)
    {
        std::printf("%-32s %7s %7s %6s %8s  %-10s %-9s %8s %9s  %s%s\n", "problem", "V", "F", "pinned", "inverted",
                    "outcome", "stage", "seconds", "least det", "held",
                    steps > 0 ? "   optimised: energy, gradient, steps, seconds, end" : "");
    }

    template <class Element>
    void measure(const std::string& name, const std::array<std::string, 2>& labels,
                 const untangle_problem<Element>& problem)
    {
        constexpr int D = Element::dimension;
        const auto start = certify<D>(problem.rest.cells(), std::span<const vec<D>>(problem.initial));
        const auto r = untangle(queue_, problem, params_, limits_);
        const auto flips = certify<D>(problem.rest.cells(), std::span<const vec<D>>(r.map));
        bool held = true;
        const auto pinned = problem.held.count();
        for (std::size_t v = 0; v < problem.held.size(); ++v)
            for (int k = 0; k < D; ++k)
                held = held && (!problem.held.test(v, k) ||
                                std::memcmp(&r.map[v][k], &problem.initial[v][k], sizeof(double)) == 0);
        if (!held || (r && flips.flipped > 0)) throw std::runtime_error(name + ": a wrong answer");
        std::printf("%-32s %7d %7d %6zu %8zu  %-10s %-9s %8.2f %9.2g  %s", name.c_str(), problem.rest.vertex_count(),
                    problem.rest.cell_count(), pinned, start.flipped,
                    r ? "injective" : std::string(to_string(r.outcome)).c_str(),
                    r ? r.stage.c_str() : std::to_string(flips.flipped).c_str(), r.seconds, r.least_relative_det,
                    held ? "exact" : "MOVED");
        nlohmann::ordered_json optimised;
        if (r && steps_ > 0) optimised = optimise(name, problem, r.map);
        std::printf("\n");
        std::fflush(stdout);
        auto stages = nlohmann::ordered_json::array();
        for (const auto& s : r.stages)
        {
            stage_seconds_[s.stage] += s.seconds;
            stages.push_back(
                {{"name", s.stage}, {"iterations", s.iterations}, {"seconds", s.seconds}, {"inverted", s.inverted}});
        }
        if (r) ++stage_solved_[r.stage];
        for (auto* t : {&classes_[labels[0] + ", " + labels[1]], &all_})
        {
            ++t->problems;
            t->injective += r.outcome == outcome::valid;
            t->infeasible += r.outcome == outcome::infeasible;
            t->seconds += r.seconds;
        }
        results.push_back({{"problem", name},
                           {"class", labels[0]},
                           {"feasibility", labels[1]},
                           {"vertices", problem.rest.vertex_count()},
                           {"elements", problem.rest.cell_count()},
                           {"pinned", pinned},
                           {"inverted_at_start", start.flipped},
                           {"outcome", r ? "injective" : to_string(r.outcome)},
                           {"stage", r.stage},
                           {"inverted", flips.flipped},
                           {"least_relative_det", r.least_relative_det},
                           {"seconds", r.seconds},
                           {"reason", r.reason},
                           {"stages", std::move(stages)},
                           {"optimised", std::move(optimised)}});
    }

    void print_totals() const
    {
        std::printf("\n%-44s %8s %9s %10s %8s\n", "class, feasibility", "problems", "injective", "infeasible",
                    "seconds");
        for (const auto& [name, t] : classes_) print(name, t);
        print("all", all_);
        if (optimised_ > 0) std::printf("\n%d of %d maps optimised to a gradient of 1e-6\n", converged_, optimised_);
        std::printf("\n%-12s %8s %8s\n", "stage", "solved", "seconds");
        for (const auto& [name, seconds] : stage_seconds_)
        {
            const auto solved = stage_solved_.find(name);
            std::printf("%-12s %8d %8.2f\n", name.c_str(), solved == stage_solved_.end() ? 0 : solved->second, seconds);
        }
    }

    nlohmann::ordered_json results = nlohmann::ordered_json::array();

private:
    /// What a minimisation ended with.
    struct minimum
    {
        bool valid = false, converged = false;
        double energy = 0, gradient = 0;
        int iterations = 0;
        std::string end;
    };

    minimum minimise(const untangle_problem<triangle>& problem, const constraints<triangle>& pins,
                     std::vector<vec2>& x) const
    {
        const auto r =
            parameterize(queue_, problem.rest,
                         {.constraints = pins, .initial = x, .holes = true, .solve = {.max_iterations = steps_}});
        x = r.uv;
        const auto& s = r.report.solve;
        return {static_cast<bool>(r),
                solve::impl::converged(s.stop),
                s.value,
                s.gradient_norm,
                s.iterations,
                r ? std::string(to_string(s.stop)) : r.reason()};
    }

    minimum minimise(const untangle_problem<tetrahedron>& problem, const constraints<tetrahedron>& pins,
                     std::vector<vec3>& x) const
    {
        auto r =
            deform(queue_, problem.rest,
                   deform_params<tetrahedron>{.constraints = pins, .initial = x, .solve = {.max_iterations = steps_}});
        x = std::move(r.x);
        const auto& s = r.report;
        return {r && s.pins_held, s.converged, s.energy,
                s.gradient,       s.steps,     !s.reason.empty() ? s.reason : s.converged ? "converged" : "stopped"};
    }

    /// Minimises the isometric energy under the pins of a problem, from an injective map.
    template <class Element>
    nlohmann::ordered_json optimise(const std::string& name, const untangle_problem<Element>& problem,
                                    std::vector<vec<Element::dimension>> x)
    {
        constexpr int D = Element::dimension;
        constraints<Element> pins(problem.rest);
        for (std::size_t v = 0; v < problem.held.size(); ++v)
            for (int k = 0; k < D; ++k)
                if (problem.held.test(v, k)) pins.pin(static_cast<taut::idx>(v), k, problem.initial[v][k]);
        minimum m;
        const double seconds = bench::seconds([&] { m = minimise(problem, pins, x); });
        bool held = true;
        for (const auto& [v, pin] : pins.pins())
            for (int k = 0; k < D; ++k)
                held =
                    held && m.valid && ((pin.held >> k & 1u) == 0 || x[static_cast<std::size_t>(v)][k] == pin.value[k]);
        if (m.valid && (!held || certify<D>(problem.rest.cells(), std::span<const vec<D>>(x)).flipped > 0))
            throw std::runtime_error(name + ": a wrong map");
        std::printf("   %9.4g %8.1e %5d %6.2f  %s", m.energy, m.gradient, m.iterations, seconds, m.end.c_str());
        ++optimised_;
        converged_ += m.valid && m.gradient <= 1e-6;
        return {{"valid", m.valid},           {"energy", m.energy}, {"gradient", m.gradient},
                {"iterations", m.iterations}, {"seconds", seconds}, {"stop", m.end}};
    }

    static void print(const std::string& name, const tally& t)
    {
        std::printf("%-44s %8d %9d %10d %8.2f\n", name.c_str(), t.problems, t.injective, t.infeasible, t.seconds);
    }

    queue& queue_;
    untangle_params params_;
    run_limits limits_;
    int steps_;
    int optimised_ = 0, converged_ = 0; ///< of the maps that were found; to a relative gradient of 1e-6
    std::map<std::string, tally> classes_;
    std::map<std::string, double> stage_seconds_;
    std::map<std::string, int> stage_solved_;
    tally all_;
};

/// A square whose inner vertices lie in one point.
untangle_problem<triangle> collapsed_square(int n)
{
    auto m = test::grid(n, n);
    std::vector<vec2> x;
    fixed_marks<2> held(m.points().size());
    for (const vec3& p : m.points())
    {
        const bool rim = p.x == 0 || p.y == 0 || p.x == 1 || p.y == 1;
        if (rim) held[x.size()] = held.every;
        x.push_back(rim ? vec2(p.x, p.y) : vec2(0.3, 0.4));
    }
    return {std::move(m), std::move(x), std::move(held)};
}

} // namespace

int main(int argc, char** argv)
try
{
    const bench::options options(argc, argv, {"--limit", "--stages", "--optimize"});
    untangle_params params;
    const run_limits limits{.time_limit = std::chrono::duration<double>(std::stod(options.value("--limit", "60")))};
    params.stages = split(options.value("--stages", ""), ',');
    queue q;
    auto report = bench::circumstances(q);
    report["limit"] = limits.time_limit.count();
    std::printf("taut %s %s on %s\n\n", TAUT_VERSION_STRING, TAUT_BENCH_COMMIT, q.device().name().c_str());
    untangle_bench bench(q, params, limits, std::stoi(options.value("--optimize", options.quick ? "50" : "0")));
    std::vector<fs::path> files;
    for (const fs::path path : options.paths)
        if (fs::is_directory(path))
        {
            for (const auto& entry : fs::directory_iterator(path))
                if (entry.path().extension() == ".prob") files.push_back(entry.path());
        }
        else
            files.push_back(path);
    std::sort(files.begin(), files.end());
    for (const auto& file : files)
    {
        const auto index = read_index(file.parent_path());
        const auto name = file.stem().string();
        const auto known = index.find(name);
        const std::array<std::string, 2> labels =
            known == index.end() ? std::array<std::string, 2>{"-", "-"} : known->second;
        std::visit([&](auto problem) { bench.measure(name, labels, make_untangle_problem(std::move(problem))); },
                   io::read_prob(file));
    }
    if (files.empty()) bench.measure("generated", {"-", "-"}, collapsed_square(options.quick ? 8 : 60));
    bench.print_totals();
    report["results"] = bench.results;
    options.write(report);
    return 0;
}
catch (const std::exception& e)
{
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
