// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <support/shared_context.hpp>
#include <support/two_atlases.hpp>
#include <taut/bake.hpp>
#include <taut/impl/charts/bake/bake.hpp>

using namespace taut;
using test::two_atlases;

namespace
{

/// A smooth colour on the surface, steepest by `smooth_slope` per unit of the square.
std::array<double, 4> smooth(const vec2& x)
{
    return {0.5 + 0.4 * std::sin(9 * x.x + 1), 0.5 + 0.4 * std::cos(8 * x.y), 0.5 + 0.3 * std::sin(5 * (x.x + x.y)), 1};
}
constexpr double smooth_slope = 3.7;

bool is_white(const vec2& x)
{
    return (static_cast<int>(std::floor(8 * x.x + 0.3)) + static_cast<int>(std::floor(8 * x.y + 0.2))) % 2 == 0;
}

std::array<double, 4> checker(const vec2& x)
{
    return {is_white(x) ? 1.0 : 0.0, 0, 0, 0};
}

/// Distance from the edges of the checker's squares in units of the surface.
double from_edges(const vec2& x)
{
    const auto from_whole = [](double a) { return std::abs(a - std::round(a)); };
    return std::min(from_whole(8 * x.x + 0.3), from_whole(8 * x.y + 0.2)) / 8;
}

double cross2(const vec2& a, const vec2& b)
{
    return a.x * b.y - a.y * b.x;
}

/// Value of the first triangle that is nearest to a texel's centre, in double; and how far it is.
std::pair<std::array<double, 4>, double> on_host(const two_atlases& s, const texture& old, const texture& next, idx i,
                                                 idx j, const bake_params& how = {})
{
    const vec2 size(next.width, next.height), p(i + 0.5, j + 0.5);
    double best = std::numeric_limits<double>::infinity();
    vec2 uv(0.0);
    for (std::size_t f = 0; f < s.triangles.size(); ++f)
    {
        std::array<vec2, 3> a;
        for (std::size_t k = 0; k < 3; ++k) a[k] = s.new_uv[f][k] * size - p;
        const vec3 areas(cross2(a[1], a[2]), cross2(a[2], a[0]), cross2(a[0], a[1]));
        const double det = areas.x + areas.y + areas.z;
        const auto take = [&](double d, const vec3& w)
        {
            if (d >= best) return;
            best = d;
            uv = two_atlases::at(s.old_uv[f], w);
        };
        if (areas.x * det >= 0 && areas.y * det >= 0 && areas.z * det >= 0)
            take(0, areas / det);
        else
            for (std::size_t k = 0; k < 3; ++k)
            {
                const vec2 d = a[(k + 1) % 3] - a[k];
                const double t = std::clamp(-glm::dot(a[k], d) / glm::dot(d, d), 0.0, 1.0);
                vec3 w(0.0);
                w[static_cast<int>(k)] = 1 - t;
                w[static_cast<int>((k + 1) % 3)] = t;
                take(glm::length(a[k] + t * d), w);
            }
    }
    return {old.sample(uv, how.filter, how.wrap, how.wrap_v), best};
}

} // namespace

TEST_CASE("bake: texels are those of the host, in triangles and around them")
{
    queue q(test::shared_context());
    const two_atlases s(6, true);
    const auto old = s.old_texture(48, 40, 4, [](const vec2& x, int) { return smooth(x); });
    const auto b = bake(q, old, s.old_uv, s.new_uv, {.width = 60, .height = 44, .gutter = 0});
    REQUIRE(b.image.texels.size() == 60u * 44 * 4);
    int inside = 0, near = 0;
    for (idx j = 0; j < b.image.height; ++j)
        for (idx i = 0; i < b.image.width; ++i)
        {
            const auto [value, distance] = on_host(s, old, b.image, i, j);
            const int mark = b.covered[static_cast<std::size_t>(j * b.image.width + i)];
            if (std::abs(distance - 1.5) < 1e-4) continue;
            CHECK(mark == (distance < 1e-5 && mark == 1 ? 1 : distance < 1.5 ? 2 : 0));
            inside += mark == 1;
            near += mark == 2;
            for (idx c = 0; c < 4; ++c)
                CHECK(b.image.at(i, j)[c] ==
                      doctest::Approx(distance < 1.5 ? value[static_cast<std::size_t>(c)] : 0).epsilon(1e-4));
        }
    CHECK(inside > 60 * 44 / 2);
    CHECK(near > 100);
}

