// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <taut/deform.hpp>
#include <taut/impl/core/core/block_sum.hpp>
#include <taut/impl/core/map/map_run.hpp>
#include <taut/impl/core/map/overlap/scaffold.hpp>
#include <taut/impl/core/measure/distortion.hpp>
#include <taut/quality.hpp>

namespace taut::impl
{

/// Edges of a triangle, with its height over the longest one raised to `least` at least.
inline mat2 thickened(mat2 edges, double least)
{
    vec2 longest = edges[0];
    for (const vec2& e : {edges[1], edges[1] - edges[0]})
        if (glm::dot(e, e) > glm::dot(longest, longest)) longest = e;
    const double length = glm::length(longest), height = glm::determinant(edges) / length;
    if (!(height < least)) return edges;
    const vec2 across = vec2(-longest.y, longest.x) / length;
    for (int k = 0; k < 2; ++k) edges[k] += (least / height - 1) * glm::dot(across, edges[k]) * across;
    return edges;
}

/// Map of a run with a scaffold around it, as a planar mesh that deforms. The target shapes of the scaffold are its
/// current ones, so that it exerts no force by itself; it resists, and where parts of the boundary come nearer to each
/// other than a gap it pushes them apart. In normalised units.
class scaffolded_map
{
public:
    using map = std::vector<vec2>;

    struct shape
    {
        mesh<triangle> plane; ///< first the vertices and triangles of the surface
        deform_params<triangle> how;
    };

    /// places: a map with fixed coordinates at their targets. Refers to its arguments.
    scaffolded_map(const map_run& run, const std::vector<std::vector<idx>>& loops, const map& places)
        : run_(run), loops_(loops), places_(places), springs_(run.held.beyond_pins(vec2(0)).springs)
    {
        const auto& data = run.params.data;
        for (std::size_t c = 0; c < run.in.ideal.measure.size(); ++c)
        {
            targets_.push_back(invert_upper(run.in.ideal.inverse[c]));
            weights_.push_back(data.weights.empty() ? 1.0 : data.weights[c]);
            total_ += counted(weights_[c], run.in.ideal.measure[c]);
        }
        std::size_t edges = 0;
        for (const auto& loop : loops)
            for (std::size_t k = 0; k < loop.size(); ++k, ++edges)
                gap_ += glm::distance(at_rest(loop[k]), at_rest(loop[(k + 1) % loop.size()]));
        gap_ *= 0.05 / static_cast<double>(edges);
    }

    /// Objective: the mean over the triangles of the surface, and springs.
    double energy(const map& x) const
    {
        const auto& data = run_.params.data;
        double sum = block_sum<double>(
            x.empty() ? 0 : targets_.size(),
            [&](double& part, std::size_t c)
            {
                auto e = mapped_element<triangle>(run_.in.surface, run_.in.ideal, x, c);
                if (!data.directions.empty())
                    e.S *= triangle::frame(run_.in.surface.rest(static_cast<idx>(c)), data.directions[c]);
                e.attributes = {data.attributes.data() + c * data.attribute_count, data.attribute_count};
                part += counted(weights_[c], e.measure) * run_.params.energy(e) / total_;
            });
        for (const auto& s : springs_)
        {
            const vec2 d = x[static_cast<std::size_t>(s.vertex)] - s.target;
            sum += glm::dot(s.stiffness, d * d);
        }
        return sum;
    }

