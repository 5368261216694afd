// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/charts/repair/describe_finding.hpp>
#include <taut/impl/charts/repair/fans.hpp>
#include <taut/impl/charts/repair/places.hpp>
#include <taut/impl/charts/repair/repair_surface.hpp>
#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/impl/core/core/short_number.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/core/mesh/last_digit.hpp>
#include <taut/repair.hpp>

namespace taut
{

void repair_params::validate(std::size_t points, std::size_t triangles) const
{
    if (!(weld_tolerance >= 0) || !std::isfinite(weld_tolerance))
        throw parameter_error("weld_tolerance", "must be a length, 0 or more");
    if (!bodies.empty() && bodies.size() != points)
        throw parameter_error("bodies", std::to_string(bodies.size()) + " for " + std::to_string(points) +
                                            " vertices; give one per vertex");
    if (!polygons.empty() && polygons.size() != triangles)
        throw parameter_error("polygons", std::to_string(polygons.size()) + " for " + std::to_string(triangles) +
                                              " triangles; give one per triangle");
    if (!normal_cells.empty() && normal_cells.size() != triangles)
        throw parameter_error("normal_cells", std::to_string(normal_cells.size()) + " for " +
                                                  std::to_string(triangles) + " triangles; give one per triangle");
    if (normal_cells.empty() && !normals.empty() && normals.size() != points)
        throw parameter_error("normals", std::to_string(normals.size()) + " for " + std::to_string(points) +
                                             " vertices; give one per vertex, or say which corners have which");
    for (const auto& t : normal_cells)
        for (const idx n : t)
            if (n < -1 || n >= static_cast<idx>(normals.size()))
                throw parameter_error("normal_cells", std::to_string(n) + " of " + std::to_string(normals.size()) +
                                                          " normals; numbers start at 0, -1 is none");
}

} // namespace taut

namespace taut::impl
{

/// One repair, step by step.
class surface_repair
{
public:
    surface_repair(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles,
                   const repair_params& params)
        : points_(points), triangles_(triangles), params_(params)
    {
    }

    repaired_surface operator()()
    {
        require_sizes();
        leave_out_unusable();
        bring_to_places();
        leave_out_copies();
        pair_sides();
        return finish();
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }
    const std::array<idx, 3>& input(idx cell) const { return triangles_[u(cell)]; }

    void require_sizes() const
    {
        constexpr std::size_t limit = std::numeric_limits<idx>::max();
        if (triangles_.empty()) throw mesh_error(describe<triangle>(mesh_error::empty, {}));
        if (points_.size() > limit || triangles_.size() > limit / 3)
            throw mesh_error(describe<triangle>(mesh_error::too_large, {}));
    }

    void note(repair_kind kind, std::vector<idx> ids)
    {
        if (!ids.empty()) findings_.push_back(describe_finding(kind, std::move(ids)));
    }

    void require_cells() const
    {
        if (!cells_.empty()) return;
        std::string what = "no triangle is left of " + std::to_string(triangles_.size());
        for (const auto& f : findings_) what += (&f == findings_.data() ? ": " : ", ") + f.problem;
        throw repair_error(what, findings_);
    }

    void leave_out_unusable()
    {
        std::vector<char> named(points_.size(), 0);
        for (const auto& t : triangles_)
            for (const idx v : t)
                if (is_vertex(v)) named[u(v)] = 1;
        std::vector<idx> broken, unnamed;
        for (std::size_t v = 0; v < points_.size(); ++v)
        {
            if (!finite(points_[v])) broken.push_back(static_cast<idx>(v));
            if (named[v] == 0) unnamed.push_back(static_cast<idx>(v));
        }
        cells_.resize(triangles_.size());
        std::iota(cells_.begin(), cells_.end(), idx(0));
        const auto any_of = [this](idx c, auto is) { return std::any_of(input(c).begin(), input(c).end(), is); };
        note(repair_kind::index_out_of_range,
             take_out(cells_, [&](idx c) { return any_of(c, [&](idx v) { return !is_vertex(v); }); }));
        note(repair_kind::non_finite, broken);
        if (!broken.empty())
            take_out(cells_, [&](idx c) { return any_of(c, [&](idx v) { return !finite(points_[u(v)]); }); });
        note(repair_kind::repeated_vertex, take_out(cells_, [&](idx c) { return is_repeated(input(c)); }));
        unreferenced_ = std::move(unnamed);
        require_cells();
    }

