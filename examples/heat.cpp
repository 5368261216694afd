// SPDX-License-Identifier: MIT
// A kernel of one's own over a mesh: explicit diffusion of heat on the graph of its vertices, whose rows are loops of
// the kernel, then the same step in OpenCL C.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>
#include <set>
#include <vector>

#include <taut/kernel.hpp>
#include <taut/taut.hpp>

using namespace taut;

/// The neighbours of each vertex, row by row: those of v are columns[starts[v]], ..., columns[starts[v + 1] - 1].
struct graph
{
    std::vector<int> starts{0}, columns;

    explicit graph(const mesh<triangle>& m)
    {
        std::vector<std::set<int>> rows(m.points().size());
        for (const auto& t : m.cells())
            for (const int a : t)
                for (const int b : t)
                    if (a != b) rows[static_cast<std::size_t>(a)].insert(b);
        for (const auto& row : rows)
        {
            columns.insert(columns.end(), row.begin(), row.end());
            starts.push_back(static_cast<int>(columns.size()));
        }
    }
};

int main(int argc, char** argv)
try
{
    if (argc < 2)
    {
        std::cerr << "usage: heat SURFACE\n";
        return 2;
    }
    queue q;
    const auto surface = io::read_surface(argv[1]);
    const graph g(surface);
    const std::size_t n = surface.points().size();

    // [buffers]
    std::vector<double> hot(n, 0.0);
    hot[0] = 1000;
    buffer<double> now(q, hot), next(q, n);
    buffer<int> starts(q, g.starts), columns(q, g.columns);
    // [buffers]

    // [kernel]
    const auto step = [&](const buffer<double>& from, buffer<double>& to, double dt)
    {
        q.submit(
            [&](handler& h)
            {
                auto t = from.read(h);
                auto out = to.write(h);
                auto row = starts.read(h);
                auto column = columns.read(h);
                auto rate = h.uniform(dt); // may change from step to step without a new build
                h.parallel_for("heat", n,
                               [=](auto v)
                               {
                                   const auto flow =
                                       sum_over(row[v], row[v + 1], [&](auto k) { return t[column[k]] - t[v]; });
                                   const auto warmer = t[v] + rate * flow;
                                   out[v] = select(warmer > 1e-300, warmer, 0.0); // no subnormal numbers
                               });
            });
    };
    for (int k = 0; k < 200; ++k)
    {
        step(now, next, k < 100 ? 0.05 : 0.1);
        now.swap(next);
    }
    const auto after = now.download();
    // [kernel]

    std::cout << "heat " << std::accumulate(after.begin(), after.end(), 0.0) << ", hottest "
              << *std::max_element(after.begin(), after.end()) << std::flush;
    if (q.device().is_host())
    {
        std::cout << "; the host compiles no text\n";
        return 0;
    }

    // [opencl]
    const auto in_c = q.kernel<const buffer<double>, buffer<double>, const buffer<int>, const buffer<int>, double>(
        R"(
        #pragma OPENCL EXTENSION cl_khr_fp64 : enable
        __kernel void heat_step(__global const double* t, __global double* out, __global const int* row,
                                __global const int* column, double rate)
        {
            const int v = get_global_id(0);
            double flow = 0;
            for (int k = row[v]; k < row[v + 1]; ++k) flow += t[column[k]] - t[v];
            out[v] = t[v] + rate * flow;
        })",
        "heat_step");
    now.upload(hot);
    for (int k = 0; k < 200; ++k)
    {
        in_c(n, now, next, starts, columns, k < 100 ? 0.05 : 0.1);
        now.swap(next);
    }
    // [opencl]

    double difference = 0;
    const auto again = now.download();
    for (std::size_t v = 0; v < n; ++v) difference = std::max(difference, std::abs(after[v] - again[v]));
    std::cout << ", difference " << (difference < 1e-9 ? "none" : "some") << '\n';
}
catch (const error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