    /// A map whose boundary nowhere meets itself, with a new scaffold, in which the four corners of a rectangle around
    /// it are pinned.
    shape around(const map& x) const
    {
        map all = x;
        const auto& marks = run_.held.marks();
        for (std::size_t v = 0; v < marks.size(); ++v)
            if (marks.any(v)) all.push_back(places_[v]);
        const bounding_square box(all);
        const vec2 room(1.5 * box.size);
        const scaffold s = make_scaffold(loops_, x, box.centre - room, box.centre + room);

        std::vector<vec3> points;
        for (const auto* part : {&x, &s.points})
            for (const vec2& p : *part) points.emplace_back(p, 0.0);
        auto cells = run_.in.surface.cells();
        cells.insert(cells.end(), s.cells.begin(), s.cells.end());
        shape made{mesh<triangle>(std::move(points), std::move(cells)), {}};
        made.how.energy = run_.params.energy;
        made.how.weights = run_.params.weights;
        made.how.precision = run_.params.precision;
        made.how.targets = targets_;
        double around = 0; // what the scaffold would count with weights of 1
        for (const auto& cell : s.cells)
        {
            const auto corner = [&](std::size_t k)
            { return vec2(made.plane.points()[static_cast<std::size_t>(cell[k])]); };
            const mat2 edges = thickened(mat2(corner(1) - corner(0), corner(2) - corner(0)), gap_);
            made.how.targets.push_back(edges);
            around += counted(1, triangle::measure_factor * glm::determinant(edges));
        }
        const double part = scaffold_part(x);
        made.how.data = data_of(made.plane, part * total_ / around);
        hold(made, s.points, part);
        return made;
    }

private:
    /// Weight of the scaffold relative to the surface. It grows with the distortion of the surface, which would tear
    /// lighter scaffolds.
    double scaffold_part(const map& x) const
    {
        const double e = mean_over<triangle>(run_.in.surface, run_.in.ideal, x, energy::isometric{}).measure;
        return 0.1 * std::sqrt(std::max(e / 4, 1.0));
    }

    cell_data data_of(const mesh<triangle>& plane, double weight) const
    {
        const auto& given = run_.params.data;
        cell_data data{.weights = weights_, .attribute_count = given.attribute_count, .attributes = given.attributes};
        data.weights.resize(plane.cells().size(), weight);
        const auto usual = given.mean_attributes();
        for (std::size_t c = weights_.size(); c < plane.cells().size(); ++c)
            data.attributes.insert(data.attributes.end(), usual.begin(), usual.end());
        // As they lie in the triangles of the surface, so in those of the plane.
        for (std::size_t c = 0; c < given.directions.size(); ++c)
        {
            const auto number = static_cast<idx>(c);
            const vec2 axis = triangle::frame(run_.in.surface.rest(number), given.directions[c])[0];
            const auto rest = plane.rest(number);
            const vec3 along = rest[1] - rest[0];
            data.directions.push_back(axis.x * along + axis.y * vec3(-along.y, along.x, 0.0));
        }
        if (!data.directions.empty()) data.directions.resize(plane.cells().size(), vec3(1.0, 0.0, 0.0));
        return data;
    }

    /// Pins the corners of the scaffold and what the run holds, and takes over springs. part: as scaffold_part().
    void hold(shape& made, const map& corners, double part) const
    {
        auto& asked = made.how.constraints = constraints<triangle>(made.plane);
        for (std::size_t k = 0; k < 4; ++k) asked.pin(static_cast<idx>(places_.size() + k), corners[k]);
        const auto& marks = run_.held.marks();
        for (std::size_t v = 0; v < marks.size(); ++v)
            for (int k = 0; k < 2; ++k)
                if (marks.test(v, k)) asked.pin(static_cast<idx>(v), k, places_[v][k]);
        for (const auto& s : springs_) asked.spring(s.vertex, s.target, s.stiffness.x / (1 + part));
    }

    double counted(double weight, double measure) const
    {
        return run_.params.weights == energy::weighting::measure ? weight * measure : weight;
    }
    const vec3& at_rest(idx v) const { return run_.in.surface.points()[static_cast<std::size_t>(v)]; }

    const map_run& run_;
    const std::vector<std::vector<idx>>& loops_;
    const map& places_;
    std::vector<directed_spring<2>> springs_;
    std::vector<mat2> targets_;   ///< of the triangles of the surface
    std::vector<double> weights_; ///< the same
    double total_ = 0;            ///< that they count
    double gap_ = 0;
};

} // namespace taut::impl