TEST_CASE("bake: textures go on along each side as they wrap")
{
    queue q(test::shared_context());
    two_atlases s(6, true);
    const auto old = s.old_texture(48, 40, 2, [](const vec2& x, int) { return smooth(x); });
    for (auto& t : s.old_uv)
        for (vec2& x : t) x = 3.7 * x - vec2(1.3, 1.6);
    using enum texture::wrap;
    for (const auto& [u, v] : std::vector<std::pair<texture::wrap, texture::wrap>>{
             {repeat, clamp}, {clamp, mirror}, {mirror, repeat}, {mirror, mirror}})
    {
        const bake_params how{.width = 60, .height = 44, .wrap = u, .wrap_v = v, .gutter = 0};
        const auto b = bake(q, old, s.old_uv, s.new_uv, how);
        int inside = 0;
        for (idx j = 0; j < b.image.height; ++j)
            for (idx i = 0; i < b.image.width; ++i)
            {
                if (b.covered[static_cast<std::size_t>(j * b.image.width + i)] != 1) continue;
                ++inside;
                const auto value = on_host(s, old, b.image, i, j, how).first;
                for (idx c = 0; c < 2; ++c)
                    CHECK(b.image.at(i, j)[c] == doctest::Approx(value[static_cast<std::size_t>(c)]).epsilon(1e-3));
            }
        CHECK(inside > 60 * 44 / 2);
    }
}

TEST_CASE("bake: numbers that stand for values are those values")
{
    queue q(test::shared_context());
    const two_atlases s(6, true);
    const idx width = 30, height = 20;
    const auto number = [](idx i, idx j, idx c) { return static_cast<std::size_t>((7 * i + 3 * j + 5 * c) % 11); };
    for (const idx channels : {1, 3, 4})
        for (const int bytes : {1, 2})
            for (const bool palette : {false, true})
            {
                impl::texture_rows rows{
                    .width = width, .height = height, .channels = channels, .bytes = bytes, .palette = palette};
                for (int n = 0; n < 11 * channels; ++n) rows.table.push_back(static_cast<float>(n * n % 17) / 17);
                rows.read = [&](idx j, std::byte* to)
                {
                    for (idx k = 0; k < width * (palette ? 1 : channels); ++k)
                    {
                        const auto n = static_cast<unsigned short>(palette ? number(k, j, 0)
                                                                           : number(k / channels, j, k % channels));
                        if (bytes == 1)
                            to[k] = static_cast<std::byte>(n);
                        else
                            std::memcpy(to + 2 * k, &n, 2);
                    }
                };
                texture plain{width, height, channels, {}};
                for (idx j = 0; j < height; ++j)
                    for (idx i = 0; i < width; ++i)
                        for (idx c = 0; c < channels; ++c)
                            plain.texels.push_back(
                                rows.table[number(i, j, palette ? 0 : c) * static_cast<std::size_t>(channels) +
                                           static_cast<std::size_t>(c)]);
                std::vector<float> row(static_cast<std::size_t>(width * channels));
                rows.values(3, row.data());
                CHECK(std::equal(row.begin(), row.end(), plain.at(0, 3)));
                const bake_params how{.width = 40, .height = 40};
                const auto made = impl::bake_any(q, {.old = &rows, .from = s.old_uv}, s.new_uv, how);
                CHECK(made.image.texels == bake(q, plain, s.old_uv, s.new_uv, how).image.texels);
            }
}

TEST_CASE("bake: a smooth texture through both atlases differs by less than its sampling")
{
    queue q(test::shared_context());
    const two_atlases s;
    const auto old = s.old_texture(256, 256, 3, [](const vec2& x, int) { return smooth(x); });
    for (const idx size : {idx(128), idx(256), idx(500)})
    {
        const auto b = bake(q, old, s.old_uv, s.new_uv, {.width = size, .height = size});
        double worst = 0, in_charts = 0;
        s.for_places(20000,
                     [&](std::size_t t, const vec3& w)
                     {
                         const vec2 uv = two_atlases::at(s.new_uv[t], w);
                         const auto before = old.sample(two_atlases::at(s.old_uv[t], w)), after = b.image.sample(uv);
                         // Texels of the new atlas are at most 1 / 0.76 of a texel of the square.
                         const vec2 x = s.place(t, w);
                         const double rim = std::min({x.x, 1 - x.x, x.y, 1 - x.y, std::abs(x.y - 0.5)}) * 0.76 * size;
                         for (std::size_t c = 0; c < 3; ++c)
                         {
                             const double d = std::abs(before[c] - after[c]);
                             worst = std::max(worst, d);
                             if (rim > 2) in_charts = std::max(in_charts, d);
                         }
                     });
        const double texel = smooth_slope / (0.76 * size);
        CAPTURE(size);
        CHECK(worst < texel);
        CHECK(in_charts < 0.25 * texel); // the difference of two linear interpolations
    }
}

