// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <taut/impl/core/measure/rigid_motion.hpp>
#include <taut/rigid_motion.hpp>

using namespace taut;

namespace
{

template <int D>
std::vector<vec<D>> some_points(std::size_t n, unsigned seed)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<vec<D>> points(n);
    for (auto& p : points)
        for (int k = 0; k < D; ++k) p[k] = 3 + normal(random);
    return points;
}

template <int D>
double worst(const rigid_motion<D>& m, const std::vector<vec<D>>& from, const std::vector<vec<D>>& to)
{
    double far = 0;
    for (std::size_t i = 0; i < from.size(); ++i) far = std::max(far, glm::distance(m(from[i]), to[i]));
    return far;
}

} // namespace

TEST_CASE_TEMPLATE_DEFINE("rigid motion: a turn and a shift are found again, and half of it is half way", V, of_space)
{
    constexpr int D = V::length();
    for (unsigned seed = 0; seed < 30; ++seed)
    {
        const auto points = some_points<D>(D == 2 ? 2 : 3 + seed % 5, seed);
        rigid_motion<D> wanted{.from = vec<D>(0.5), .to = vec<D>(-2.0), .angle = 0.1 * seed};
        if (D == 3) wanted.axis = glm::normalize(vec3(1, 0.1 * seed, -0.4));
        std::vector<vec<D>> images, half;
        for (const auto& p : points) images.push_back(wanted(p));
        const auto found =
            taut::impl::fit_rigid_motion(std::span<const vec<D>>(points), std::span<const vec<D>>(images));
        CHECK(worst(found, points, images) < 1e-12);
        CHECK(found.angle == doctest::Approx(wanted.angle));
        for (const auto& p : points) CHECK(glm::distance(found(p, 0), p) < 1e-14);
        for (const auto& a : points) // distances are kept on the way
            CHECK(glm::distance(found(a, 0.3), found(points[0], 0.3)) == doctest::Approx(glm::distance(a, points[0])));
    }
}
TEST_CASE_TEMPLATE_INVOKE(of_space, vec2, vec3);

TEST_CASE("rigid motion: about a point, which stays")
{
    const auto turn = rigid_motion<3>::about({1, 2, 3}, std::numbers::pi / 2, {0, 0, 7});
    CHECK(glm::length(turn({1, 2, 3}) - vec3(1, 2, 3)) < 1e-15);
    CHECK(glm::length(turn({2, 2, 4}) - vec3(1, 3, 4)) < 1e-15);
    CHECK(glm::length(rigid_motion<2>::about({1, 0}, std::numbers::pi)({3, 0}) - vec2(-1, 0)) < 1e-15);
}

TEST_CASE("rigid motion: two points and points on a line turn no more than they have to")
{
    for (unsigned seed = 1; seed < 20; ++seed)
    {
        const auto ends = some_points<3>(2, seed);
        const rigid_motion<3> turn{.to = {1, 2, 3},
                                   .axis = glm::normalize(glm::cross(ends[1] - ends[0], vec3(1, 2, seed))),
                                   .angle = 0.1 * seed};
        for (const double angle : {0.0, 0.1 * seed})
        {
            std::vector<vec3> line{ends[0], ends[1], ends[0] + 0.3 * (ends[1] - ends[0])}, images;
            for (const auto& p : line) images.push_back(turn.to + turn.turned(p - ends[0], angle));
            for (const std::size_t n : {2u, 3u})
            {
                const auto found = taut::impl::fit_rigid_motion(std::span<const vec3>(line).first(n),
                                                                std::span<const vec3>(images).first(n));
                CHECK(std::abs(found.angle - angle) < 1e-5);
                CHECK(worst(found, line, images) < 1e-6);
            }
        }
    }
}

TEST_CASE("rigid motion: half a turn, single points, points on a line and stretched ones")
{
    const auto points = some_points<3>(6, 3);
    const rigid_motion<3> half{.axis = {0, 0, 1}, .angle = std::numbers::pi};
    std::vector<vec3> images, stretched, line, line_images;
    for (const auto& p : points)
    {
        images.push_back(half(p));
        stretched.push_back(half(p) * vec3(1, 1, 1.5));
        line.push_back(p.x * vec3(1, 2, 3));
        line_images.push_back(half(line.back()));
    }
    const std::span<const vec3> from(points);
    CHECK(worst(taut::impl::fit_rigid_motion(from, images), points, images) < 1e-7); // two quaternions are as good
    CHECK(taut::impl::fit_rigid_motion(from, images).angle == doctest::Approx(std::numbers::pi));
    CHECK(std::abs(taut::impl::fit_rigid_motion(from, stretched).axis.z) > 0.95);
    CHECK(worst(taut::impl::fit_rigid_motion(std::span<const vec3>(line), line_images), line, line_images) < 1e-7);
    const std::vector<vec3> one{{1, 2, 3}}, other{{4, 5, 6}};
    const auto shift = taut::impl::fit_rigid_motion(std::span<const vec3>(one), std::span<const vec3>(other));
    CHECK(shift.angle == 0);
    CHECK(glm::distance(shift(one[0], 0.5), vec3(2.5, 3.5, 4.5)) < 1e-15);
}
