// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/cutting/rest_surface.hpp>
#include <taut/impl/core/sparse/elimination_solver.hpp>

namespace taut::impl
{

/// The solution of Laplace's equation on a surface with its curvature (angle defects) as source, and 0 at some
/// vertices: the logarithm, nearly, of the scale that a conformal map has there if these are its boundary (Ben-Chen,
/// Gotsman, Bunin 2008). Its extremes are tips of limbs and the middles of domes.
class curvature_potential
{
public:
    explicit curvature_potential(const rest_surface& rest) : vertices_(rest.surface.points().size())
    {
        const auto u = rest_surface::u;
        std::vector<double> angle(3 * rest.surface.cells().size());
        source_.assign(vertices_, 2 * std::numbers::pi);
        for (idx c = 0; c < rest.triangles(); ++c)
        {
            const auto x = rest.surface.rest(c);
            for (std::size_t k = 0; k < 3; ++k)
            {
                const vec3 a = x[(k + 1) % 3] - x[k], b = x[(k + 2) % 3] - x[k];
                angle[3 * u(c) + k] = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
                source_[u(rest.vertex(3 * c + static_cast<idx>(k)))] -= angle[3 * u(c) + k];
            }
        }
        const auto half_cotangent = [&](idx side) // slivers and right angles get what can be computed with
        { return 0.5 * std::clamp(1 / std::tan(std::max(1e-3, angle[u(side)])), 0.02, 20.0); };

        system_.excess.assign(vertices_, 0);
        total_.assign(vertices_, 0);
        std::vector<std::pair<idx, double>> row;
        for (idx v = 0; v < rest.vertices(); ++v)
        {
            row.clear();
            for (const idx s : rest.sides.row(v))
            {
                const idx before = rest_surface::last(s); // the side of the triangle that ends at v
                const double other = rest.twin(s) >= 0 ? half_cotangent(rest.twin(s)) : 0;
                row.emplace_back(rest.end(s), half_cotangent(s) + other);
                if (rest.twin(before) < 0) row.emplace_back(rest.start(before), half_cotangent(before));
            }
            std::sort(row.begin(), row.end());
            for (const auto& [w, weight] : row)
            {
                system_.column.push_back(w);
                system_.weight.push_back(weight);
                total_[u(v)] += weight;
            }
            system_.offset.push_back(static_cast<idx>(system_.column.size()));
        }
        system_.rhs.resize(vertices_);
        for (std::size_t v = 0; v < vertices_; ++v) system_.rhs[v] = {source_[v], 0};
    }

    /// zero: one flag a vertex, at least one; one value a vertex
    std::vector<double> operator()(std::span<const char> zero)
    {
        constexpr double stiff = 1e9;
        for (std::size_t v = 0; v < vertices_; ++v)
        {
            system_.excess[v] = zero[v] ? stiff * std::max(total_[v], 1e-3) : 0;
            system_.rhs[v].x = zero[v] ? 0 : source_[v];
        }
        const std::vector<vec2> x = solver_(system_);
        std::vector<double> result(vertices_);
        for (std::size_t v = 0; v < vertices_; ++v) result[v] = x[v].x;
        return result;
    }

private:
    std::size_t vertices_;
    std::vector<double> source_, total_; // one a vertex: curvature, sum of weights
    barycentric_system system_;          // of all vertices, so that the order of elimination stays
    elimination_solver solver_;
};

} // namespace taut::impl
