// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <support/two_atlases.hpp>
#include <taut/bake.hpp>
#include <taut/impl/charts/bake/fill_gutters.hpp>
#include <taut/impl/charts/bake/triangle_tiles.hpp>

using namespace taut;

TEST_CASE("fill_gutters: each texel gets the nearest known one, as a search over all finds it")
{
    std::minstd_rand dice(3);
    for (int round = 0; round < 30; ++round)
    {
        const idx w = 1 + static_cast<idx>(dice() % 40), h = 1 + static_cast<idx>(dice() % 30);
        texture image{w, h, 1, std::vector<float>(static_cast<std::size_t>(w * h), -1.0f)};
        std::vector<std::uint8_t> known(image.texels.size(), 0);
        for (std::size_t n = 0; n < known.size(); ++n)
            if (dice() % (round % 2 == 0 ? 7 : 60) == 0)
            {
                known[n] = 1;
                image.texels[n] = static_cast<float>(n);
            }
        const double gutter = round % 3 == 0 ? 3 : std::numeric_limits<double>::infinity();
        impl::fill_gutters(image, known, gutter);
        for (idx j = 0; j < h; ++j)
            for (idx i = 0; i < w; ++i)
            {
                const auto square = [&](idx n) { return (n % w - i) * (n % w - i) + (n / w - j) * (n / w - j); };
                idx least = std::numeric_limits<idx>::max();
                for (idx n = 0; n < w * h; ++n)
                    if (known[static_cast<std::size_t>(n)]) least = std::min(least, square(n));
                const float got = *image.at(i, j);
                if (static_cast<double>(least) <= gutter * gutter && least < std::numeric_limits<idx>::max())
                {
                    REQUIRE(got >= 0);
                    CHECK(square(static_cast<idx>(got)) == least);
                }
                else
                    CHECK(got == -1.0f);
            }
    }
}

TEST_CASE("triangles_by_tile: a triangle is where it comes near, and hardly elsewhere")
{
    const std::vector<std::array<vec2, 3>> places{{vec2(1, 1), vec2(100, 90), vec2(2, 2)},
                                                  {vec2(NAN, 1), vec2(1, 1), vec2(2, 2)},
                                                  {vec2(-90, -90), vec2(-80, -90), vec2(-90, -80)}};
    const auto tiles = impl::triangles_by_tile(places, 16, 8, 8, 1.5);
    CHECK(tiles.row(0).size() == 1);
    CHECK(tiles.row(7).empty());
    CHECK(tiles.items.size() < 20); // along the diagonal, not the box of 49
    for (const idx f : tiles.items) CHECK(f == 0);
}

TEST_CASE("triangles_by_tile: behind a triangle that contains a tile there is nothing to be seen")
{
    const std::array<vec2, 3> whole{vec2(-1000, -1000), vec2(9000, -1000), vec2(-1000, 9000)};
    std::vector<std::array<vec2, 3>> places(5000, whole);
    places.front() = {vec2(3, 3), vec2(60, 3), vec2(3, 60)};
    const auto tiles = impl::triangles_by_tile(places, 16, 64, 64, 1.5);
    CHECK(tiles.items.size() < 64 * 64 + 20); // one a tile, and the first
    CHECK(tiles.row(0).size() == 2);
    CHECK(tiles.row(0)[0] == 0);
    CHECK(tiles.row(0)[1] == 1);
    CHECK(tiles.row(64 * 64 - 1).size() == 1);
}

TEST_CASE("tangent_frames: tangents follow u, and sides tell mirrored charts")
{
    const test::two_atlases s(6, true);
    const auto normals = smooth_normals(s.points, s.triangles);
    const auto tangents = tangent_frames(s.points, s.triangles, normals, s.new_uv);
    for (std::size_t f = 0; f < tangents.size(); ++f)
    {
        const bool lower = s.place(f, vec3(1 / 3.0)).y < 0.5;
        for (std::size_t k = 0; k < 3; ++k)
        {
            const vec3 t(tangents[f][k]);
            CHECK(glm::length(t) == doctest::Approx(1));
            CHECK(std::abs(glm::dot(t, normals[f][k])) < 1e-9);
            CHECK(tangents[f][k].w == (lower ? -1 : 1));
            // u grows along y of the patch in both charts of the new atlas, as v is along it
            CHECK(t.y > 0.8);
        }
    }
    CHECK_THROWS_AS(tangent_frames(s.points, s.triangles, {}, s.new_uv), parameter_error);
    // A triangle without an area in the map has some tangent.
    const std::vector<std::array<vec2, 3>> flat(s.triangles.size(), {vec2(0.5), vec2(0.5), vec2(0.5)});
    for (const auto& t : tangent_frames(s.points, s.triangles, normals, flat))
        CHECK(glm::length(vec3(t[0])) == doctest::Approx(1));
}

TEST_CASE("compare_textures: the largest difference and the root of the mean square, where it counts")
{
    const texture a{2, 1, 2, {0, 0, 1, 1}}, b{2, 1, 2, {0.5f, 0, 1, 3}};
    const auto all = compare_textures(a, b);
    CHECK(all.largest == 2);
    CHECK(all.rms == doctest::Approx(std::sqrt((0.25 + 4) / 4)));
    const std::vector<std::uint8_t> first{1, 0};
    CHECK(compare_textures(a, b, first).largest == 0.5);
    CHECK(compare_textures(a, b, first).texels == 1);
    CHECK_THROWS_AS(compare_textures(a, {1, 1, 2, {0, 0}}), parameter_error);
}

TEST_CASE("sample: texels have their values at their centres, and textures repeat")
{
    const texture image{2, 2, 1, {0, 1, 2, 3}};
    CHECK(image.sample({0.75, 0.25})[0] == 1);
    CHECK(image.sample({0.5, 0.5})[0] == 1.5);
    CHECK(image.sample({3.75, -0.75})[0] == 1);
    CHECK(image.sample({0.0, 0.25})[0] == 0.5);
    CHECK(image.sample({0.0, 0.25}, texture::filter::bilinear, texture::wrap::clamp)[0] == 0);
    CHECK(image.sample({0.6, 0.9}, texture::filter::nearest)[0] == 3);
}

TEST_CASE("compare_textures: what is no number in one of them alone differs by infinity")
{
    const float none = std::numeric_limits<float>::quiet_NaN();
    const auto same = compare_textures({2, 1, 1, {none, 1}}, {2, 1, 1, {none, 0.5f}});
    CHECK(same.largest == 0.5);
    CHECK(same.unlike == 0);
    const auto other = compare_textures({2, 1, 1, {none, 1}}, {2, 1, 1, {0, 1}});
    CHECK(std::isinf(other.largest));
    CHECK(std::isinf(other.rms));
    CHECK(other.unlike == 1);
}
