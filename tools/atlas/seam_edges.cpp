// SPDX-License-Identifier: MIT
#include "atlas/seam_edges.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/files/file/read_file.hpp>

#include "shared/at.hpp"
#include "shared/edge_list.hpp"
#include "shared/failure.hpp"
#include "shared/weight_list.hpp"

namespace taut::tools
{

namespace
{

[[noreturn]] void refuse_edge(const std::string& path, idx a, idx b)
{
    throw unsuitable_input(path + ": vertices " + std::to_string(a) + " and " + std::to_string(b) +
                           " have no edge; name two vertices of a triangle, from 0");
}

/// Marks these edges.
void mark_edges(std::vector<char>& seam, const std::vector<std::array<idx, 2>>& edges, const atlas_source& source,
                const std::string& path)
{
    const auto& m = source.surface();
    std::vector<char> found(edges.size(), 0);
    for (idx s = 0; s < 3 * m.cell_count(); ++s)
    {
        auto v = impl::side_vertices(m, s);
        for (idx& i : v) i = source.vertex_origin(i);
        std::sort(v.begin(), v.end());
        const auto edge = std::lower_bound(edges.begin(), edges.end(), v);
        if (edge == edges.end() || *edge != v) continue;
        seam[at(s)] = 1;
        found[static_cast<std::size_t>(edge - edges.begin())] = 1;
    }
    const auto missing = std::find(found.begin(), found.end(), char(0));
    if (missing == found.end()) return;
    const auto& e = edges[static_cast<std::size_t>(missing - found.begin())];
    refuse_edge(path, e[0], e[1]);
}

/// Marks the sides along which texture coordinates are torn.
void mark_texcoords(std::vector<char>& seam, const mesh<triangle>& m, const impl::facet_table& f,
                    const std::vector<std::array<vec2, 3>>& uv)
{
    const auto torn = impl::seams_of_map(m, f, uv);
    for (std::size_t s = 0; s < seam.size(); ++s) seam[s] = seam[s] != 0 || torn[s] != 0;
}

/// A number for each density.
std::vector<idx> labels_of(std::span<const double> densities)
{
    std::map<double, idx> number;
    std::vector<idx> result;
    for (const double d : densities) result.push_back(number.emplace(d, static_cast<idx>(number.size())).first->second);
    return result;
}

} // namespace

std::vector<char> seams_of(const std::vector<std::unique_ptr<atlas_source>>& sources, const joined_surfaces& joined,
                           const impl::facet_table& f, const atlas_options& options, std::span<const double> densities)
{
    if (options.seams.empty() && !options.keep_charts() && !options.keep_seams && !options.by_material &&
        densities.empty())
        return {};
    std::vector<char> seam(f.twin.size(), 0);
    if (!options.seams.empty())
        mark_edges(seam, parse_edges(io::impl::read_file(options.seams), options.seams, sources[0]->file_vertices),
                   *sources[0], options.seams);
    const auto part = [&](const std::vector<idx>& label)
    {
        const auto borders = impl::seams_between(f, label);
        for (std::size_t s = 0; s < seam.size(); ++s) seam[s] = seam[s] != 0 || borders[s] != 0;
    };
    if (options.by_material) part(tiles_by_material(*sources[0]));
    if (!densities.empty()) part(labels_of(densities));
    if (options.keep_charts()) mark_texcoords(seam, joined.surface, f, texcoords_of(sources));
    if (!options.keep_seams) return seam;

    std::vector<std::array<vec2, 3>> uv;
    std::vector<idx> label;
    bool any = false;
    for (const auto& source : sources)
    {
        auto own = source->texcoords();
        any = any || !own.empty();
        own.resize(source->surface().cells().size(), {vec2(0), vec2(0), vec2(0)});
        uv.insert(uv.end(), own.begin(), own.end());
        auto parts = source->parts();
        any = any || !parts.empty();
        parts.resize(source->surface().cells().size(), 0);
        label.insert(label.end(), parts.begin(), parts.end());
    }
    if (!any)
        throw unsuitable_input("--keep-seams: the file has neither texture coordinates nor materials; leave it out");
    mark_texcoords(seam, joined.surface, f, uv);
    part(label);
    return seam;
}

std::vector<double> seam_weights_of(const std::vector<std::unique_ptr<atlas_source>>& sources,
                                    const joined_surfaces& joined, const impl::facet_table& f,
                                    const atlas_options& options)
{
    std::vector<double> weights;
    const bool whole = !options.symmetric && options.pinned.empty(); // of the surface that is cut
    if (options.crease_angle < 180 && whole)
    {
        constexpr double border = 0.25;
        std::vector<idx> label;
        for (const auto& source : sources)
        {
            auto parts = source->parts();
            parts.resize(source->surface().cells().size(), 0);
            label.insert(label.end(), parts.begin(), parts.end());
        }
        const auto borders = impl::seams_between(f, label);
        if (std::count(borders.begin(), borders.end(), char(1)) > 0)
            for (const char b : borders) weights.push_back(b != 0 ? border : 1);
    }
    if (options.seam_weights.empty()) return weights;
    weights.resize(f.twin.size(), 1);
    const auto given =
        parse_weights(io::impl::read_file(options.seam_weights), options.seam_weights, sources[0]->file_vertices);
    std::set<std::array<idx, 2>> found;
    const auto factor = [&](idx v) { return given.of_vertices.empty() ? 1 : given.of_vertices[at(v)]; };
    for (std::size_t s = 0; s < weights.size(); ++s)
    {
        auto [a, b] = impl::side_vertices(joined.surface, static_cast<idx>(s));
        a = sources[0]->vertex_origin(a);
        b = sources[0]->vertex_origin(b);
        const auto edge = given.of_edges.find({std::min(a, b), std::max(a, b)});
        if (edge != given.of_edges.end()) found.insert(edge->first);
        weights[s] *= edge != given.of_edges.end() ? edge->second : std::sqrt(factor(a) * factor(b));
    }
    for (const auto& [pair, weight] : given.of_edges)
        if (!found.contains(pair)) refuse_edge(options.seam_weights, pair[0], pair[1]);
    for (double& w : weights) w = std::clamp(w, 1e-3, 1e3);
    return weights;
}

std::vector<idx> tiles_by_material(const atlas_source& source)
{
    auto tile = source.parts();
    if (tile.empty()) throw unsuitable_input("--tile-per-material: the file has no materials; leave it out");
    std::map<idx, idx> number; // in the order of appearance
    for (idx& t : tile) t = number.emplace(t, static_cast<idx>(number.size())).first->second;
    if (number.size() > 1000) throw unsuitable_input("--tile-per-material: more than 1000 materials; leave it out");
    return tile;
}

std::vector<char> diagonals_of(const std::vector<std::unique_ptr<atlas_source>>& sources, const impl::facet_table& f)
{
    std::vector<std::array<idx, 2>> polygon; // of each triangle: file, polygon
    bool any = false;
    for (std::size_t i = 0; i < sources.size(); ++i)
    {
        auto own = sources[i]->polygons();
        any = any || !own.empty();
        if (own.empty())
            for (idx c = 0; c < sources[i]->surface().cell_count(); ++c) own.push_back(c);
        for (const idx p : own) polygon.push_back({static_cast<idx>(i), p});
    }
    if (!any) return {};
    std::vector<char> diagonal(f.twin.size(), 0);
    for (std::size_t s = 0; s < diagonal.size(); ++s)
        if (f.twin[s] >= 0) diagonal[s] = polygon[s / 3] == polygon[at(f.twin[s]) / 3];
    return diagonal;
}

std::vector<std::array<vec2, 3>> texcoords_of(const std::vector<std::unique_ptr<atlas_source>>& sources)
{
    std::vector<std::array<vec2, 3>> uv;
    for (const auto& source : sources)
    {
        const auto own = source->texcoords();
        if (own.empty())
            throw unsuitable_input("a file has no texture coordinates (vt) that show charts; leave out --charts");
        uv.insert(uv.end(), own.begin(), own.end());
    }
    return uv;
}

} // namespace taut::tools
