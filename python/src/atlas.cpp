// SPDX-License-Identifier: MIT
// Atlases of surfaces.
#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include <taut/atlas.hpp>
#include <taut/repair.hpp>

#include "atlas_options.hpp"
#include "bindings.hpp"
#include "call.hpp"
#include "queues.hpp"
#include "reports.hpp"

namespace taut::python
{

namespace
{

std::size_t u(idx i)
{
    return static_cast<std::size_t>(i);
}

/// Triangles as the user has them, what is wanted of them, and what becomes of them.
struct atlas_job
{
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> triangles;
    std::vector<std::array<idx, 2>> seam_edges, weighted_edges;
    std::vector<double> edge_weights;           ///< of weighted_edges
    std::vector<idx> parts, polygons;           ///< labels of triangles, or none
    std::vector<idx> bodies;                    ///< labels of vertices, or none
    std::vector<std::array<vec2, 3>> corner_uv; ///< of triangles, or none
    std::vector<char> pinned;                   ///< triangles, or none
    std::vector<double> densities;              ///< of triangles, or none
    bool repair = true, weld = false;
    atlas_params params;
    run_limits limits;
    std::string device;

    std::optional<repaired_surface> repaired;
    std::optional<mesh<triangle>> whole;
    std::vector<char> seams, together;
    std::vector<double> weights; ///< of sides, or none
    std::shared_ptr<queue> queue_in_use;

    const mesh<triangle>& surface() const { return repaired ? repaired->surface : *whole; }
    idx vertex_origin(idx v) const { return repaired ? repaired->vertex_origins[u(v)] : v; }
    std::size_t cell_origin(std::size_t c) const { return repaired ? u(repaired->cell_origins[c]) : c; }
    std::size_t corner_origin(std::size_t c, std::size_t k) const
    {
        return repaired ? repaired->corner_origin(c, k) : k;
    }

    atlas make()
    {
        if (repair)
        {
            repair_params how;
            how.polygons = polygons;
            how.bodies = bodies;
            if (weld) how.weld_tolerance = repair_params::usual_tolerance(points, triangles);
            repaired.emplace(repair_surface(points, triangles, how));
        }
        else
            whole.emplace(points, triangles);
        mark_sides();
        weigh_sides();
        take_corners();
        queue_in_use = borrow_queue(device);
        return make_atlas(*queue_in_use, surface(), params, limits);
    }

private:
    /// Seams and diagonals as flags of sides.
    void mark_sides()
    {
        if (seam_edges.empty() && parts.empty() && polygons.empty()) return;
        const auto& m = surface();
        const auto f = impl::facets(m);
        std::set<std::array<idx, 2>> wanted;
        for (const auto& e : seam_edges) wanted.insert(ordered(e[0], e[1]));
        seams.assign(f.twin.size(), 0);
        together.assign(f.twin.size(), 0);
        for (std::size_t s = 0; s < f.twin.size(); ++s)
        {
            if (f.twin[s] < 0) continue;
            const std::size_t here = cell_origin(s / 3), there = cell_origin(u(f.twin[s]) / 3);
            if (!wanted.empty())
            {
                const auto e = impl::side_vertices(m, static_cast<idx>(s));
                seams[s] = wanted.contains(ordered(vertex_origin(e[0]), vertex_origin(e[1])));
            }
            if (!parts.empty() && parts[here] != parts[there]) seams[s] = 1;
            if (!polygons.empty() && polygons[here] == polygons[there]) together[s] = 1;
        }
        params.charts.seams = seams;
        if (!polygons.empty()) params.charts.together = together;
    }

    /// Two vertices of the user, the smaller one first.
    static std::array<idx, 2> ordered(idx a, idx b) { return {std::min(a, b), std::max(a, b)}; }

    /// Factors of the lengths of seams, by side; 1 where none is given.
    void weigh_sides()
    {
        if (weighted_edges.empty()) return;
        std::map<std::array<idx, 2>, double> of_edge;
        for (std::size_t i = 0; i < weighted_edges.size(); ++i)
            of_edge[ordered(weighted_edges[i][0], weighted_edges[i][1])] = edge_weights[i];
        const auto& m = surface();
        weights.assign(3 * m.cells().size(), 1);
        for (std::size_t s = 0; s < weights.size(); ++s)
        {
            const auto e = impl::side_vertices(m, static_cast<idx>(s));
            const auto found = of_edge.find(ordered(vertex_origin(e[0]), vertex_origin(e[1])));
            if (found != of_edge.end()) weights[s] = found->second;
        }
        params.charts.weights = weights;
    }