TEST_CASE("bake: a checker through both atlases differs near its edges alone")
{
    queue q(test::shared_context());
    const two_atlases s;
    const auto old = s.old_texture(300, 300, 1, [](const vec2& x, int) { return checker(x); });
    const auto b = bake(q, old, s.old_uv, s.new_uv);
    const double texel = 1 / (0.42 * 300); // the largest of both, on the surface
    int compared = 0, differ = 0;
    s.for_places(20000,
                 [&](std::size_t t, const vec3& w)
                 {
                     if (from_edges(s.place(t, w)) < 2 * texel) return; // half a diagonal each, and the rim
                     const double before = old.sample(two_atlases::at(s.old_uv[t], w))[0],
                                  after = b.image.sample(two_atlases::at(s.new_uv[t], w))[0];
                     ++compared;
                     differ += std::abs(before - after) > 1e-4;
                 });
    CHECK(compared > 10000);
    CHECK(differ == 0);
}

TEST_CASE("bake: labels stay labels, and samples are means")
{
    queue q(test::shared_context());
    const two_atlases s;
    const auto labels =
        s.old_texture(90, 70, 1, [](const vec2& x, int) { return std::array{7.0 + std::floor(4 * x.x) * 3}; });
    const auto b = bake(q, labels, s.old_uv, s.new_uv, {.width = 120, .filter = texture::filter::nearest});
    const std::set<float> known(labels.texels.begin(), labels.texels.end());
    CHECK(b.image.height == 70);
    for (const float x : b.image.texels) CHECK(known.count(x) == 1);

    // A checker of single texels is grey from afar.
    texture fine{256, 256, 1, {}};
    for (int n = 0; n < 256 * 256; ++n) fine.texels.push_back(static_cast<float>((n + n / 256) % 2));
    const auto grey = bake(q, fine, s.old_uv, s.new_uv, {.width = 32, .height = 32, .samples = 8, .gutter = 0});
    for (std::size_t n = 0; n < grey.covered.size(); ++n)
        if (grey.covered[n] == 1) CHECK(std::abs(grey.image.texels[n] - 0.5f) < 0.2f);
    CHECK_THROWS_AS(bake(q, labels, s.old_uv, s.new_uv, {.filter = texture::filter::nearest, .samples = 2}),
                    parameter_error);
}

TEST_CASE("bake: a program of three lines")
{
    queue q(test::shared_context());
    const two_atlases s;
    const auto &old_uv = s.old_uv, &new_uv = s.new_uv;
    // [bake]
    const texture old{2, 2, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}}; // row by row from below
    const baked_texture made = bake(q, old, old_uv, new_uv, {.width = 256, .height = 128});
    const double seen = made.image.sample(new_uv[0][0])[0]; // red at a corner
    // [bake]
    CHECK(std::abs(seen - old.sample(old_uv[0][0])[0]) < 0.05);
}

TEST_CASE("bake: gutters have the nearest texel, as wide as asked")
{
    queue q(test::shared_context());
    const two_atlases s;
    const auto old = s.old_texture(64, 64, 1, [](const vec2&, int) { return std::array{0.25}; });
    const auto all = bake(q, old, s.old_uv, s.new_uv);
    CHECK(std::all_of(all.image.texels.begin(), all.image.texels.end(),
                      [](float x) { return std::abs(x - 0.25f) < 1e-6f; }));
    CHECK(std::count(all.covered.begin(), all.covered.end(), 0) > 0);
    const auto some = bake(q, old, s.old_uv, s.new_uv, {.gutter = 1});
    CHECK(std::count(some.image.texels.begin(), some.image.texels.end(), 0.0f) > 0);
}

TEST_CASE("bake: textures repeat or end, and the new one may be any unit square")
{
    queue q(test::shared_context());
    two_atlases s;
    const auto old = s.old_texture(64, 64, 2, [](const vec2& x, int) { return smooth(x); });
    const auto b = bake(q, old, s.old_uv, s.new_uv);
    auto moved = s;
    for (auto& t : moved.old_uv)
        for (vec2& x : t) x += vec2(41, -7);
    for (auto& t : moved.new_uv)
        for (vec2& x : t) x += vec2(1, 1);
    const auto other = bake(q, old, moved.old_uv, moved.new_uv, {.origin = vec2(1, 1)});
    CHECK(compare_textures(b.image, other.image).largest < 1e-4);
    const auto none = bake(q, old, moved.old_uv, moved.new_uv);
    CHECK(std::all_of(none.covered.begin(), none.covered.end(), [](auto x) { return x == 0; }));
    const auto ended = bake(q, old, moved.old_uv, s.new_uv, {.wrap = texture::wrap::clamp});
    for (std::size_t n = 0; n < ended.covered.size(); ++n)
        if (ended.covered[n] == 1) CHECK(std::abs(ended.image.texels[2 * n] - old.at(63, 0)[0]) < 1e-6f);
}

