// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <limits>
#include <vector>

#include <picture/colormap.hpp>

using namespace taut;
using io::distortion_scale;
using io::rgb;

namespace
{

vec3 oklab(rgb c)
{
    return io::linear_to_oklab(io::to_linear(c));
}

/// How a colour looks to a dichromat, in OKLab. Source: Vienot, Brettel and Mollon, 1999, in linear sRGB.
vec3 without_red_cones(rgb c)
{
    const vec3 x = io::to_linear(c);
    const double rg = 0.11238 * x.x + 0.88762 * x.y;
    return io::linear_to_oklab({rg, rg, 0.00401 * (x.x - x.y) + x.z});
}

vec3 without_green_cones(rgb c)
{
    const vec3 x = io::to_linear(c);
    const double rg = 0.29275 * x.x + 0.70725 * x.y;
    return io::linear_to_oklab({rg, rg, -0.02234 * (x.x - x.y) + x.z});
}

} // namespace

TEST_CASE("color: OKLab and back, sRGB and back")
{
    for (const rgb c : {rgb{0, 0, 0}, rgb{255, 255, 255}, rgb{12, 200, 99}, rgb{255, 0, 255}, rgb{1, 2, 3}})
    {
        CHECK(io::to_rgb(io::to_linear(c)) == c);
        CHECK(io::to_rgb(io::oklab_to_linear(oklab(c))) == c);
    }
    CHECK(oklab({255, 255, 255}).x == doctest::Approx(1).epsilon(1e-4));
}

TEST_CASE("color: the table of the encoder agrees with the curve to one step")
{
    const io::rgb_encoder encode;
    for (int i = -10; i <= 1010; ++i)
    {
        const double x = i / 1000.0;
        const int exact = io::to_rgb({x, x, x}).g, table = encode({x, x, x}).g;
        CHECK(std::abs(exact - table) <= 1);
    }
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(encode({nan, 2, 1}) == rgb{0, 255, 255});
    CHECK(io::to_rgb({nan, 2, 1}) == rgb{0, 255, 255});
}

TEST_CASE("distortion scale: logarithmic, clamped at its ends, grey for NaN")
{
    const distortion_scale scale;
    CHECK(scale.position(1) == 0);
    CHECK(scale.position(10) == 1);
    CHECK(scale.position(std::sqrt(10.0)) == doctest::Approx(0.5));
    CHECK(scale.position(0.5) == 0);
    CHECK(scale(1e9) == scale(10));
    CHECK(scale(std::numeric_limits<double>::infinity()) == scale(10));
    CHECK(scale(std::numeric_limits<double>::quiet_NaN()) == distortion_scale::unknown);
    CHECK_THROWS_AS(distortion_scale(2, 2), parameter_error);
    CHECK_THROWS_AS(distortion_scale(0, 2), parameter_error);
    CHECK_THROWS_AS(distortion_scale(1, std::numeric_limits<double>::infinity()), parameter_error);
}

TEST_CASE("distortion scale: darkens all the way, for every kind of eye")
{
    const distortion_scale scale;
    for (const auto eye : {oklab, without_red_cones, without_green_cones})
        for (int k = 8; k < distortion_scale::colors; k += 8)
            CHECK(eye(scale.at(k / 255.0)).x < eye(scale.at((k - 8) / 255.0)).x - 0.005);
}

TEST_CASE("distortion scale: equal steps are equally different")
{
    const distortion_scale scale;
    double least = 1, most = 0;
    for (int k = 15; k <= 255; k += 15)
    {
        const double step = glm::length(oklab(scale.at(k / 255.0)) - oklab(scale.at((k - 15) / 255.0)));
        least = std::min(least, step);
        most = std::max(most, step);
    }
    CHECK(most < 1.25 * least);
}

TEST_CASE("distortion scale: magenta stands out of it, for every kind of eye")
{
    const distortion_scale scale;
    for (const auto eye : {oklab, without_red_cones, without_green_cones})
        for (int k = 0; k < distortion_scale::colors; ++k)
            CHECK(glm::length(eye(scale.at(k / 255.0)) - eye(io::magenta)) > 0.2);
}
