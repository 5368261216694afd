// SPDX-License-Identifier: MIT
#include "peers.hpp"

#include <cmath>
#include <ctime>
#include <numbers>

#include <dlfcn.h>

#include <taut/certify.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/mesh.hpp>
#include <taut/surface_file.hpp>

#include "measure.hpp"
#include "peak_memory.hpp"
#include "peer_cholesky.hpp"

namespace bench
{

namespace
{

using surface = taut::mesh<taut::triangle>;
using peer::problem;

std::size_t at(int i)
{
    return static_cast<std::size_t>(i);
}

/// The lower triangle of a graph over the vertices by columns, each with its diagonal first.
struct graph
{
    std::vector<int> column = {0}, row;

    graph(std::size_t n, const std::vector<std::array<int, 3>>& cells)
    {
        std::vector<std::vector<int>> below(n);
        for (const auto& t : cells)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
                below[at(low)].push_back(high);
            }
        for (std::size_t v = 0; v < n; ++v)
        {
            auto& rows = below[v];
            std::sort(rows.begin(), rows.end());
            rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
            row.push_back(static_cast<int>(v));
            row.insert(row.end(), rows.begin(), rows.end());
            column.push_back(static_cast<int>(row.size()));
        }
    }
};

/// Tutte's map with uniform weights on a circle, spaced by chord length, in the numbering of `rank`.
std::vector<double> tutte(const surface& m, const problem& p, const std::vector<int>& rank)
{
    const auto loops = taut::boundary_loops(m, taut::impl::facets(m));
    if (loops.size() != 1) throw std::runtime_error("not a disk");
    const auto& rim = loops.front();
    std::vector<double> turn(rim.size() + 1, 0);
    for (std::size_t i = 0; i < rim.size(); ++i)
        turn[i + 1] = turn[i] + glm::distance(m.points()[at(rim[i])], m.points()[at(rim[(i + 1) % rim.size()])]);

    const std::size_t n = m.points().size();
    std::vector<double> x(2 * n, 0);
    std::vector<int> unknown(n, 0); // its number, -1 on the rim
    for (std::size_t i = 0; i < rim.size(); ++i)
    {
        const double angle = 2 * std::numbers::pi * turn[i] / turn.back();
        const std::size_t v = at(rank[at(rim[i])]);
        unknown[v] = -1;
        x[2 * v] = std::cos(angle);
        x[2 * v + 1] = std::sin(angle);
    }
    int unknowns = 0;
    for (int& u : unknown)
        if (u == 0) u = unknowns++;

    const graph edges(n, p.corners());
    std::vector<int> column = {0}, row;
    std::vector<double> value, degree(n, 0), rhs(2 * at(unknowns), 0);
    for (std::size_t v = 0; v < n; ++v)
        for (int k = edges.column[v] + 1; k < edges.column[v + 1]; ++k)
        {
            ++degree[v];
            ++degree[at(edges.row[at(k)])];
        }
    for (std::size_t v = 0; v < n; ++v)
    {
        const int i = unknown[v];
        if (i >= 0)
        {
            row.push_back(i);
            value.push_back(degree[v]);
        }
        for (int k = edges.column[v] + 1; k < edges.column[v + 1]; ++k)
        {
            const std::size_t w = at(edges.row[at(k)]);
            const int j = unknown[w];
            if (i >= 0 && j >= 0)
            {
                row.push_back(j);
                value.push_back(-1);
            }
            else if (i >= 0 || j >= 0)
            {
                const std::size_t inside = at(i >= 0 ? i : j), outside = i >= 0 ? w : v;
                rhs[inside] += x[2 * outside];
                rhs[inside + at(unknowns)] += x[2 * outside + 1];
            }
        }
        if (i >= 0) column.push_back(static_cast<int>(row.size()));
    }
    if (unknowns > 0)
    {
        peer::cholesky factor(column, row, value);
        factor.factorize();
        const auto solution = factor.solve(rhs);
        for (std::size_t v = 0; v < n; ++v)
            if (unknown[v] >= 0)
            {
                x[2 * v] = solution[at(unknown[v])];
                x[2 * v + 1] = solution[at(unknown[v]) + at(unknowns)];
            }
    }
    const double s = p.best_scale(x);
    for (double& c : x) c *= s;
    return x;
}

/// Backtracking by values (Armijo) below 0.9 of the step that would flip a triangle. x becomes the new iterate.
/// Returns the step; 0: none was found.
double search(const problem& p, std::vector<double>& x, const std::vector<double>& d, double value, double slope,
              double& next, int& evaluations)
{
    std::vector<double> trial(x.size());
    double a = std::min(1.0, 0.9 * p.longest_step(x, d));
    for (int k = 0; k < 60; ++k)
    {
        for (std::size_t i = 0; i < x.size(); ++i) trial[i] = x[i] + a * d[i];
        next = p.value(trial);
        ++evaluations;
        if (next <= value + 1e-4 * a * slope)
        {
            x.swap(trial);
            return a;
        }
        // The minimum of the parabola through both values and the slope, not too far from the half.
        const double parabola = std::isfinite(next) ? -slope * a * a / (2 * (next - value - a * slope)) : a / 2;
        a = std::clamp(parabola, 0.1 * a, 0.6 * a);
    }
    return 0;
}

/// Factors h with as little added to its diagonal as that takes: translations and the rotation have no stiffness.
void factorize(peer::block_matrix& h, peer::cholesky& factor)
{
    double trace = 0;
    for (int c = 0; c < h.size(); ++c) trace += h.diagonal(c);
    for (double added = 0, shift = 1e-10 * trace / h.size(); shift <= trace; shift *= 100)
    {
        for (int c = 0; c < h.size(); ++c) h.diagonal(c) += shift - added;
        added = shift;
        if (factor.factorize()) return;
    }
    throw std::runtime_error("the matrix is not finite");
}

void minimize(const problem& p, peer::model kind, std::vector<double>& x, peer::block_matrix& h, peer::cholesky& factor,
              const run_limits& limits, solver_run& run, double before, clock::time_point begin)
{
    constexpr int most = 1000;
    std::vector<double> g, d(x.size());
    double value = p.gradient(x, g);
    const auto now = [&] { return before + std::chrono::duration<double>(clock::now() - begin).count(); };
    run.evaluations = 1;
    run.valid = std::isfinite(value);
    run.stop = run.valid ? "iterations" : "the start map has a flipped triangle";
    if (run.valid) run.history.push_back({0, value, now()});
    while (run.iterations < most && run.valid)
    {
        p.matrix(x, kind, h);
        factorize(h, factor);
        const auto solution = factor.solve(g);
        double slope = 0;
        for (std::size_t i = 0; i < d.size(); ++i)
        {
            d[i] = -solution[i];
            slope += d[i] * g[i];
        }
        if (-slope <= 1e-12 * value) // twice what the step would gain
        {
            run.stop = "decrease";
            break;
        }
        double next = value;
        if (search(p, x, d, value, slope, next, run.evaluations) == 0)
        {
            run.stop = "line search";
            break;
        }
        p.gradient(x, g);
        ++run.evaluations;
        value = next;
        run.history.push_back({++run.iterations, value, now()});
        if (value <= limits.enough) run.stop = "user";
        run.limited = now() > limits.seconds;
        if (run.limited) run.stop = "time";
        if (run.stop != "iterations") break;
    }
    run.energy = value;
}

solver_run run_peer(peer::model kind, const std::filesystem::path& path, const run_limits& limits)
{
    solver_run run;
    const peak_memory memory;
    const auto cpu = std::clock();
    auto last = clock::now();
    const auto lap = [&last]
    {
        const auto now = clock::now();
        return std::chrono::duration<double>(now - std::exchange(last, now)).count();
    };
    const auto m = taut::io::read_surface(path);
    run.seconds.read = lap();

    const graph edges(m.points().size(), m.cells());
    const auto rank = peer::fill_reducing_rank(static_cast<int>(m.points().size()), edges.column, edges.row);
    problem p(m, rank);
    auto h = p.make_matrix();
    peer::cholesky factor(h.column, h.row, h.value);
    run.seconds.other = lap();

    auto x = tutte(m, p, rank);
    run.seconds.start = lap();
    minimize(p, kind, x, h, factor, limits, run, run.seconds.before_solve(), last);
    run.seconds.solve = lap();
    run.cpu_seconds = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
    run.peak_bytes = memory.bytes();
    run.bytes_before = memory.before();

    std::vector<taut::vec2> uv;
    for (const int v : rank) uv.emplace_back(x[2 * at(v)], x[2 * at(v) + 1]);
    if (run.valid) run.flipped = taut::certify<2>(m.cells(), uv).flipped;
    return run;
}

} // namespace

std::vector<solver> peer_solvers()
{
    const auto with = [](peer::model kind)
    {
        return [kind](const std::filesystem::path& path, const run_limits& limits)
        { return run_peer(kind, path, limits); };
    };
    return {{"direct newton", false, with(peer::model::newton)}, {"direct slim", false, with(peer::model::slim)}};
}

std::string peer_blas()
{
    if (void* threads = dlsym(RTLD_DEFAULT, "openblas_set_num_threads")) reinterpret_cast<void (*)(int)>(threads)(1);
    Dl_info info{};
    void* product = dlsym(RTLD_DEFAULT, "dgemm_");
    if (!product || !dladdr(product, &info) || !info.dli_fname) return "unknown";
    return std::filesystem::canonical(info.dli_fname).string();
}

} // namespace bench