    bool is_vertex(idx v) const { return v >= 0 && u(v) < points_.size(); }
    static bool is_repeated(const std::array<idx, 3>& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

    /// Finds coincident points, and removes degenerate triangles.
    void bring_to_places()
    {
        std::vector<char> used(points_.size(), 0);
        for (const idx c : cells_)
            for (const idx v : input(c)) used[u(v)] = 1;
        place_ = equal_places(points_, params_.bodies, ones_of(used));
        auto flat = place_triangles();
        if (params_.weld_tolerance > 0 && !cells_.empty())
        {
            const auto open = open_places(); // these before place_ is moved away
            const auto far = reach();
            place_ = near_places(points_, params_.bodies, std::move(place_), open, far, params_.weld_tolerance);
            const auto more = place_triangles();
            flat.insert(flat.end(), more.begin(), more.end());
            std::sort(flat.begin(), flat.end());
        }
        note(repair_kind::degenerate_cell, std::move(flat));
        require_cells();
    }

    static std::vector<idx> ones_of(const std::vector<char>& marks)
    {
        std::vector<idx> ids;
        for (std::size_t i = 0; i < marks.size(); ++i)
            if (marks[i] != 0) ids.push_back(static_cast<idx>(i));
        return ids;
    }

    /// Returns the flat triangles.
    std::vector<idx> place_triangles()
    {
        auto flat = take_out(cells_,
                             [this](idx c)
                             {
                                 auto t = input(c);
                                 for (idx& v : t) v = place_[u(v)];
                                 return is_repeated(t);
                             });
        if (cells_.empty()) return flat;
        place_cells();
        // What is largest may be flat: a triangle too small for it to have an area is found flat by nobody later.
        auto thin = bad_rest_cells(placed_->places).first;
        if (thin.empty()) return flat;
        for (idx& c : thin) c = cells_[u(c)];
        leave_out(thin);
        flat.insert(flat.end(), thin.begin(), thin.end());
        std::sort(flat.begin(), flat.end());
        return flat;
    }

    /// Removes the triangles of an ascending list.
    void leave_out(const std::vector<idx>& some)
    {
        take_out(cells_, [&](idx c) { return std::binary_search(some.begin(), some.end(), c); });
        if (!cells_.empty()) place_cells();
    }

    void place_cells()
    {
        placed_ = impl::place_triangles(points_, triangles_, cells_, place_);
        placed_->polygons = params_.polygons;
    }

    /// The places, as vertices of the input, where open edges end.
    std::vector<idx> open_places() const
    {
        const auto f = facets(placed_->places);
        std::vector<char> open(points_.size(), 0);
        for (std::size_t s = 0; s < f.twin.size(); ++s)
            if (f.twin[s] == facet_table::boundary)
                for (const idx a : placed_triangles::ends(static_cast<idx>(s)))
                    open[u(place_[u(placed_->vertex(a))])] = 1;
        return ones_of(open);
    }

    /// Maximum distance at which a place may be welded to another, so that no two corners of a triangle meet.
    std::vector<double> reach() const
    {
        std::vector<double> result(points_.size(), params_.weld_tolerance);
        for (const idx c : cells_)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const idx a = place_[u(input(c)[k])], b = place_[u(input(c)[(k + 1) % 3])];
                const vec3 edge = points_[u(b)] - points_[u(a)];
                const double most = 0.49 * std::hypot(edge.x, edge.y, edge.z);
                for (const idx v : {a, b}) result[u(v)] = std::min(result[u(v)], most);
            }
        return result;
    }

    void leave_out_copies()
    {
        f_ = facets(placed_->places);
        auto pairs = copies(*placed_, f_);
        if (!pairs.empty())
        {
            std::vector<idx> seconds;
            for (std::size_t i = 1; i < pairs.size(); i += 2) seconds.push_back(pairs[i]);
            std::sort(seconds.begin(), seconds.end());
            leave_out(seconds);
            f_ = facets(placed_->places);
        }
        note(repair_kind::duplicate_cell, std::move(pairs));
        note(repair_kind::unreferenced_vertex, std::move(unreferenced_));
    }

