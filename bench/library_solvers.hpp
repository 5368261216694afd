// SPDX-License-Identifier: MIT
#pragma once

#include <ctime>

#include <taut/parameterize.hpp>
#include <taut/surface_file.hpp>

#include "measure.hpp"
#include "peak_memory.hpp"
#include "solver_run.hpp"

namespace bench
{

namespace impl
{

/// The least that the elements alone move, in double, each array once: a value reads corners, inverses, measures,
/// weights and positions, writes and reads the energies; a gradient also writes and reads six numbers a triangle and
/// its slots, and writes two a vertex.
inline std::uint64_t element_bytes(const taut::mesh<taut::triangle>& m, const taut::solve::report& r)
{
    const auto cells = static_cast<std::uint64_t>(m.cell_count());
    const auto vertices = static_cast<std::uint64_t>(m.vertex_count());
    const std::uint64_t value = cells * (12 + 24 + 16 + 16) + vertices * 16;
    const std::uint64_t more = cells * (2 * 48 + 12) + vertices * 16;
    return value * static_cast<std::uint64_t>(r.evaluations) + more * static_cast<std::uint64_t>(r.gradients);
}

} // namespace impl

/// One run of the library from the file to the certified map.
inline solver_run run_library(taut::queue& q, const std::filesystem::path& path, taut::parameterize_params p,
                              const run_limits& limits)
{
    solver_run run;
    const peak_memory memory;
    const double cpu = cpu_seconds();
    const auto begin = clock::now();
    const auto m = taut::io::read_surface(path);
    run.seconds.read = std::chrono::duration<double>(clock::now() - begin).count();
    const auto watch = [&](const taut::progress& at)
    { return !(at.iterate && at.level == 0 && at.value <= limits.enough && at.value > 0); };
    const auto [uv, r] = taut::parameterize(q, m, p, {std::chrono::duration<double>(limits.seconds), watch});
    const double wall = std::chrono::duration<double>(clock::now() - begin).count();
    run.cpu_seconds = cpu_seconds() - cpu;
    run.peak_bytes = memory.bytes();
    run.bytes_before = memory.before();

    auto& s = run.seconds;
    s.device = r.seconds.device;
    s.hierarchy = r.seconds.hierarchy;
    s.start = r.seconds.start;
    s.solve = r.seconds.solve;
    s.other = wall - s.read - s.device - s.hierarchy - s.start - s.solve;
    run.valid = r.outcome == taut::outcome::valid;
    run.stop = run.valid ? std::string(taut::solve::to_string(r.solve.stop)) : r.reason;
    if (!run.valid) return run;
    for (const auto& e : r.solve.history) run.history.push_back({e.iteration, e.value, s.before_solve() + e.seconds});
    run.iterations = r.solve.iterations;
    run.evaluations = r.solve.evaluations;
    run.energy = r.solve.value;
    run.flipped = r.flips.flipped;
    run.limited = r.solve.stop == taut::solve::stop::time;
    run.counters = r.counters;
    run.bytes_moved = impl::element_bytes(m, r.solve);
    return run;
}

/// The solvers of the library. Those that stop by themselves come first: where they end is what the others aim at.
inline std::vector<solver> library_solvers(taut::queue& q)
{
    using taut::parameterize_params;
    std::vector<solver> table;
    const auto add = [&](const char* name, bool own_stop, std::function<void(parameterize_params&)> choose)
    {
        table.push_back({name, own_stop,
                         [&q, choose](const std::filesystem::path& path, const run_limits& limits)
                         {
                             parameterize_params p;
                             choose(p);
                             return run_library(q, path, p, limits);
                         }});
    };
    const auto without_end = [](parameterize_params& p)
    {
        p.solve.max_iterations = 1000000;
        p.solve.gradient_tolerance = 0;
    };
    add("nested", true, [](parameterize_params&) {}); // the default: coarse to fine, Newton with multigrid
    add("newton", true,                               // the same from the plain barycentric map
        [](parameterize_params& p) { p.start = taut::start_method::tutte; });
    add("nested lbfgs", false, // the V-cycle of the start's Hessian as H0
        [=](parameterize_params& p)
        {
            p.solve.method = taut::solve::method::lbfgs;
            p.multigrid = true;
            p.start = taut::start_method::coarse;
            without_end(p);
        });
    add("lbfgs", false,
        [=](parameterize_params& p)
        {
            p.solve.method = taut::solve::method::lbfgs;
            without_end(p);
        });
    add("paper", false, // nonlinear conjugate gradients from the plain barycentric map
        [=](parameterize_params& p)
        {
            p.solve.method = taut::solve::method::conjugate_gradient;
            p.start = taut::start_method::tutte;
            without_end(p);
        });
    return table;
}

} // namespace bench
