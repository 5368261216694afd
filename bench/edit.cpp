// SPDX-License-Identifier: MIT
// Cut and paste: what a first paste takes, by phase, and what a step takes that moves and turns the feature; then
// radial basis functions: factoring, and a new set of values at 10,000 places, against the number of points.
//   taut_bench_edit [--quick] [--json FILE] [--steps N] [SOURCE VERTEX RADIUS TARGET VERTEX SCALE]...
// Without surfaces: a mushroom of some 10,000 triangles on a torus of 51,200.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <support/edit_meshes.hpp>
#include <support/rbf_points.hpp>

#include <taut/impl/charts/paste/rbf.hpp>
#include <taut/impl/charts/paste/rbf_evaluator.hpp>
#include <taut/paste.hpp>
#include <taut/surface_file.hpp>

#include "measure.hpp"

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;

double at_rank(std::vector<double> values, double part)
{
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, static_cast<std::size_t>(part * double(values.size())))];
}

void time_paste(queue& q, const std::string& name, const mesh<triangle>& source, idx at, double radius,
                const mesh<triangle>& target, idx onto, double scale, int steps, nlohmann::ordered_json& results)
{
    const feature part(geodesic_disk(source, at, radius));
    const paste_params params{.pose = {.scale = scale}};
    paste p(q, target, part, onto, params); // kernels are built
    const double whole = bench::seconds([&] { p = paste(q, target, part, onto, params); });
    const auto& r = p.report();
    const auto s = r.seconds;
    std::printf("%s: feature %d triangles, rim %zu, target %d triangles, bent %d vertices, rim %s\n", name.c_str(),
                r.feature_triangles, part.region.rim.size(), target.cell_count(), r.bent_vertices, r.way.c_str());
    std::printf("first paste %.0f ms: region %.0f, map %.0f, land %.1f, seam %.1f, factor %.1f, pose %.1f\n",
                1e3 * whole, 1e3 * s.region, 1e3 * s.map, 1e3 * s.land, 1e3 * s.seam, 1e3 * s.factor,
                1e3 * s.transform);
    nlohmann::ordered_json result{{"pair", name},
                                  {"feature_triangles", r.feature_triangles},
                                  {"target_triangles", target.cell_count()},
                                  {"first", whole},
                                  {"map", s.map},
                                  {"factor", s.factor}};
    for (const double softness : {0.0, 0.5})
    {
        std::vector<double> times;
        for (int k = 0; k < steps; ++k)
        {
            const double shift = 0.001 * k * scale * part.radius;
            const paste_pose pose{.turn = 0.01 * k, .scale = scale, .shift = {shift, shift, 0}, .softness = softness};
            times.push_back(bench::seconds([&] { p.pose(pose); }));
        }
        std::printf("step at softness %.1f: median %.2f ms, 95 %% below %.2f ms\n", softness, 1e3 * at_rank(times, 0.5),
                    1e3 * at_rank(times, 0.95));
        result[softness > 0 ? "soft_step" : "step"] = at_rank(times, 0.5);
    }
    const auto seam = p.measure_seam();
    std::printf("%s, %d boundary edges, %d degenerate, angle across the rim %.1f median, %.1f largest\n\n",
                seam.manifold ? "manifold" : "not manifold", seam.boundary_edges, seam.degenerate, seam.median_angle,
                seam.largest_angle);
    result["manifold"] = seam.manifold;
    result["boundary_edges"] = seam.boundary_edges;
    results.push_back(result);
}

void time_rbf(queue& q, int largest, nlohmann::ordered_json& results)
{
    const auto places = test::scattered_points(10000, 3);
    std::printf("%-12s %8s %12s %12s %12s\n", "basis", "points", "factor ms", "solve ms", "evaluate ms");
    for (const auto& [name, basis, most] : {std::tuple("linear", rbf_basis::linear, largest),
                                            std::tuple("wendland_c2", rbf_basis::wendland_c2, 4 * largest)})
        for (int n = 250; n <= most; n *= 2)
        {
            const auto count = static_cast<std::size_t>(n);
            const auto points = test::scattered_points(count, 1), values = test::scattered_points(count, 2);
            std::vector<double> factor, solve, evaluate;
            for (int k = 0; k < 3; ++k)
            {
                std::vector<rbf> solver;
                const rbf_params params{.basis = basis,
                                        .radius = 2 / std::cbrt(double(n))}; // some 30 points see each other
                factor.push_back(bench::seconds([&] { solver.emplace_back(points, params); }));
                rbf_field field;
                solve.push_back(bench::seconds([&] { field = solver[0].solve(values); }));
                rbf_evaluator evaluator(q, field, places);
                evaluate.push_back(bench::seconds([&] { evaluator(field); }));
            }
            const double f = at_rank(factor, 0.5), s = at_rank(solve, 0.5), e = at_rank(evaluate, 0.5);
            std::printf("%-12s %8d %12.1f %12.2f %12.2f\n", name, n, 1e3 * f, 1e3 * s, 1e3 * e);
            results.push_back({{"basis", name}, {"points", n}, {"factor", f}, {"solve", s}, {"evaluate", e}});
        }
}

} // namespace

int main(int argc, char** argv)
try
{
    const bench::options options(argc, argv, {"--steps"});
    const int steps = std::stoi(options.value("--steps", options.quick ? "3" : "60"));
    const auto& words = options.paths;
    if (steps < 1 || words.size() % 6 != 0)
        throw std::invalid_argument("name SOURCE VERTEX RADIUS TARGET VERTEX SCALE, and --steps of 1 or more");
    queue q;
    auto report = bench::circumstances(q);
    if (words.empty())
    {
        const int n = options.quick ? 12 : 42;
        const auto target = options.quick ? test::torus(40, false) : test::torus(160, false);
        time_paste(q, "generated", test::mushroom(n), 0, 2.4, target, 0, 0.2, steps, report["results"]);
        time_rbf(q, options.quick ? 250 : 2000, report["results"]);
    }
    for (std::size_t k = 0; k < words.size(); k += 6)
        time_paste(q, words[k] + " on " + words[k + 3], io::read_surface(words[k]), std::stoi(words[k + 1]),
                   std::stod(words[k + 2]), io::read_surface(words[k + 3]), std::stoi(words[k + 4]),
                   std::stod(words[k + 5]), steps, report["results"]);
    options.write(report);
}
catch (const std::exception& e)
{
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