    void pair_sides()
    {
        std::vector<std::vector<idx>> open;
        pairs_ = pair_clear_sides(*placed_, f_, open);
        way_ = wind(*placed_, pairs_.twin);
        for (const idx s : way_.cut) pairs_.part(s);
        for (const auto& crowd : open) pair_crowd(*placed_, way_, crowd, pairs_);
        fan_ = fans(*placed_, pairs_);
        if (part_repeated(*placed_, f_, fan_, pairs_)) fan_ = fans(*placed_, pairs_);
        for (const auto& sides : open) note_crowd(sides);
        // What is stitched badly is not stitched; the surface is none the worse for it.
        std::erase_if(way_.cut,
                      [this](idx s) { return f_.twin[u(s)] >= 0 && placed_->edge(s) != placed_->edge(f_.twin[u(s)]); });
    }

    /// Looks for edges of the input with three or more among sides at one place, which are in the order of their edges.
    void note_crowd(const std::vector<idx>& sides)
    {
        const auto same = [&](std::size_t i, std::size_t j)
        { return placed_->edge(sides[i]) == placed_->edge(sides[j]); };
        const std::size_t before = crowded_.size();
        for (std::size_t i = 2; i < sides.size(); ++i)
            if (same(i, i - 2) && (i == 2 || !same(i, i - 3))) crowded_.push_back(sides[i]);
        const bool open = std::any_of(sides.begin(), sides.end(), [this](idx s) { return pairs_.twin[u(s)] < 0; });
        if (open && crowded_.size() == before) ++unsewn_;
    }

    /// The edges of sides, in the vertices of the input.
    std::vector<idx> edges_of(const std::vector<idx>& sides) const
    {
        std::vector<std::array<idx, 2>> edges;
        for (const idx s : sides) edges.push_back(placed_->edge(s));
        std::sort(edges.begin(), edges.end());
        std::vector<idx> ids;
        for (const auto& e : edges) ids.insert(ids.end(), e.begin(), e.end());
        return ids;
    }

    repaired_surface finish()
    {
        const auto corners = fan_.size();
        std::vector<idx> origin(corners, std::numeric_limits<idx>::max()), first; // of fans, by their first corners
        for (std::size_t a = 0; a < corners; ++a)
        {
            if (fan_[a] == static_cast<idx>(a)) first.push_back(fan_[a]);
            idx& o = origin[u(fan_[a])];
            o = std::min(o, placed_->vertex(static_cast<idx>(a)));
        }
        std::vector<idx> number(corners), vertex_origins(first.size());
        std::vector<vec3> points(first.size());
        counting_sort(
            first.size(), points_.size(), [&](std::size_t i) { return origin[u(first[i])]; },
            [&](std::size_t i, std::size_t at)
            {
                const idx v = origin[u(first[i])];
                number[u(first[i])] = static_cast<idx>(at);
                vertex_origins[at] = v;
                points[at] = points_[u(place_[u(v)])];
            });
        std::vector<std::array<idx, 3>> cells(cells_.size());
        for (std::size_t c = 0; c < cells.size(); ++c)
        {
            for (std::size_t k = 0; k < 3; ++k) cells[c][k] = number[u(fan_[3 * c + k])];
            if (way_.turned[c] != 0) std::swap(cells[c][1], cells[c][2]);
        }
        note_welded(origin);
        note_turned();
        note_parted();
        note_normals();
        return {mesh<triangle>(std::move(points), std::move(cells)), std::move(vertex_origins), std::move(cells_),
                std::move(way_.turned), std::move(findings_)};
    }

    void note_welded(const std::vector<idx>& origin)
    {
        std::vector<std::pair<idx, idx>> welded;
        for (std::size_t a = 0; a < fan_.size(); ++a)
            if (const idx v = placed_->vertex(static_cast<idx>(a)), o = origin[u(fan_[a])]; v != o)
                welded.emplace_back(o, v);
        std::sort(welded.begin(), welded.end());
        welded.erase(std::unique(welded.begin(), welded.end()), welded.end());
        std::vector<idx> ids;
        for (const auto& [o, v] : welded) ids.insert(ids.end(), {o, v});
        const bool apart = std::any_of(welded.begin(), welded.end(),
                                       [this](const auto& w) { return points_[u(w.first)] != points_[u(w.second)]; });
        note(repair_kind::coincident_vertex, std::move(ids));
        if (apart) findings_.back().action += ", being within " + short_number(params_.weld_tolerance, 2);
        if (!welded.empty() && unsewn_ > 0)
            findings_.back().action +=
                "; " + counted(unsewn_, "edge", "edges") + " left open where three or more triangles would meet";
    }

