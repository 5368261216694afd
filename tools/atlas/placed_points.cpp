// SPDX-License-Identifier: MIT
#include "atlas/placed_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

#include <taut/impl/core/mesh/describe.hpp>

#include "shared/at.hpp"
#include "shared/text_table.hpp"

namespace taut::tools
{

namespace
{

using io::impl::gltf_transform;

/// The place of a mesh that counts, and the scales of all of them.
struct mesh_place
{
    gltf_transform place;
    double least = std::numeric_limits<double>::infinity(), most = -1;
};

std::map<idx, mesh_place> largest_places(std::span<const io::impl::gltf_draw> draws)
{
    std::map<idx, mesh_place> result;
    for (const auto& draw : draws)
    {
        mesh_place& known = result[static_cast<idx>(draw.mesh)];
        known.least = std::min(known.least, draw.least);
        if (!(draw.place.scale() > known.most)) continue;
        known.most = draw.place.scale();
        known.place = draw.place;
    }
    return result;
}

/// The triangles of one mesh.
class placed_mesh
{
public:
    placed_mesh(const mesh<triangle>& surface, std::vector<std::size_t> cells)
        : surface_(surface), cells_(std::move(cells))
    {
    }

    /// Whether it keeps its shape in doubles there, and no triangle loses its area.
    bool holds(const gltf_transform& place) const
    {
        constexpr double flat = 1e-10, far = 0x1p26; // of an area that scales alike; of the size
        const double scale = place.scale();
        if (!(scale > 0 && scale < 1e100)) return false;
        vec3 low(std::numeric_limits<double>::max()), high = -low;
        for (const std::size_t c : cells_)
        {
            std::array<vec3, 3> x = corners(c), y;
            for (std::size_t k = 0; k < 3; ++k)
            {
                y[k] = place.linear * x[k];
                low = glm::min(low, y[k]);
                high = glm::max(high, y[k]);
            }
            const double area = area_of(y);
            if (!(area > 0 && area >= flat * scale * scale * area_of(x))) return false;
        }
        return glm::length(place.shift) <= far * glm::length(high - low);
    }

    /// The middle of its box there, across x.
    double middle(const gltf_transform& place) const
    {
        double low = std::numeric_limits<double>::max(), high = -low;
        for (const std::size_t c : cells_)
            for (const vec3& x : corners(c))
            {
                low = std::min(low, place(x).x);
                high = std::max(high, place(x).x);
            }
        return low + (high - low) / 2;
    }

    void put(const gltf_transform& place, std::vector<vec3>& points) const
    {
        for (const std::size_t c : cells_)
            for (const idx v : surface_.cells()[c]) points[at(v)] = place(surface_.points()[at(v)]);
    }

private:
    std::array<vec3, 3> corners(std::size_t c) const
    {
        const auto& t = surface_.cells()[c];
        return {surface_.points()[at(t[0])], surface_.points()[at(t[1])], surface_.points()[at(t[2])]};
    }

    static double area_of(const std::array<vec3, 3>& x) { return glm::length(glm::cross(x[1] - x[0], x[2] - x[0])); }

    const mesh<triangle>& surface_;
    std::vector<std::size_t> cells_;
};

} // namespace

std::vector<vec3> placed_points(const mesh<triangle>& surface, std::span<const idx> meshes,
                                std::span<const io::impl::gltf_draw> draws, std::vector<std::string>& notes)
{
    const auto places = largest_places(draws);
    std::map<idx, std::vector<std::size_t>> cells;
    for (std::size_t c = 0; c < meshes.size(); ++c) cells[meshes[c]].push_back(c);
    std::vector<vec3> points = surface.points();
    std::vector<idx> flattened, left, varied;
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (auto& [m, own] : cells)
    {
        const auto found = places.find(m);
        if (found == places.end()) continue;
        const mesh_place& known = found->second;
        if (known.most > known.least * (1 + 1e-6)) varied.push_back(m);
        gltf_transform place = known.place;
        const placed_mesh of(surface, std::move(own));
        if (glm::determinant(place.linear) < 0) // where it is, turned inside out
        {
            place.shift.x = 2 * of.middle(place) - place.shift.x;
            for (int k = 0; k < 3; ++k) place.linear[k].x = -place.linear[k].x;
        }
        if (!of.holds(place)) place.shift = vec3(0.0);
        const bool flat = !of.holds(place);
        if (flat) place.linear = mat3(known.most);
        if (flat) (of.holds(place) ? flattened : left).push_back(m);
        if (!of.holds(place)) continue;
        of.put(place, points);
        least = std::min(least, known.most);
        most = std::max(most, known.most);
    }
    if (most > 0 && (std::abs(least - 1) > 1e-6 || std::abs(most - 1) > 1e-6))
        notes.push_back("lengths are those of the scene, in which nodes scale meshes by " + number(least) +
                        (most > least * (1 + 1e-6) ? " to " + number(most) : std::string()) +
                        "; --density-in file counts those of the meshes");
    if (!varied.empty())
        notes.push_back("drawn at several scales, of which the largest counts: " +
                        impl::list_ids("mesh", "meshes", varied));
    if (!flattened.empty())
        notes.push_back("flattened by nodes, and scaled alike in all directions instead: " +
                        impl::list_ids("mesh", "meshes", flattened));
    if (!left.empty())
        notes.push_back("scaled by nodes beyond what can be measured, and left as the file has them: " +
                        impl::list_ids("mesh", "meshes", left));
    return points;
}

} // namespace taut::tools
