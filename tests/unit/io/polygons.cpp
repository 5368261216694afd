// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <taut/impl/core/mesh/facets.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/impl/files/surface/obj.hpp>
#include <taut/impl/files/surface/off.hpp>
#include <taut/impl/files/surface/ply.hpp>
#include <taut/mesh.hpp>

namespace
{

using namespace taut;

const vec3 across(2.0 / 3, 1.0 / 3, 2.0 / 3), up(-2.0 / 3, 2.0 / 3, 1.0 / 3);
const vec3 normal_of_plane = glm::cross(across, up);

/// An OBJ file of points in a tilted plane and faces.
std::string obj_text(const std::vector<vec2>& points, const std::vector<std::vector<int>>& faces, double lift = 0)
{
    std::ostringstream text;
    text.precision(17);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const vec3 p = points[i].x * across + points[i].y * up + vec3(0, 0, i % 2 == 0 ? lift : 0);
        text << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    }
    for (const auto& face : faces)
    {
        text << 'f';
        for (const int v : face) text << ' ' << v;
        text << '\n';
    }
    return text.str();
}

/// The area of a surface whose triangles all face one way.
double area_facing(const mesh<triangle>& m, const vec3& normal)
{
    double sum = 0;
    int turned = 0;
    for (idx c = 0; c < m.cell_count(); ++c)
    {
        const auto x = m.rest(c);
        const double area = 0.5 * glm::dot(glm::cross(x[1] - x[0], x[2] - x[0]), normal);
        turned += area > 1e-6 ? 0 : 1;
        sum += area;
    }
    CHECK(turned == 0);
    return sum;
}

/// Corners on a circle.
std::vector<vec2> ring(int n, double radius, vec2 middle = vec2(0.0))
{
    std::vector<vec2> points;
    for (int k = 0; k < n; ++k)
        points.push_back(middle +
                         radius * vec2(std::cos(2 * std::numbers::pi * k / n), std::sin(2 * std::numbers::pi * k / n)));
    return points;
}

bool is_surface(const mesh<triangle>& m)
{
    return check(m, {.connected = true, .open = false, .one_boundary = false, .no_handles = false}).empty();
}

} // namespace

TEST_CASE("polygons: an outline that runs in to a hole along a slit and out again is covered once")
{
    const std::vector<vec2> points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 1}, {1, 3}, {3, 3}, {3, 1}};
    for (const auto& face : {std::vector{1, 2, 3, 4, 1, 5, 6, 7, 8, 5}, std::vector{5, 1, 2, 3, 4, 1, 5, 6, 7, 8},
                             std::vector{7, 8, 5, 1, 2, 3, 4, 1, 5, 6}, std::vector{2, 3, 4, 1, 2, 8, 5, 6, 7, 8}})
    {
        const auto m = io::impl::parse_obj(obj_text(points, {face})).surface;
        CHECK(m.cell_count() == 8);
        CHECK(area_facing(m, normal_of_plane) == doctest::Approx(12));
        CHECK(is_surface(m));
        CHECK(boundary_loops(m).size() == 2);
    }
}

TEST_CASE("polygons: holes of many corners, several of them, and slits that share a corner")
{
    for (const int n : {3, 5, 12, 64, 300})
    {
        auto points = ring(n, 4.0);
        std::vector<int> face;
        for (int k = 1; k <= n; ++k) face.push_back(k);
        double area = 0.5 * n * std::sin(2 * std::numbers::pi / n);
        double expected = 16 * area;
        for (const vec2 middle : {vec2(0, -1), vec2(0, 0), vec2(0, 1)})
        {
            const int first = static_cast<int>(points.size()) + 1;
            const auto hole = ring(n, 0.3, middle);
            points.insert(points.end(), hole.begin(), hole.end());
            face.push_back(1); // from the first corner, which has the number 1, to the hole and back
            for (int k = 0; k <= n; ++k) face.push_back(first + (n - k) % n);
            expected -= 0.09 * area;
        }
        CAPTURE(n);
        const auto m = io::impl::parse_obj(obj_text(points, {face})).surface;
        CHECK(m.cell_count() == static_cast<idx>(face.size()) - 2);
        CHECK(area_facing(m, normal_of_plane) == doctest::Approx(expected).epsilon(1e-4));
        CHECK(is_surface(m));
        CHECK(boundary_loops(m).size() == 4);
    }
}

TEST_CASE("polygons: a slit without a hole has its end inside")
{
    const std::vector<vec2> points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 1}};
    const auto m = io::impl::parse_obj(obj_text(points, {{1, 2, 3, 4, 1, 5}})).surface;
    CHECK(m.cell_count() == 4);
    CHECK(area_facing(m, normal_of_plane) == doctest::Approx(16));
    CHECK(is_surface(m));
}

