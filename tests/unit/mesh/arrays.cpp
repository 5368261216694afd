// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include <taut/certify.hpp>
#include <taut/mesh.hpp>

using namespace taut;

namespace
{

/// As vertex buffers have it.
struct vertex
{
    float position[3];
    float normal[3];
    std::uint8_t colour[4];
};

} // namespace

TEST_CASE("arrays: an interleaved vertex buffer and unsigned indices make a mesh")
{
    const std::vector<vertex> vertices = {{{0, 0, 0}, {9, 9, 9}, {1, 2, 3, 4}},
                                          {{1, 0, 0.5F}, {9, 9, 9}, {1, 2, 3, 4}},
                                          {{0, 1, 0.25F}, {9, 9, 9}, {1, 2, 3, 4}}};
    const std::vector<std::uint32_t> indices = {0, 1, 2};
    const mesh<triangle> m(array_view<const float, 3>(vertices[0].position, vertices.size(), sizeof(vertex)),
                           array_view<const std::uint32_t, 3>(std::span(indices)));
    CHECK(m.points() == std::vector<vec3>{{0, 0, 0}, {1, 0, 0.5}, {0, 1, 0.25}});
    CHECK(m.cells() == std::vector<std::array<idx, 3>>{{0, 1, 2}});
}

TEST_CASE_TEMPLATE("arrays: every width of index counts, and what is out of range is named", I, std::int32_t,
                   std::uint32_t, std::int64_t, std::uint64_t)
{
    const std::vector<double> points = {0, 0, 1, 0, 0, 1, 1, 1}; // in the plane
    std::vector<I> cells = {0, 1, 2, 1, 3, 2};
    const auto make = [&]
    {
        return mesh<triangle>(array_view<const double, 2>(std::span<const double>(points)),
                              array_view<const I, 3>(std::span<const I>(cells)));
    };
    CHECK(make().points()[3] == vec3(1, 1, 0));
    CHECK(make().cell_count() == 2);
    for (const I bad : {I(4), std::numeric_limits<I>::max(), I(-1)})
    {
        cells[4] = bad;
        try
        {
            make();
            FAIL("it was taken");
        }
        catch (const mesh_error& e)
        {
            CHECK(e.fault() == mesh_error::index_out_of_range);
            CHECK(e.ids().front() == 1);
        }
    }
}

TEST_CASE("arrays: tetrahedra, and every second row")
{
    const std::vector<float> points = {0, 0, 0, 7, 7, 7, 1, 0, 0, 7, 7, 7, 0, 1, 0, 7, 7, 7, 0, 0, 1, 7, 7, 7};
    const std::vector<std::int64_t> cells = {0, 1, 2, 3};
    const mesh<tetrahedron> m(array_view<const float, 3>(points.data(), 4, 6 * sizeof(float)),
                              array_view<const std::int64_t, 4>(std::span(cells)));
    CHECK(m.points()[2] == vec3(0, 1, 0));
    CHECK(m.points()[3] == vec3(0, 0, 1));
}

TEST_CASE("arrays: numbers that are no rows, and rows of another count, are refused")
{
    const std::vector<double> seven(7);
    CHECK_THROWS_AS((array_view<const double, 3>(std::span<const double>(seven))), parameter_error);
    const std::vector<vec2> x(3);
    std::vector<float> out(4);
    CHECK_THROWS_AS((array_view<float, 2>(std::span<float>(out)).store(x)), parameter_error);
}

TEST_CASE("arrays: a map is stored among other numbers, unaligned, and read back")
{
    const std::vector<vec2> x = {{0.5, 0.25}, {-1, 2}, {3, 0.125}};
    std::vector<std::byte> bytes(3 * 17 + 1, std::byte{0x55});
    const array_view<float, 2> rows(reinterpret_cast<float*>(bytes.data() + 1), 3, 17);
    rows.store(x);
    CHECK(rows.points() == x);
    CHECK(bytes[0] == std::byte{0x55});
    CHECK(bytes[1 + 8] == std::byte{0x55}); // between the rows
    CHECK(impl::numbers_of<2>(std::span<const vec2>(x))[3] == 2);
    CHECK(impl::numbers_of<2>(std::span<const vec2>()).empty());
}

TEST_CASE("arrays: a map that folds where it is rounded to float is found out")
{
    const std::vector<std::array<idx, 3>> cells{{0, 1, 2}};
    const std::vector<vec2> x = {{1, 0}, {1 + 1e-12, 0}, {1, 1}};
    CHECK(certify<2>(cells, std::span<const vec2>(x)));
    std::vector<float> out(6);
    const array_view<float, 2> rows{std::span<float>(out)};
    rows.store(x);
    const auto rounded = rows.points();
    CHECK(certify<2>(cells, std::span<const vec2>(rounded)).flipped == 1);
}