TEST_CASE("bake: colours of vertices are linear in triangles")
{
    queue q(test::shared_context());
    const two_atlases s;
    std::vector<float> colours;
    for (const auto& t : s.triangles)
        for (const idx v : t)
            for (const double x : {s.flat[std::size_t(v)].x, s.flat[std::size_t(v)].y, 1.0})
                colours.push_back(static_cast<float>(x));
    const auto b = bake(q, colours, 3, s.new_uv, {.width = 200, .height = 150});
    s.for_places(3000,
                 [&](std::size_t t, const vec3& w)
                 {
                     const vec2 x = s.place(t, w);
                     const auto value = b.image.sample(two_atlases::at(s.new_uv[t], w));
                     CHECK(std::abs(value[0] - x.x) < 1.5 / (0.76 * 150));
                     CHECK(std::abs(value[1] - x.y) < 1.5 / (0.76 * 150));
                     CHECK(value[2] == doctest::Approx(1));
                 });
    CHECK_THROWS_AS(bake(q, colours, 2, s.new_uv), parameter_error);
}

TEST_CASE("bake: normals point as before, in turned and mirrored charts")
{
    queue q(test::shared_context());
    const two_atlases s(12, true);
    const auto normals = smooth_normals(s.points, s.triangles);
    const auto from = tangent_frames(s.points, s.triangles, normals, s.old_uv),
               to = tangent_frames(s.points, s.triangles, normals, s.new_uv);
    // What a texture says at a place: the normal in space.
    const auto shown = [&](const texture& image, const std::vector<taut::corner_tangents>& tangents, std::size_t t,
                           const vec3& w, const vec2& uv, double green)
    {
        const auto stored = image.sample(uv);
        const vec3 n = two_atlases::at(normals[t], w);
        const vec3 x(two_atlases::at(tangents[t], w)), y = tangents[t][0].w * glm::cross(n, x);
        return glm::normalize((2 * stored[0] - 1) * x + green * (2 * stored[1] - 1) * y + (2 * stored[2] - 1) * n);
    };
    for (const bool down : {false, true})
    {
        const auto old = s.old_texture(256, 256, 3,
                                       [](const vec2& x, int chart)
                                       {
                                           // Turned by the chart, so that it is smooth on the surface.
                                           const vec2 tilt = 0.3 * vec2(std::sin(5 * x.y), std::cos(4 * x.x));
                                           const vec2 turned = chart == 0 ? tilt : vec2(tilt.y, -tilt.x);
                                           const double z = std::sqrt(1 - glm::dot(tilt, tilt));
                                           return std::array{0.5 + 0.5 * turned.x, 0.5 + 0.5 * turned.y, 0.5 + 0.5 * z};
                                       });
        const auto b = bake(q, old, {normals, from, to}, s.old_uv, s.new_uv, {.green_down = down});
        double worst = 0, mean = 0;
        const double green = down ? -1 : 1;
        s.for_places(5000,
                     [&](std::size_t t, const vec3& w)
                     {
                         if (std::abs(s.place(t, w).x - 0.5) < 0.02) return; // the old seam, where it is not smooth
                         const vec3 a = shown(old, from, t, w, two_atlases::at(s.old_uv[t], w), green),
                                    c = shown(b.image, to, t, w, two_atlases::at(s.new_uv[t], w), green);
                         worst = std::max(worst, glm::length(a - c));
                         mean += glm::length(a - c) / 5000;
                     });
        CHECK(worst < 0.05);
        CHECK(mean < 0.005);
    }
    const texture grey{4, 4, 1, std::vector<float>(16, 0.5f)};
    CHECK_THROWS_AS(bake(q, grey, {normals, from, to}, s.old_uv, s.new_uv), parameter_error);
}

TEST_CASE("bake: what does not fit together is refused; triangles without a place are left out")
{
    queue q(test::shared_context());
    two_atlases s;
    const texture old{8, 8, 1, std::vector<float>(64, 1.0f)};
    CHECK_THROWS_AS(bake(q, {8, 8, 1, {}}, s.old_uv, s.new_uv), parameter_error);
    CHECK_THROWS_AS(bake(q, {0, 8, 1, {}}, s.old_uv, s.new_uv), parameter_error);
    CHECK_THROWS_AS(bake(q, old, std::span(s.old_uv).first(3), s.new_uv), parameter_error);
    CHECK_THROWS_AS(bake(q, old, s.old_uv, s.new_uv, {.samples = 9}), parameter_error);
    CHECK_THROWS_AS(bake(q, old, s.old_uv, s.new_uv, {.gutter = -1}), parameter_error);
    const vec2 none(std::numeric_limits<double>::quiet_NaN());
    for (auto& t : s.new_uv) t = {none, none, none};
    s.old_uv[0][1] = none;
    const auto b = bake(q, old, s.old_uv, s.new_uv);
    CHECK(std::all_of(b.image.texels.begin(), b.image.texels.end(), [](float x) { return x == 0; }));
    CHECK(bake(q, old, {}, {}).image.texels.size() == 64);
}
