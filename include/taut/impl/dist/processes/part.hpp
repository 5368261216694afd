// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/describe.hpp>
#include <taut/impl/dist/processes/curve_order.hpp>
#include <taut/impl/dist/processes/vertex_exchange.hpp>
#include <taut/mesh_piece.hpp>

namespace taut::dist::impl
{

/// The part of a mesh that one process works on: a range of the vertices, which it owns, along the Morton curve; all
/// cells that touch one of these (with all their parts, where simplices are parts of cells), so that sums over the
/// cells of an owned vertex need no other process; and the other vertices of those cells, the halo. Vertices count from
/// 0, owned ones first, those of the halo behind them by number.
///
/// Nothing here depends on how the caller had the mesh distributed, and the order of the cells of a vertex not on the
/// number of processes: cells are sorted by the numbers of their corners, the least one first.
template <class Element>
class part
{
public:
    static constexpr std::size_t K = static_cast<std::size_t>(Element::corners);
    using cell = std::array<idx, K>;

    communicator all;
    std::int64_t vertices = 0, cells = 0; ///< of all processes
    std::size_t own = 0;                  ///< owned vertices
    std::vector<std::int64_t> numbers;    ///< of the vertices here
    std::vector<std::int64_t> ids;        ///< the caller's
    std::vector<vec3> points;
    std::vector<cell> corners;
    std::vector<std::int64_t> cell_ids; ///< places among the caller's cells, by process
    std::vector<char> counted;          ///< a flag per cell: it is this process that counts it
    std::vector<idx> owners;            ///< of cells that are parts of others: numbers of these, ascending; or none
    std::vector<double> weights;        ///< factors of cells; or none
    std::vector<mat<Element::dimension>> edges; ///< target shapes of cells; or none

    /// Collective. Throws mesh_error, size_error.
    part(const communicator& processes, const mesh_piece<Element>& given) : all(processes), homes_(checked(all, given))
    {
        const auto known = static_cast<std::int64_t>(homes_.known().size());
        vertices = all.sum(known);
        cells = all.sum(static_cast<std::int64_t>(given.cells.size()));
        all.together([this] { require_sizes(); });
        ranges_ = number_ranges(vertices, all.size());
        const auto owned = in_curve_order(all, homes_, ranges_);
        take(given, owned);
    }

    /// Collective. The mesh of another part, given again, whose owned vertices go to these processes, where they keep
    /// their order.
    part(const part& before, const mesh_piece<Element>& given, const std::vector<std::size_t>& new_owners)
        : all(before.all), vertices(before.vertices), cells(before.cells), homes_(before.homes_)
    {
        parcels<keyed_vertex> to(all.ranks());
        for (std::size_t v = 0; v < before.own; ++v)
            to[new_owners[v]].push_back(
                {static_cast<std::uint64_t>(before.numbers[v]), before.ids[v], before.points[v]});
        auto owned = all.exchange(to).items;
        std::sort(owned.begin(), owned.end());
        const auto count = static_cast<std::int64_t>(owned.size());
        ranges_ = number_ranges(all.gathered(std::vector<std::int64_t>{count}));
        tell_homes(all, homes_, owned, all.before(count));
        take(given, owned);
    }

    std::size_t size() const { return numbers.size(); } ///< vertices here
    std::int64_t first() const { return ranges_.bounds[static_cast<std::size_t>(all.rank())]; }

    /// Collective. Brings the halo up to date: `width` numbers a vertex.
    template <class T>
    void update(std::vector<T>& x, int width = 1) const
    {
        halo_.update(x, own, width);
    }

    /// Collective. Values of owned vertices, `width` numbers each, at the caller's vertices, in their order.
    template <class T>
    std::vector<T> answer(const std::vector<T>& x, int width = 1) const
    {
        std::vector<T> result(answered_ * static_cast<std::size_t>(width));
        answers_.copy(x.data(), result.data(), width);
        return result;
    }

    /// Collective. The numbers of the caller's vertices by id, or homes::none.
    std::vector<std::int64_t> find(const std::vector<std::int64_t>& wanted) const { return homes_.find(wanted); }

    remote_place place_of(std::int64_t number) const
    {
        const std::size_t rank = ranges_.owner(number);
        return {rank, number - ranges_.bounds[rank]};
    }

    /// Whether a vertex here is owned here.
    bool owns(idx v) const { return static_cast<std::size_t>(v) < own; }

private:
    struct sent_cell
    {
        std::int64_t id, owner;
        std::array<std::int64_t, K> corners;
        std::int64_t least() const { return *std::min_element(corners.begin(), corners.end()); }
    };
    /// What else is said of a cell.
    struct sent_data
    {
        double weight = 1;
        mat<Element::dimension> edges = mat<Element::dimension>(1.0);
    };

