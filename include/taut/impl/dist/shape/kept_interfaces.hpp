// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <taut/dist.hpp>
#include <taut/errors.hpp>
#include <taut/impl/core/mesh/cell_corners.hpp>
#include <taut/impl/dist/processes/part.hpp>
#include <taut/impl/files/volume/cell_faces.hpp>

namespace taut::dist::impl
{

/// Collective. The regions of the cells of a part, from those of the caller's cells, wherever they are.
template <class Element>
std::vector<long long> regions_of(const part<Element>& p, const mesh_piece<Element>& piece, const smooth_params& params)
{
    const auto& regions = params.regions;
    p.all.together(
        [&]
        {
            if (!regions.empty() && regions.size() != piece.cells.size())
                throw parameter_error("regions", std::to_string(regions.size()) + " for " +
                                                     std::to_string(piece.cells.size()) + " cells");
        });
    const std::int64_t before = p.all.before(static_cast<std::int64_t>(piece.cells.size()));
    const auto bounds = p.all.gathered(std::vector<std::int64_t>{before});
    parcels<std::int64_t> ask(p.all.ranks());
    std::vector<std::size_t> asked;
    for (const std::int64_t c : p.cell_ids)
    {
        asked.push_back(static_cast<std::size_t>(std::upper_bound(bounds.begin(), bounds.end(), c) - bounds.begin()) -
                        1);
        ask[asked.back()].push_back(c - bounds[asked.back()]);
    }
    const auto wanted = p.all.exchange(ask);
    parcels<std::int64_t> tell(p.all.ranks());
    for (std::size_t r = 0; r < p.all.ranks(); ++r)
        for (const std::int64_t c : wanted.from(r))
            tell[r].push_back(regions.empty() ? 0 : regions[static_cast<std::size_t>(c)]);
    const auto told = p.all.exchange(tell);
    auto next = told.begin;
    std::vector<long long> result;
    for (const std::size_t r : asked) result.push_back(told.items[next[r]++]);
    return result;
}

/// Collective. Labelled faces with an owned vertex, in numbers of the part.
template <class Element>
std::vector<std::pair<std::array<idx, 4>, long long>> labelled_here(const part<Element>& p, const smooth_params& params)
{
    std::vector<std::int64_t> ids;
    for (const auto& face : params.faces)
        for (const std::int64_t v : face.vertices)
            if (v >= 0) ids.push_back(v);
    const auto numbers = p.find(ids);
    parcels<labelled_face> to(p.all.ranks());
    p.all.together(
        [&]
        {
            std::size_t at = 0;
            for (labelled_face face : params.faces)
            {
                std::vector<std::size_t> places;
                for (std::int64_t& v : face.vertices)
                {
                    if (v < 0) continue;
                    if (numbers[at] < 0)
                        throw parameter_error("faces",
                                              "one names vertex " + std::to_string(v) + ", which no process gave");
                    v = numbers[at++];
                    places.push_back(p.place_of(v).rank);
                }
                std::sort(places.begin(), places.end());
                places.erase(std::unique(places.begin(), places.end()), places.end());
                for (const std::size_t r : places) to[r].push_back(face);
            }
        });
    std::vector<std::pair<std::array<idx, 4>, long long>> here;
    for (const auto& face : p.all.exchange(to).items)
    {
        std::array<idx, 4> local{-1, -1, -1, -1};
        bool known = true;
        for (std::size_t k = 0; k < 4 && face.vertices[k] >= 0; ++k)
        {
            const std::int64_t v = face.vertices[k], first = p.first();
            const bool mine = v >= first && v < first + static_cast<std::int64_t>(p.own);
            const auto halo = p.numbers.begin() + static_cast<std::ptrdiff_t>(p.own);
            const auto at = mine ? p.numbers.begin() + (v - first) : std::lower_bound(halo, p.numbers.end(), v);
            known = known && at != p.numbers.end() && *at == v;
            local[k] = static_cast<idx>(at - p.numbers.begin());
        }
        if (known) here.emplace_back(local, face.label); // else it is no face of a cell here
    }
    return here;
}

/// The cells of a part, put together again where simplices are parts of them, with their regions.
template <class Element>
io::volume_file cells_of(const part<Element>& p, const std::vector<long long>& regions)
{
    io::volume_file file;
    file.dimension = Element::dimension;
    file.points = p.points;
    io::volume_label label{"region", true, {}};
    const auto add = [&](io::cell_kind kind, const auto& corners)
    {
        if (file.cells.empty() || file.cells.back().kind != kind) file.cells.push_back({kind, {}});
        auto& all = file.cells.back().corners;
        all.insert(all.end(), corners.begin(), corners.end());
    };
    for (std::size_t first = 0, last = 0; first < p.corners.size(); first = last)
    {
        while (last == first || (last < p.corners.size() && !p.owners.empty() && p.owners[last] == p.owners[first]))
            ++last;
        const std::size_t parts = taut::impl::corner_simplex_count(last - first);
        const std::size_t corners = parts == 1 ? Element::corners : Element::dimension == 3 && parts == 4 ? 5 : parts;
        const auto kind = Element::dimension == 2 ? (corners == 3 ? io::cell_kind::triangle : io::cell_kind::quad)
                          : corners == 4          ? io::cell_kind::tetrahedron
                          : corners == 5          ? io::cell_kind::pyramid
                          : corners == 6          ? io::cell_kind::wedge
                                                  : io::cell_kind::hexahedron;
        std::vector<idx> cell(corners, 0);
        const auto table = taut::impl::corner_simplices(corners, Element{});
        for (std::size_t s = 0; s < table.size(); ++s)
            for (std::size_t k = 0; k < table[s].size(); ++k) cell[table[s][k]] = p.corners[first + s][k];
        add(kind, cell);
        label.values.push_back(regions[first]);
    }
    file.labels.push_back(std::move(label));
    return file;
}

/// Collective. Facets with an owned vertex of the surfaces that smoothing keeps, as io::volume_file::kept_facets()
/// finds them in the whole mesh: all cells and labelled faces of an owned vertex are here.
template <class Element>
std::vector<taut::impl::kept_facet> kept_interfaces(const part<Element>& p, const mesh_piece<Element>& piece,
                                                    const smooth_params& params)
{
    if (!p.all.any(!params.regions.empty() || !params.faces.empty())) return {};
    const auto regions = regions_of(p, piece, params);
    const auto faces = labelled_here(p, params);
    if (p.corners.empty()) return {};
    auto file = cells_of(p, regions);
    for (const auto& [vertices, label] : faces)
    {
        const std::size_t n = vertices[2] < 0 ? 2 : vertices[3] < 0 ? 3 : 4;
        file.cells.push_back({n == 2   ? io::cell_kind::line
                              : n == 3 ? io::cell_kind::triangle
                                       : io::cell_kind::quad,
                              {vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(n)}});
        file.labels[0].values.push_back(label);
    }
    auto kept = file.kept_facets(params.boundary == smooth_boundary::sliding);
    std::erase_if(kept,
                  [&](const auto& facet)
                  {
                      const auto corners = facet.corners();
                      return std::none_of(corners.begin(), corners.end(), [&](idx v) { return p.owns(v); });
                  });
    return kept;
}

} // namespace taut::dist::impl