TEST_CASE("polygons: a vertex that is named twice in a row, or an outline that goes out and back, takes nothing away")
{
    const std::vector<vec2> points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {7, 6}, {8, 7}};
    for (const auto& face :
         {std::vector{1, 2, 3, 4}, std::vector{1, 2, 2, 3, 4}, std::vector{1, 2, 3, 4, 1},
          std::vector{1, 1, 2, 3, 3, 3, 4, 1}, std::vector{1, 2, 3, 5, 3, 4}, std::vector{1, 2, 3, 5, 6, 5, 3, 4}})
    {
        const auto m = io::impl::parse_obj(obj_text(points, {face})).surface;
        CHECK(m.cell_count() == 2);
        CHECK(area_facing(m, normal_of_plane) == doctest::Approx(16));
    }
    CHECK(io::impl::parse_obj(obj_text(points, {{1, 2, 3, 3}})).surface.cell_count() == 1);
    CHECK(io::impl::parse_obj(obj_text(points, {{1, 2, 3}, {1, 2, 1, 2}})).surface.cell_count() == 1);
}

TEST_CASE("polygons: thousands of corners in three places, or on one line, take a bounded number of steps")
{
    std::vector<vec2> places, line;
    std::vector<int> face;
    for (int k = 0; k < 9000; ++k)
    {
        places.push_back(std::array<vec2, 3>{{{-2, -3.125}, {-3, 4.5}, {-1.125, 0}}}[static_cast<std::size_t>(k % 3)]);
        line.push_back(0.1 * (k * 7919 % 9000) * vec2(1, 3));
        face.push_back(k + 1);
    }
    for (const auto& points : {places, line})
        CHECK(io::impl::parse_obj(obj_text(points, {face})).surface.cell_count() == 8998);
}

TEST_CASE("polygons: corners on straight lines get triangles with an area")
{
    // A triangle with seven corners on one side, and a square with corners on all sides.
    const std::vector<vec2> points = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}, {6, 0}, {1, 5}};
    const auto fan = io::impl::parse_obj(obj_text(points, {{1, 2, 3, 4, 5, 6, 7, 8}})).surface;
    CHECK(fan.cell_count() == 6);
    CHECK(area_facing(fan, normal_of_plane) == doctest::Approx(15));
    const std::vector<vec2> square = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2},
                                      {3, 3}, {2, 3}, {1, 3}, {0, 3}, {0, 2}, {0, 1}};
    const auto m = io::impl::parse_obj(obj_text(square, {{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}})).surface;
    CHECK(m.cell_count() == 10);
    CHECK(area_facing(m, normal_of_plane) == doctest::Approx(9));
}

TEST_CASE("polygons: two quads around a vertex of two faces get other diagonals")
{
    const std::vector<vec2> points = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0.8, 1.2}};
    const auto m = io::impl::parse_obj(obj_text(points, {{1, 2, 3, 5}, {1, 5, 3, 4}}, 0.3)).surface;
    CHECK(m.cell_count() == 4);
    CHECK(is_surface(m));
    const auto triangle_and_quad =
        io::impl::parse_obj(obj_text(points, {{1, 2, 3}, {1, 3, 4, 5}, {1, 5, 4}}, 0.3)).surface;
    CHECK(is_surface(triangle_and_quad));
}

TEST_CASE("polygons: a chain of quads that take each other's diagonals is parted")
{
    // Around an edge 1-2 that is a diagonal of the first quad and an edge of nothing; each of the following ones has a
    // diagonal of the one before.
    const std::vector<vec2> points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1.5, 2}, {2.5, 2.2}};
    const auto m = io::impl::parse_obj(obj_text(points, {{1, 2, 3, 6}, {1, 6, 3, 5}, {1, 5, 3, 4}}, 0.2)).surface;
    CHECK(m.cell_count() == 6);
    CHECK(is_surface(m));
}

TEST_CASE("polygons: copies are cut alike, whatever corner they begin with and whichever way they face")
{
    const std::vector<vec2> points = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    const auto soup =
        io::impl::parse_obj_soup(obj_text(points, {{1, 2, 3, 4}, {2, 3, 4, 1}, {4, 3, 2, 1}, {3, 2, 1, 4}}));
    REQUIRE(soup.triangles.size() == 8);
    for (const auto& t : soup.triangles)
        CHECK((std::count(t.begin(), t.end(), 1) == 1 && std::count(t.begin(), t.end(), 3) == 1));
}

TEST_CASE("polygons: OFF and PLY split the same faces")
{
    const std::string points = "0 0 0\n4 0 0\n4 4 0\n0 4 0\n1 1 0\n1 3 0\n3 3 0\n3 1 0\n";
    const std::string face = "10 0 1 2 3 0 4 5 6 7 4\n";
    const auto off = io::impl::parse_off("OFF\n8 1 0\n" + points + face).surface;
    const auto ply = io::impl::parse_ply("ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
                                         "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                                         "end_header\n" +
                                         points + face)
                         .surface;
    CHECK(off.cells() == ply.cells());
    CHECK(area_facing(off, vec3(0, 0, 1)) == doctest::Approx(12));
}