    void take(const mesh_piece<Element>& given, const std::vector<keyed_vertex>& owned)
    {
        own = owned.size();
        take_cells(given);
        number_vertices();
        std::vector<remote_place> from;
        for (std::size_t v = own; v < numbers.size(); ++v) from.push_back(place_of(numbers[v]));
        halo_ = vertex_exchange(all, own, from);
        ids.resize(numbers.size());
        points.resize(numbers.size());
        for (std::size_t v = 0; v < own; ++v) ids[v] = owned[v].id, points[v] = owned[v].x;
        halo_.update(ids, own);
        double* const flat = points.empty() ? nullptr : &points[0].x;
        halo_.copy(flat, flat + (points.empty() ? 0 : 3 * own), 3);

        std::vector<remote_place> wanted;
        for (const std::int64_t number : homes_.find(given.ids)) wanted.push_back(place_of(number));
        answers_ = vertex_exchange(all, own, wanted);
        answered_ = given.ids.size();
    }

    static homes checked(const communicator& all, const mesh_piece<Element>& given)
    {
        all.together(
            [&]
            {
                if (given.ids.size() != given.points.size())
                    throw parameter_error("points", std::to_string(given.points.size()) + " positions for " +
                                                        std::to_string(given.ids.size()) + " vertices");
                for (std::size_t v = 0; v < given.ids.size(); ++v)
                    for (int k = 0; k < 3; ++k)
                        if (!std::isfinite(given.points[v][k]))
                            throw mesh_error(mesh_error::non_finite, {},
                                             "vertex " + std::to_string(given.ids[v]) +
                                                 " with a coordinate that is not a finite number; repair the mesh");
            });
        return homes(all, given.ids, given.points);
    }

    void require_sizes() const
    {
        if (cells == 0) throw mesh_error(taut::impl::describe<Element>(mesh_error::empty, {}));
        if (vertices > std::numeric_limits<PetscInt>::max() / Element::dimension)
            throw size_error("mesh", std::to_string(vertices) +
                                         " vertices are more than this PETSc can number; use one of 64-bit indices");
    }

    void take_cells(const mesh_piece<Element>& given)
    {
        std::vector<std::int64_t> named;
        named.reserve(K * given.cells.size());
        for (const auto& c : given.cells) named.insert(named.end(), c.begin(), c.end());
        const auto found = homes_.find(named);
        const std::int64_t before = all.before(static_cast<std::int64_t>(given.cells.size()));
        const bool owned = all.any(!given.owners.empty()), weighted = all.any(!given.weights.empty()),
                   shaped = all.any(!given.edges.empty());
        parcels<sent_cell> to(all.ranks());
        parcels<sent_data> more(all.ranks());
        all.together(
            [&]
            {
                require_data(given, owned, weighted, shaped);
                std::vector<std::size_t> places; // processes that a cell goes to with all its parts
                for (std::size_t first = 0, last = 0; first < given.cells.size(); first = last)
                {
                    places.clear();
                    for (; last == first ||
                           (last < given.cells.size() && owned && given.owners[last] == given.owners[first]);
                         ++last)
                        for (std::size_t k = 0; k < K; ++k)
                            if (const auto v = found[K * last + k]; v >= 0) places.push_back(ranges_.owner(v));
                    std::sort(places.begin(), places.end());
                    places.erase(std::unique(places.begin(), places.end()), places.end());
                    for (std::size_t c = first; c < last; ++c)
                    {
                        sent_cell s{
                            before + static_cast<std::int64_t>(c), before + static_cast<std::int64_t>(first), {}};
                        std::copy_n(found.begin() + static_cast<std::ptrdiff_t>(K * c), K, s.corners.begin());
                        require_corners(s, given.cells[c]);
                        for (const std::size_t r : places) to[r].push_back(s);
                        if (!weighted && !shaped) continue;
                        const sent_data data{weighted ? given.weights[c] : 1.0,
                                             shaped ? given.edges[c] : mat<Element::dimension>(1.0)};
                        for (const std::size_t r : places) more[r].push_back(data);
                    }
                }
            });
        sent_ = all.exchange(to).items;
        std::vector<sent_data> data;
        if (weighted || shaped) data = all.exchange(more).items;
        put_in_order(data);
        for (std::size_t c = 0; owned && c < sent_.size(); ++c)
            owners.push_back(c == 0 ? 0 : sent_[c].owner == sent_[c - 1].owner ? owners.back() : owners.back() + 1);
        for (const auto& d : data)
        {
            if (weighted) weights.push_back(d.weight);
            if (shaped) edges.push_back(d.edges);
        }
    }

