// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <taut/deform.hpp>
#include <taut/impl/dist/shape/fixed_part.hpp>
#include <taut/impl/dist/shape/own_queue.hpp>
#include <taut/impl/dist/shape/rest_model.hpp>

namespace taut::dist::impl
{

/// Brings pins to their targets on process 0 alone, which gathers the mesh: by deform() of one process, with its
/// coarser meshes and its untangling. For meshes that one process can hold, where steps over all of them are stuck.
template <class Element>
class gathered_solve
{
public:
    static constexpr int D = Element::dimension;
    static constexpr std::int64_t most_cells = 2000000;
    using numbers = std::vector<double>; ///< D a vertex of the part

    struct result
    {
        numbers x; ///< in lengths of the run
        int steps;
    };

    /// Collective. x: the shape to begin with, in lengths of the run; limits: of process 0. Nothing where
    /// pins are not met by that.
    static std::optional<result> run(const part<Element>& p, const fixed_part<Element>& held, double lengths,
                                     const deform_params<Element>& params, const numbers& x, const run_limits& limits)
    {
        const auto& all = p.all;
        const auto vertices = all.exchange(to_first(all, vertices_of(p, held, lengths, x))).items;
        const auto cells = all.exchange(to_first(all, cells_of(p))).items;
        const auto data = all.any(!p.owners.empty() || !p.weights.empty())
                              ? all.exchange(to_first(all, data_of(p))).items
                              : std::vector<cell_data_here>();
        std::vector<spring> own_springs;
        for (const auto& s : held.springs) own_springs.push_back({p.numbers[s.vertex], s.target, s.weight});
        const auto springs = all.exchange(to_first(all, std::move(own_springs))).items;
        parcels<moved> back(all.ranks());
        int steps = -1;
        all.together(
            [&]
            {
                if (all.rank() != 0) return;
                queue q = params.queue ? *params.queue : open_own_queue({});
                const auto found = solved(vertices, cells, data, springs, params, q, limits);
                if (!found) return;
                steps = found->report.steps;
                for (std::size_t v = 0; v < found->x.size(); ++v)
                {
                    const auto place = p.place_of(static_cast<std::int64_t>(v));
                    back[place.rank].push_back({place.place, found->x[v]});
                }
            });
        steps = all.shared(steps);
        const auto mine = all.exchange(back).items;
        if (steps < 0) return std::nullopt;
        result r{x, steps};
        for (const auto& [place, at] : mine)
            for (int k = 0; k < D; ++k) r.x[static_cast<std::size_t>(D * place + k)] = at[k] * lengths;
        p.update(r.x, D);
        return r;
    }

private:
    struct vertex
    {
        vec3 rest;
        vec<D> x, target;
        std::uint8_t marks;
    };
    struct spring
    {
        std::int64_t number;
        vec<D> target;
        double weight;
    };
    struct moved
    {
        std::int64_t place;
        vec<D> x;
    };
    using corners = std::array<std::int64_t, part<Element>::K>;
    struct cell_data_here
    {
        std::int64_t owner; ///< none: -1
        double weight;
    };

    template <class T>
    static parcels<T> to_first(const communicator& all, std::vector<T> mine)
    {
        parcels<T> to(all.ranks());
        to.front() = std::move(mine);
        return to;
    }

    static std::vector<vertex> vertices_of(const part<Element>& p, const fixed_part<Element>& held, double lengths,
                                           const numbers& x)
    {
        std::vector<vertex> own(p.own);
        for (std::size_t v = 0; v < p.own; ++v)
        {
            own[v].rest = p.points[v];
            own[v].marks = held.marks[v];
            for (int k = 0; k < D; ++k)
            {
                const auto i = D * v + static_cast<std::size_t>(k);
                own[v].x[k] = x[i] / lengths;
                own[v].target[k] = held.targets[i];
            }
        }
        return own;
    }

    static std::vector<corners> cells_of(const part<Element>& p)
    {
        std::vector<corners> mine;
        for (std::size_t c = 0; c < p.corners.size(); ++c)
        {
            if (!p.counted[c]) continue;
            corners cell;
            for (std::size_t k = 0; k < cell.size(); ++k)
                cell[k] = p.numbers[static_cast<std::size_t>(p.corners[c][k])];
            mine.push_back(cell);
        }
        return mine;
    }

    /// Of the cells of cells_of().
    static std::vector<cell_data_here> data_of(const part<Element>& p)
    {
        std::vector<cell_data_here> mine;
        std::int64_t first = 0, groups = 0; // owners of the processes before this one
        if (!p.owners.empty()) groups = p.owners.back() + 1;
        first = p.all.before(groups);
        for (std::size_t c = 0; c < p.corners.size(); ++c)
            if (p.counted[c])
                mine.push_back({p.owners.empty() ? -1 : first + p.owners[c], p.weights.empty() ? 1.0 : p.weights[c]});
        return mine;
    }

    static std::optional<session_result<Element>>
    solved(const std::vector<vertex>& vertices, const std::vector<corners>& cells,
           const std::vector<cell_data_here>& data, const std::vector<spring>& springs,
           const deform_params<Element>& params, queue& q, const run_limits& limits)
    {
        std::vector<vec3> points;
        std::vector<typename mesh<Element>::cell> simplices(cells.size());
        taut::deform_params<Element> how{.energy = params.energy,
                                         .weights = params.weights,
                                         .regular = params.regular,
                                         .precision = params.precision};
        how.solve.gradient_tolerance = params.solve.gradient_tolerance;
        for (const auto& d : data)
        {
            if (d.owner >= 0) how.owners.push_back(static_cast<idx>(d.owner));
            how.data.weights.push_back(d.weight);
        }
        for (const auto& v : vertices)
        {
            points.push_back(v.rest);
            how.initial.push_back(v.x);
        }
        for (std::size_t c = 0; c < cells.size(); ++c)
            std::transform(cells[c].begin(), cells[c].end(), simplices[c].begin(),
                           [](std::int64_t v) { return static_cast<idx>(v); });
        const mesh<Element> m(std::move(points), std::move(simplices));
        how.constraints = taut::constraints<Element>(m);
        for (std::size_t v = 0; v < vertices.size(); ++v)
            for (int k = 0; k < D; ++k)
                if ((vertices[v].marks >> k & 1U) != 0)
                    how.constraints.pin(static_cast<idx>(v), k, vertices[v].target[k]);
        for (const auto& s : springs) how.constraints.spring(static_cast<idx>(s.number), s.target, s.weight);
        auto found = taut::deform(q, m, how, limits);
        if (found.report.outcome != outcome::valid || !found.report.pins_held) return std::nullopt;
        return found;
    }
};

} // namespace taut::dist::impl