    /// Coordinates and pins of corners, and densities, for the triangles that are left.
    void take_corners()
    {
        const std::size_t cells = surface().cells().size();
        if (!corner_uv.empty())
        {
            params.initial.resize(cells);
            for (std::size_t c = 0; c < cells; ++c)
                for (std::size_t k = 0; k < 3; ++k)
                    params.initial[c][k] = corner_uv[cell_origin(c)][corner_origin(c, k)];
        }
        if (!pinned.empty())
        {
            params.pinned.resize(cells);
            for (std::size_t c = 0; c < cells; ++c) params.pinned[c] = pinned[cell_origin(c)];
        }
        if (!densities.empty())
            for (std::size_t c = 0; c < cells; ++c) params.packing.densities.push_back(densities[cell_origin(c)]);
    }
};

nb::dict report_of(const atlas_report& r)
{
    nb::dict d;
    d["complete"] = r.complete;
    d["reason"] = text(r.reason);
    d["notes"] = texts(r.notes);
    d["flips"] = dict_of(r.flips);
    d["overlaps"] = r.overlaps;
    d["distortion"] = r.distortion;
    d["worst"] = r.worst;
    d["stretch_l2"] = r.stretch_l2;
    d["stretch_linf"] = r.stretch_linf;
    d["utilization"] = r.utilization;
    d["seam_length"] = r.seam_length;
    d["least_distance"] = r.least_distance;
    d["tiles"] = r.tiles;
    d["resolution"] = r.resolution;
    if (r.seen_seam) d["seen_seam"] = *r.seen_seam;
    d["stacked"] = r.stacked;
    std::vector<idx> triangles, tiles;
    std::vector<double> areas, energies;
    for (const auto& c : r.charts)
    {
        triangles.push_back(c.triangles);
        tiles.push_back(c.tile);
        areas.push_back(c.area);
        energies.push_back(c.energy);
    }
    d["chart_triangles"] = array_of(triangles);
    d["chart_tiles"] = array_of(tiles);
    d["chart_areas"] = array_of(std::move(areas));
    d["chart_energies"] = array_of(std::move(energies));
    const auto& s = r.seconds;
    d["seconds"] = s.setup + s.charts + s.flatten + s.pack + s.certify;
    return d;
}

/// The atlas in the numbers of the user's triangles. What repair has left out lies in one point, (0, 0), with chart -1.
nb::dict dict_of(const atlas_job& job, atlas made)
{
    nb::dict d;
    d["report"] = report_of(made.report);
    const auto& cut = made.charts;
    std::vector<idx> vmapping;
    vmapping.reserve(cut.vertex_origins.size());
    for (const idx v : cut.vertex_origins) vmapping.push_back(job.vertex_origin(v));
    std::vector<std::array<idx, 3>> faces(job.triangles.size(), {-1, -1, -1});
    std::vector<idx> chart(job.triangles.size(), -1);
    for (idx c = 0; c < cut.charts(); ++c)
        for (auto i = u(cut.first_cell[u(c)]); i < u(cut.first_cell[u(c) + 1]); ++i)
        {
            const std::size_t own = u(cut.cell_origins[i]), origin = job.cell_origin(own);
            chart[origin] = c;
            for (std::size_t k = 0; k < 3; ++k) faces[origin][job.corner_origin(own, k)] = cut.surface.cells()[i][k];
        }
    auto uv = std::move(made.uv);
    std::vector<idx> at_origin(job.points.size(), -1);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const idx v = job.triangles[f][k];
            if (faces[f][k] >= 0 || v < 0 || u(v) >= at_origin.size()) continue;
            if (at_origin[u(v)] < 0)
            {
                at_origin[u(v)] = static_cast<idx>(vmapping.size());
                vmapping.push_back(v);
                uv.emplace_back(0.0);
            }
            faces[f][k] = at_origin[u(v)];
        }
    d["vmapping"] = array_of(vmapping);
    d["faces"] = array_of(faces);
    d["uv"] = array_of<2>(std::move(uv));
    d["chart"] = array_of(chart);
    nb::list repairs;
    if (job.repaired)
        for (const auto& f : job.repaired->findings) repairs.append(text(f.message()));
    d["repairs"] = repairs;
    return d;
}

nb::object make(const array& V, const array& F, const nb::dict& keywords, const control_handle& watched)
{
    const options given(keywords);
    auto job = std::make_shared<atlas_job>();
    job->points = places_of(V, "V");
    job->triangles = cells_of<3>(F, "F");
    if (const auto a = given.rows("seams")) job->seam_edges = cells_of<2>(*a, "seams");
    if (const auto a = given.rows("weighted_edges")) job->weighted_edges = cells_of<2>(*a, "seam_weights");
    if (const auto a = given.rows("edge_weights")) job->edge_weights = numbers_of(*a);
    if (const auto a = given.rows("parts")) job->parts = ids_of(*a);
    if (const auto a = given.rows("polygons")) job->polygons = ids_of(*a);
    if (const auto a = given.rows("bodies")) job->bodies = ids_of(*a);
    if (const auto a = given.rows("corner_uv"))
    {
        const auto corners = points_of<2>(*a, "corner_uv"); // three rows a triangle
        job->corner_uv.resize(corners.size() / 3);
        for (std::size_t i = 0; i < corners.size(); ++i) job->corner_uv[i / 3][i % 3] = corners[i];
    }
    if (const auto a = given.rows("pinned")) job->pinned = flags_of(*a);
    if (const auto a = given.rows("densities")) job->densities = numbers_of(*a);
    given.read("repair", job->repair);
    given.read("weld", job->weld);
    given.read("device", job->device);
    read_atlas_options(job->params, given);
    given.read_seconds("time_limit", job->limits.time_limit);
    job->limits.observer = watched.shared->observer("atlas");
    return told(run(watched.shared, given.progress(), [job] { return job->make(); }),
                [job](atlas made) -> nb::object { return dict_of(*job, std::move(made)); });
}

} // namespace

void add_atlas(nb::module_& m)
{
    m.def("atlas", &make);
}

} // namespace taut::python
