// SPDX-License-Identifier: MIT
#include "eval/atlas_measures.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/atlas_summary.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>

#include "shared/assessment.hpp"

namespace taut::tools
{

namespace
{

/// The columns first .. last - 1 of a row of samples.
struct column_span
{
    int first, last;
};

/// The columns of row y that lie on the inner side of an edge of a triangle that runs counter-clockwise: those where a
/// determinant is positive, which falls or rises along the row, in rounded numbers as well. An edge that two triangles
/// share counts for one of them.
column_span inside_of(const vec2& a, const vec2& b, int y, column_span within)
{
    const vec2 d = b - a;
    const auto inside = [&](int x)
    {
        const double det = glm::determinant(mat2(d, vec2(x, y) - a));
        return det > 0 || (det == 0 && (d.y < 0 || (d.y == 0 && d.x > 0)));
    };
    if (d.y == 0) return inside(within.first) ? within : column_span{within.first, within.first};
    const double where = std::ceil(a.x + d.x * ((y - a.y) / d.y));
    int x = static_cast<int>(std::clamp<double>(where, within.first, within.last));
    const bool rises = d.y < 0;
    while (x > within.first && inside(x - 1) == rises) --x;
    while (x < within.last && inside(x) != rises) ++x;
    return rises ? column_span{x, within.last} : column_span{within.first, x};
}

/// Marks columns of a row that has a bit for each; how many were not marked.
int mark(std::uint64_t* row, column_span columns)
{
    int fresh = 0;
    const int first = columns.first / 64, last = (columns.last - 1) / 64;
    for (int k = first; k <= last; ++k)
    {
        std::uint64_t bits = ~std::uint64_t{0};
        if (k == first) bits &= ~std::uint64_t{0} << (columns.first % 64);
        if (k == last) bits &= ~std::uint64_t{0} >> (63 - (columns.last - 1) % 64);
        fresh += std::popcount(bits & ~row[k]);
        row[k] |= bits;
    }
    return fresh;
}

/// 1 - area of the union of triangles by the sum of their areas, sampled on a grid over their box. A sample is marked
/// once, however many triangles lie on it.
double overlap_area(std::span<const std::array<idx, 3>> cells, std::span<const vec2> uv)
{
    constexpr int side = 2048;
    const auto at = [&](idx v) { return uv[static_cast<std::size_t>(v)]; };
    vec2 low = at(cells.front()[0]), high = low;
    for (const auto& t : cells)
        for (const idx v : t)
        {
            low = glm::min(low, at(v));
            high = glm::max(high, at(v));
        }
    const double unit = std::max(high.x - low.x, high.y - low.y) / side;
    if (!(unit > 0) || !std::isfinite(unit)) return 0;
    std::vector<std::uint64_t> covered(std::size_t(side) * side / 64, 0);
    std::vector<int> marked(side, 0); // of each row
    std::size_t samples = 0;
    for (const auto& t : cells)
    {
        std::array<vec2, 3> p{};
        for (std::size_t k = 0; k < 3; ++k) p[k] = (at(t[k]) - low) / unit - 0.5;
        if (glm::determinant(mat2(p[1] - p[0], p[2] - p[0])) < 0) std::swap(p[1], p[2]);
        const vec2 least = glm::min(glm::min(p[0], p[1]), p[2]), most = glm::max(glm::max(p[0], p[1]), p[2]);
        const auto clipped = [](double x) { return std::clamp(static_cast<int>(x), 0, side - 1); };
        for (int y = clipped(std::ceil(least.y)); y <= clipped(most.y); ++y)
        {
            column_span row{clipped(std::ceil(least.x)), clipped(most.x) + 1};
            for (std::size_t k = 0; k < 3 && row.first < row.last; ++k) row = inside_of(p[k], p[(k + 1) % 3], y, row);
            if (row.first >= row.last) continue;
            samples += static_cast<std::size_t>(row.last - row.first);
            if (int& here = marked[static_cast<std::size_t>(y)]; here < side)
                here += mark(&covered[static_cast<std::size_t>(y) * side / 64], row);
        }
    }
    const auto points = std::accumulate(marked.begin(), marked.end(), std::size_t{0});
    return samples > 0 ? 1 - static_cast<double>(points) / static_cast<double>(samples) : 0;
}

} // namespace

std::optional<atlas_measures> measure_atlas(const io::surface_file& file, const io::cut_surface* cut)
{
    const auto& m = file.surface;
    const auto f = impl::facets(m);
    constexpr mesh_requirements required{
        .referenced = false, .connected = false, .open = false, .one_boundary = false, .no_handles = false};
    if (m.cells().empty() || !check(m, f, required).empty()) return std::nullopt;
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    const auto& sheets = cut ? cut->surface.cells() : m.cells();
    const auto texcoords = cut ? cut->uv : file.vertex_texcoords();
    std::vector<char> seam(f.twin.size(), 0);
    for (std::size_t s = 0; s < seam.size(); ++s)
    {
        if (f.twin[s] < 0) continue;
        const auto corner = [&](std::size_t side, std::size_t turn) { return sheets[side / 3][(side + turn) % 3]; };
        seam[s] = corner(s, 1) != corner(u(f.twin[s]), 2) || corner(s, 2) != corner(u(f.twin[s]), 1);
    }
    const chart_mesh charts = cut_charts(m, f, seam);
    std::vector<vec2> uv(charts.surface.points().size());
    for (std::size_t i = 0; i < charts.cell_origins.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            uv[u(charts.surface.cells()[i][k])] = texcoords[u(sheets[u(charts.cell_origins[i])][k])];
    atlas_measures result;
    impl::summarize(result.report, charts, uv, {});
    result.report.seam_length = impl::length_of_seams(m, f, seam);
    result.overlap_area = overlap_area(charts.surface.cells(), uv);
    return result;
}

nlohmann::ordered_json to_json(const atlas_measures& m)
{
    const auto& r = m.report;
    nlohmann::ordered_json json;
    json["charts"] = r.charts.size();
    json["large_charts"] =
        std::count_if(r.charts.begin(), r.charts.end(), [](const auto& c) { return c.triangles > 10; });
    json["seam_length"] = finite(r.seam_length);
    json["relative_seam"] = finite(r.seam_length / std::sqrt(r.area));
    json["distortion"] = finite(r.distortion);
    json["stretch_l2"] = finite(r.stretch_l2);
    json["stretch_linf"] = finite(r.stretch_linf);
    json["area_distortion"] = finite(r.area_distortion);
    json["area_difference"] = finite(r.area_difference);
    json["density_spread"] = finite(r.density_spread);
    json["overlap_area"] = finite(m.overlap_area);
    return json;
}

void describe(labelled_lines& lines, const atlas_measures& m)
{
    const auto& r = m.report;
    const auto large = std::count_if(r.charts.begin(), r.charts.end(), [](const auto& c) { return c.triangles > 10; });
    lines.add("charts", count(r.charts.size(), "chart", "charts") + ", " + count(static_cast<std::size_t>(large)) +
                            " of more than ten triangles; seams " + number(r.seam_length / std::sqrt(r.area)) +
                            " by the root of the area");
    lines.add("at one scale", "isometric " + number(r.distortion) + ", stretch L2 " + number(r.stretch_l2) + ", Linf " +
                                  number(r.stretch_linf) + ", area " + number(r.area_distortion) +
                                  ", spread of texel density " + number(r.density_spread));
    lines.add("overlap", number(100 * m.overlap_area) + " % of the area");
}

} // namespace taut::tools
