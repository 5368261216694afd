// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numeric>
#include <vector>

#include <doctest/doctest.h>
#include <taut/impl/core/mesh/cell_corners.hpp>
#include <taut/impl/files/volume/cell_faces.hpp>
#include <taut/impl/files/volume/read_volume.hpp>
#include <taut/volume_file.hpp>

#include "support/volume_texts.hpp"

namespace
{

using namespace taut;
using namespace taut::impl;

io::volume_file mixed_file()
{
    return io::impl::parse_volume(test::medit_text(test::small_volume(true)), io::volume_format::medit, "a.mesh");
}

TEST_CASE("cell faces: normals point out, and the sides of cells that meet know each other")
{
    const auto file = mixed_file();
    const auto sides = file.faces();
    REQUIRE(sides.faces.size() == 2 * 4 + 6 + 5 + 5);
    std::vector<vec3> centres;
    io::impl::for_each_cell(file, 3,
                            [&](io::cell_kind, idx number, std::span<const idx> corners)
                            {
                                CHECK(number == static_cast<idx>(centres.size()));
                                vec3 centre(0.0);
                                for (const idx v : corners) centre += file.points[static_cast<std::size_t>(v)];
                                centres.push_back(centre / static_cast<double>(corners.size()));
                            });
    int inner = 0;
    for (std::size_t s = 0; s < sides.faces.size(); ++s)
    {
        const auto corners = sides.faces[s].corners();
        const auto at = [&](std::size_t k) { return file.points[static_cast<std::size_t>(corners[k])]; };
        const vec3 normal = glm::cross(at(1) - at(0), at(2) - at(0));
        CHECK(glm::dot(normal, at(0) - centres[static_cast<std::size_t>(sides.faces[s].cell)]) > 0);
        if (sides.twin[s] < 0) continue;
        ++inner;
        CHECK(sides.twin[static_cast<std::size_t>(sides.twin[s])] == static_cast<idx>(s));
    }
    CHECK(inner == 2 * 3); // two tetrahedra; a hexahedron with a wedge and with a pyramid
}

TEST_CASE("cell faces: a face with three cells is non_manifold")
{
    auto s = test::small_volume(false);
    s.cells.push_back({io::cell_kind::tetrahedron, {0, 1, 2, static_cast<idx>(s.points.size())}, 1});
    s.points.push_back({0.5, 0.4, 1});
    const auto sides = io::impl::parse_volume(test::medit_text(s), io::volume_format::medit, "a.mesh").faces();
    CHECK(std::count(sides.twin.begin(), sides.twin.end(), io::impl::cell_faces::non_manifold) == 3);
}

TEST_CASE("cell corners: the boundary of overlapping simplices is that of the cells")
{
    const auto parts = mixed_file().corner_simplices();
    const auto boundary = boundary_facets(parts.simplices, parts.cells);
    // Tetrahedra: 6 faces. Hexahedron, wedge and pyramid: 4 + 2 quads of four triangles, 2 + 4 triangles.
    CHECK(boundary.size() == 6 + 4 * 6 + 6);
    for (const auto& facet : boundary) CHECK(std::none_of(facet.begin(), facet.end(), [&](idx v) { return v < 0; }));
    CHECK(boundary_facets(parts.simplices).size() > boundary.size()); // as if they were cells

    // Tetrahedra at the edges of all cells leave the boundary as it is.
    const auto edged = mixed_file().corner_simplices(std::vector<idx>{0, 1, 2, 3, 4});
    CHECK(edged.cells.size() == parts.cells.size() + 6 + 24);
    CHECK(boundary_facets(edged.simplices, edged.cells).size() == boundary.size());
    for (idx c = 0; c < edged.simplices.cell_count(); ++c)
    {
        CHECK(taut::tetrahedron::determinant(edged.simplices.rest(c)) > 0);
        CHECK(glm::determinant(edged.regular[static_cast<std::size_t>(c)]) > 0);
    }
    const auto weight = [](const auto& all) { return std::accumulate(all.begin(), all.end(), 0.0); };
    CHECK(weight(edged.weights) == doctest::Approx(weight(parts.weights)));
}

} // namespace
