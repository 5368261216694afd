// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/atlas.hpp>
#include <taut/charts.hpp>
#include <taut/energies.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/pack.hpp>

namespace taut::impl
{

/// Computes area and energy of chart k at its optimal scale; infinite where a triangle is flipped.
inline std::pair<double, double> area_and_energy(const chart_mesh& charts, std::size_t k, std::span<const vec2> uv,
                                                 const ideal_elements<triangle>& ideal)
{
    double area = 0, stretch = 0, shrink = 0; // |S|^2 and |S^-1|^2 by area
    for (auto c = static_cast<std::size_t>(charts.first_cell[k]);
         c < static_cast<std::size_t>(charts.first_cell[k + 1]); ++c)
    {
        const mat2 S = shape_matrix<2>(charts.surface.cells()[c], uv, ideal.inverse[c]);
        const double square = glm::dot(S[0], S[0]) + glm::dot(S[1], S[1]), det = glm::determinant(S);
        area += ideal.measure[c];
        stretch += ideal.measure[c] * square;
        shrink += det > 0 ? ideal.measure[c] * (square / det / det) : std::numeric_limits<double>::infinity();
    }
    return {area, 2 * std::sqrt(stretch / area) * std::sqrt(shrink / area)};
}

/// Fills a report with what areas become at one common scale.
inline void take_densities(atlas_report& report, const chart_mesh& charts, std::span<const vec2> uv,
                           const ideal_elements<triangle>& ideal, double scale)
{
    double all = 0, distorted = 0, differing = 0, density = 0, square = 0;
    for (std::size_t c = 0; c < ideal.measure.size(); ++c)
    {
        const double area = ideal.measure[c];
        const double ratio =
            scale * scale * glm::determinant(shape_matrix<2>(charts.surface.cells()[c], uv, ideal.inverse[c]));
        all += area;
        distorted += area * (ratio > 0 ? std::max(ratio, 1 / ratio) : std::numeric_limits<double>::infinity());
        differing += area * std::abs(std::abs(ratio) - 1);
        density += area * std::sqrt(std::abs(ratio));
        square += area * std::abs(ratio);
    }
    if (!(all > 0)) return;
    report.area_distortion = distorted / all;
    report.area_difference = differing / all;
    report.density_spread = std::sqrt(std::max(0.0, square / all - density / all * density / all)) / (density / all);
}

/// Fills a report with the measures of charts, each separately and all at one common scale.
/// uv: one per vertex of charts.surface, in the tiles; layout: without placements if there is none
inline void summarize(atlas_report& report, const chart_mesh& charts, std::span<const vec2> uv, const packing& layout)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    const auto& cells = charts.surface.cells();
    const ideal_elements<triangle> ideal(charts.surface);
    std::vector<double> values(cells.size()); // one per triangle
    const auto sum_over_cells = [&](const auto& value)
    {
        parallel_for(values.size(),
                     [&](std::size_t begin, std::size_t end)
                     {
                         for (std::size_t c = begin; c < end; ++c) values[c] = value(c);
                     });
        double sum = 0;
        for (const double x : values) sum += x;
        return sum;
    };
    const double in_plane = sum_over_cells(
        [&](std::size_t c) { return orient(uv[u(cells[c][0])], uv[u(cells[c][1])], uv[u(cells[c][2])]).det / 2; });
    double in_space = 0;
    for (idx k = 0; k < charts.charts(); ++k)
    {
        chart_summary chart{.triangles = charts.first_cell[u(k) + 1] - charts.first_cell[u(k)],
                            .tile = layout.places.empty() ? 0 : layout.places[u(k)].tile};
        std::tie(chart.area, chart.energy) = area_and_energy(charts, u(k), uv, ideal);
        in_space += chart.area;
        report.worst = std::max(report.worst, chart.energy);
        report.charts.push_back(chart);
    }
    const double scale = std::sqrt(in_space / in_plane);
    report.area = in_space;
    const double distortion = sum_over_cells(
        [&](std::size_t c)
        {
            const mat2 S = scale * shape_matrix<2>(cells[c], uv, ideal.inverse[c]);
            const double det = glm::determinant(S);
            return ideal.measure[c] * (det > 0 ? taut::energy::isometric{}(element<double, 2>{S, det, ideal.measure[c]})
                                               : std::numeric_limits<double>::infinity());
        });
    report.distortion = distortion / in_space;
    // From the plane to the surface the singular values are 1 / s1 and 1 / s2: their squares sum to |S|^2 / det^2.
    std::vector<double> largest(cells.size());
    const double stretch = sum_over_cells(
        [&](std::size_t c)
        {
            const mat2 S = scale * shape_matrix<2>(cells[c], uv, ideal.inverse[c]);
            const double det = glm::determinant(S), square = glm::dot(S[0], S[0]) + glm::dot(S[1], S[1]);
            if (!(det > 0)) return largest[c] = std::numeric_limits<double>::infinity();
            const double root = std::sqrt(std::max(0.0, square * square - 4 * det * det));
            largest[c] = std::sqrt((square + root) / 2) / det;
            return ideal.measure[c] * square / (det * det) / 2;
        });
    report.stretch_l2 = std::sqrt(stretch / in_space);
    report.stretch_linf = largest.empty() ? 1 : *std::max_element(largest.begin(), largest.end());
    take_densities(report, charts, uv, ideal, scale);
    report.utilization = layout.utilization;
}

} // namespace taut::impl