    void note_turned()
    {
        std::vector<idx> ids;
        for (std::size_t c = 0; c < cells_.size(); ++c)
            if (way_.turned[c] != 0) ids.push_back(cells_[c]);
        note(repair_kind::inconsistent_orientation, std::move(ids));
        note(repair_kind::not_orientable, edges_of(way_.cut));
    }

    /// Vertices at edges that are parted are named there.
    void note_parted()
    {
        auto edges = edges_of(crowded_);
        std::vector<char> several(points_.size(), 0), at_edge(points_.size(), 0);
        std::vector<idx> fan_of(points_.size(), -1);
        for (const auto& sides : {crowded_, way_.cut})
            for (const idx s : sides)
                for (const idx a : placed_triangles::ends(s)) at_edge[u(place_[u(placed_->vertex(a))])] = 1;
        for (std::size_t a = 0; a < fan_.size(); ++a)
        {
            const std::size_t v = u(placed_->vertex(static_cast<idx>(a)));
            if (at_edge[u(place_[v])] == 0 && fan_of[v] >= 0 && fan_of[v] != fan_[a]) several[v] = 1;
            fan_of[v] = fan_[a];
        }
        note(repair_kind::non_manifold_facet, std::move(edges));
        note(repair_kind::non_manifold_vertex, ones_of(several));
    }

    void note_normals()
    {
        if (params_.normals.empty()) return;
        std::vector<idx> ids;
        for (std::size_t c = 0; c < cells_.size(); ++c)
        {
            const auto x = placed_->rest(static_cast<idx>(c));
            const vec3 normal = glm::cross(x[1] - x[0], x[2] - x[0]) * (way_.turned[c] != 0 ? -1.0 : 1.0);
            const auto& t = params_.normal_cells.empty() ? input(cells_[c]) : params_.normal_cells[u(cells_[c])];
            if (std::all_of(t.begin(), t.end(),
                            [&](idx n) { return n >= 0 && glm::dot(params_.normals[u(n)], normal) < 0; }))
                ids.push_back(cells_[c]);
        }
        note(repair_kind::contradicting_normal, std::move(ids));
    }

    std::span<const vec3> points_;
    std::span<const std::array<idx, 3>> triangles_;
    const repair_params& params_;
    std::vector<repair_finding> findings_;
    std::vector<idx> cells_; // of the input, those that are left
    std::vector<idx> place_; // the vertex of the input that stands for the place of each
    std::vector<idx> unreferenced_;
    std::optional<placed_triangles> placed_; // those of cells_
    facet_table f_;                          // of them
    side_pairs pairs_;
    winding way_;
    std::vector<idx> fan_;     // one per corner
    std::vector<idx> crowded_; // one side of each edge of the input that was parted
    std::size_t unsewn_ = 0;   // places of edges that might have been stitched
};

} // namespace taut::impl

namespace taut
{

double repair_params::usual_tolerance(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles)
{
    const auto used = impl::named_points(points, triangles);
    if (used.empty()) return 0;
    const double quarter = impl::quarter_of_size(used);
    const double usual = std::max(4e-7 * quarter, std::min(8 * impl::last_digit(used), 4e-3 * quarter));
    return std::isfinite(usual) ? usual : 0;
}

} // namespace taut

namespace taut::impl
{

std::size_t count_near_edges(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles,
                             double weld_tolerance, std::span<const idx> bodies)
{
    if (triangles.empty()) return 0;
    try
    {
        const auto r = repair_surface(points, triangles, {.weld_tolerance = weld_tolerance, .bodies = bodies});
        const auto open = [](const mesh<triangle>& m)
        {
            const auto f = facets(m);
            return static_cast<std::size_t>(std::count(f.twin.begin(), f.twin.end(), facet_table::boundary));
        };
        const auto welded = [](const repair_finding& f) { return f.kind == repair_kind::coincident_vertex; };
        if (std::none_of(r.findings.begin(), r.findings.end(), welded)) return 0;
        const std::size_t before =
            open(mesh<triangle>({points.begin(), points.end()}, {triangles.begin(), triangles.end()}));
        const std::size_t after = open(r.surface);
        return before > after ? before - after : 0;
    }
    catch (const repair_error&)
    {
        return 0;
    }
}

} // namespace taut::impl

namespace taut
{

repaired_surface repair_surface(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles,
                                const repair_params& params)
{
    params.validate(points.size(), triangles.size());
    return impl::surface_repair(points, triangles, params)();
}

} // namespace taut
