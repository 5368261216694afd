// SPDX-License-Identifier: MIT
// The paper's method on the paper's problem: nonlinear conjugate gradients for the isometric energy with uniform
// weights, free boundary, from the barycentric map with uniform weights onto a circle, 1000 iterations.
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>

#include <support/meshes.hpp>

#include <taut/parameterize.hpp>
#include <taut/solve_params.hpp>
#include <taut/surface_file.hpp>

#include "measure.hpp"

namespace
{

using namespace taut;

/// Counters of the queue at the first iterate and at the last, so that start-up is left out.
struct usage
{
    taut::queue_counters first, last;
};

/// A way to run the method.
struct variant
{
    const char* name;
    taut::precision precision;
    solve::line_search_method line_search;
    int pairs; ///< of L-BFGS in the preconditioner
};

nlohmann::ordered_json measure(queue& q, const std::string& name, const mesh<triangle>& m, const variant& how,
                               int iterations)
{
    usage u;
    parameterize_params p;
    p.weights = energy::weighting::uniform;
    p.start = start_method::tutte;
    p.precision = how.precision;
    p.solve.line_search = how.line_search;
    p.solve.method = solve::method::conjugate_gradient;
    p.solve.tuning.conjugate_gradient.memory.pairs = how.pairs;
    p.solve.max_iterations = iterations;
    p.solve.gradient_tolerance = 0;
    const auto watch = [&](const taut::progress& at)
    {
        (at.iteration == 0 && at.iterate ? u.first : u.last) = q.counters();
        return true;
    };
    const auto result = parameterize(q, m, p, {.observer = watch});
    const auto& r = result.report;
    if (!result) throw std::runtime_error(name + ": " + result.reason());

    const double n = std::max(1, r.solve.iterations);
    const double launches = static_cast<double>(u.last.launches - u.first.launches) / n;
    const double waits = static_cast<double>(u.last.waits - u.first.waits) / n;
    const double evaluations = r.solve.evaluations / n;
    std::printf("%-16s %9d  %-14s %5d %10.4f %8.3f %9.3f %8.1f %7.1f %7.2f  %s\n", name.c_str(), m.cell_count(),
                how.name, r.solve.iterations, r.solve.value - 1, r.seconds.solve, 1e3 * r.seconds.solve / n, launches,
                waits, evaluations, std::string(solve::to_string(r.solve.stop)).c_str());
    return {{"mesh", name},
            {"triangles", m.cell_count()},
            {"variant", how.name},
            {"iterations", r.solve.iterations},
            {"energy_less_one", r.solve.value - 1},
            {"seconds", r.seconds.solve},
            {"launches_an_iteration", launches},
            {"waits_an_iteration", waits},
            {"evaluations_an_iteration", evaluations},
            {"flipped", r.flips.flipped},
            {"stop", solve::to_string(r.solve.stop)}};
}

} // namespace

int main(int argc, char** argv)
try
{
    const bench::options options(argc, argv);
    queue q;
    auto report = bench::circumstances(q);
    std::vector<std::pair<std::string, mesh<triangle>>> surfaces;
    for (const auto& path : options.paths)
        surfaces.emplace_back(std::filesystem::path(path).stem().string(), io::read_surface(path));
    if (surfaces.empty()) surfaces.emplace_back("generated", test::bumpy(options.quick ? 12 : 92, 0.4));

    std::printf("taut %s %s on %s\n\n", TAUT_VERSION_STRING, TAUT_BENCH_COMMIT, q.device().name().c_str());
    // The released code of the paper keeps one pair and searches lines by values (hybrid); more pairs, and a gradient
    // at every trial (strong Wolfe), are what the same launches can buy.
    using enum solve::line_search_method;
    const variant variants[] = {
        {"hybrid, 5 pairs", precision::fp64, hybrid, 5}, // the library's default for this method
        {"the same, mixed", precision::mixed, hybrid, 5},
        {"hybrid, 1 pair", precision::fp64, hybrid, 1}, // as in the authors' released code
        {"Wolfe, 5 pairs", precision::fp64, strong_wolfe, 5}};
    std::printf("mesh             triangles  variant          its      E - 1  seconds    ms/it enqueues   waits  "
                "values  stop\n");
    for (const auto& [name, m] : surfaces)
        for (const auto& v : variants) report["results"].push_back(measure(q, name, m, v, options.quick ? 20 : 1000));
    options.write(report);
    return 0;
}
catch (const std::exception& e)
{
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