    void require_data(const mesh_piece<Element>& given, bool owned, bool weighted, bool shaped) const
    {
        const std::size_t n = given.cells.size();
        const auto require_size = [n](const char* field, std::size_t size, bool used)
        {
            if (used && size != n)
                throw parameter_error(field, std::to_string(size) + " for " + std::to_string(n) + " cells");
        };
        require_size("owners", given.owners.size(), owned);
        require_size("weights", given.weights.size(), weighted);
        require_size("edges", given.edges.size(), shaped);
        for (std::size_t c = 0; c < given.weights.size(); ++c)
            if (!(given.weights[c] > 0) || !std::isfinite(given.weights[c]))
                throw parameter_error("weights", "that of cell " + std::to_string(c) +
                                                     " is not positive and finite; give one that is");
    }

    /// Sorts the cells, those of an owner as they were, by the first of them; data alike.
    void put_in_order(std::vector<sent_data>& data)
    {
        struct group
        {
            std::size_t begin, end;
            std::int64_t least;
        };
        std::vector<group> groups;
        for (std::size_t c = 0; c < sent_.size(); ++c)
            if (c > 0 && sent_[c].owner == sent_[c - 1].owner)
            {
                groups.back().end = c + 1;
                groups.back().least = std::min(groups.back().least, sent_[c].least());
            }
            else
                groups.push_back({c, c + 1, sent_[c].least()});
        std::sort(groups.begin(), groups.end(),
                  [this](const group& a, const group& b)
                  { return a.least != b.least ? a.least < b.least : sent_[a.begin].corners < sent_[b.begin].corners; });
        std::vector<sent_cell> cells_in_order;
        std::vector<sent_data> data_in_order;
        cells_in_order.reserve(sent_.size());
        for (const auto& g : groups)
            for (std::size_t c = g.begin; c < g.end; ++c)
            {
                cells_in_order.push_back(sent_[c]);
                if (!data.empty()) data_in_order.push_back(data[c]);
                counted.push_back(g.least >= first() && g.least < first() + static_cast<std::int64_t>(own));
            }
        sent_ = std::move(cells_in_order);
        data = std::move(data_in_order);
    }

    static void require_corners(const sent_cell& s, const std::array<std::int64_t, K>& named)
    {
        const auto refuse = [&](mesh_error::fault_type fault, const std::string& why)
        { throw mesh_error(fault, {}, std::string(Element::name) + ' ' + std::to_string(s.id) + why); };
        for (std::size_t k = 0; k < K; ++k)
        {
            if (s.corners[k] < 0)
                refuse(mesh_error::index_out_of_range,
                       " names vertex " + std::to_string(named[k]) + ", which no process gave; repair the mesh");
            for (std::size_t j = 0; j < k; ++j)
                if (s.corners[j] == s.corners[k])
                    refuse(mesh_error::repeated_vertex,
                           " names vertex " + std::to_string(named[k]) + " twice; remove it");
        }
    }

    /// The halo, and the cells in numbers of this process.
    void number_vertices()
    {
        const std::int64_t begin = first(), end = begin + static_cast<std::int64_t>(own);
        std::vector<std::int64_t> halo;
        for (const auto& s : sent_)
            for (const std::int64_t v : s.corners)
                if (v < begin || v >= end) halo.push_back(v);
        std::sort(halo.begin(), halo.end());
        halo.erase(std::unique(halo.begin(), halo.end()), halo.end());
        for (std::int64_t v = begin; v < end; ++v) numbers.push_back(v);
        numbers.insert(numbers.end(), halo.begin(), halo.end());
        for (const auto& s : sent_)
        {
            cell c;
            for (std::size_t k = 0; k < K; ++k)
            {
                const std::int64_t v = s.corners[k];
                const auto local = v >= begin && v < end
                                       ? v - begin
                                       : static_cast<std::int64_t>(own) +
                                             (std::lower_bound(halo.begin(), halo.end(), v) - halo.begin());
                c[k] = static_cast<idx>(local);
            }
            corners.push_back(c);
            cell_ids.push_back(s.id);
        }
        sent_ = {};
    }

    homes homes_;
    number_ranges ranges_;
    vertex_exchange halo_, answers_;
    std::size_t answered_ = 0;
    std::vector<sent_cell> sent_; ///< while it is made
};

} // namespace taut::dist::impl
