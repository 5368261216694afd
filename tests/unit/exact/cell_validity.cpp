// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <doctest/doctest.h>
#include <taut/certify.hpp>
#include <taut/impl/core/exact/cell_validity.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

const std::vector<vec3> cube = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
const std::vector<vec3> wedge = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}};
const std::vector<vec3> pyramid = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
const std::vector<vec3> tetrahedron = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// det of the derivatives of the map at a point of the reference cell, by differences of the map itself.
double sampled(const std::vector<vec3>& x, const vec3& p)
{
    const auto linear = [](const auto& a, const auto& b, double t) { return a + t * (b - a); };
    const auto map = [&](const vec3& q)
    {
        const auto quad = [&](std::size_t n)
        { return linear(linear(x[n], x[n + 1], q.x), linear(x[n + 3], x[n + 2], q.x), q.y); };
        if (x.size() == 8) return linear(quad(0), quad(4), q.z);
        if (x.size() == 5) return linear(quad(0), x[4], q.z);
        const auto side = [&](std::size_t n) { return x[n] + q.x * (x[n + 2] - x[n]) + q.y * (x[n + 1] - x[n]); };
        return linear(side(0), side(3), q.z);
    };
    constexpr double h = 1e-5;
    mat3 J;
    for (int k = 0; k < 3; ++k)
    {
        vec3 low = p, high = p;
        low[k] -= h;
        high[k] += h;
        J[k] = (map(high) - map(low)) / (2 * h);
    }
    return glm::determinant(J);
}

double least_sample(const std::vector<vec3>& x)
{
    constexpr int n = 12;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= (x.size() == 6 ? n - i : n); ++j)
            for (int k = 0; k <= (x.size() == 5 ? 0 : n); ++k)
                least = std::min(least, sampled(x, vec3(i, j, k) / double(n)));
    return least;
}

TEST_CASE("validity of cells: regular ones are valid, mirrored and flat ones are not")
{
    for (auto x : {cube, wedge, pyramid, tetrahedron})
    {
        CHECK(validity_of_cell(x) == cell_validity::valid);
        for (vec3& p : x) p *= 1e-90; // products of three underflow
        CHECK(validity_of_cell(x) != cell_validity::invalid);
        for (vec3& p : x) p.z = -p.z;
        CHECK(validity_of_cell(x) == cell_validity::invalid);
        for (vec3& p : x) p.z = 0;
        CHECK(validity_of_cell(x) == cell_validity::invalid);
        x[1].y = std::numeric_limits<double>::quiet_NaN();
        CHECK(validity_of_cell(x) == cell_validity::invalid);
    }
}

TEST_CASE("validity of cells: a twist is found valid; positive corners can have a negative inside")
{
    auto twisted = cube;
    const auto turned = [](const vec3& p, double degrees)
    {
        const double t = degrees * 0.017453292519943295, c = std::cos(t), s = std::sin(t);
        const vec2 q(p.x - 0.5, p.y - 0.5);
        return vec3(c * q.x - s * q.y, s * q.x + c * q.y, p.z);
    };
    for (const double angle : {0.0, 60.0, 80.0})
    {
        for (std::size_t k = 0; k < 8; ++k) twisted[k] = turned(cube[k], k < 4 ? 0 : angle);
        CHECK(least_sample(twisted) > 0);
        CHECK(validity_of_cell(twisted) == cell_validity::valid);
    }
    std::mt19937 random(5);
    std::uniform_real_distribution<double> noise(-0.5, 0.5);
    int inside = 0;
    for (int trial = 0; trial < 20000 && inside < 5; ++trial)
    {
        auto x = cube;
        for (vec3& p : x) p += vec3(noise(random), noise(random), noise(random));
        if (impl::has_bad_corner(x) || validity_of_cell(x) != cell_validity::invalid) continue;
        ++inside;
        CHECK(least_sample(x) < 0.01); // samples may miss a small part
    }
    CHECK(inside == 5);
}

TEST_CASE("validity of cells: the verdict is that of samples, for cells of all kinds at random")
{
    std::mt19937 random(3);
    for (const auto& regular : {cube, wedge, pyramid})
        for (const double size : {0.2, 0.45, 0.6})
        {
            std::uniform_real_distribution<double> noise(-size, size);
            for (int trial = 0; trial < 300; ++trial)
            {
                auto x = regular;
                for (vec3& p : x) p += vec3(noise(random), noise(random), noise(random));
                const auto verdict = validity_of_cell(x);
                const double least = least_sample(x);
                if (least < -1e-6) CHECK(verdict == cell_validity::invalid);
                if (verdict == cell_validity::valid) CHECK(least > -1e-6);
                CHECK(verdict != cell_validity::undecided);
                const auto positive = [&](const auto& t) { return orient3d(x[t[0]], x[t[1]], x[t[2]], x[t[3]]) > 0; };
                const auto edges = impl::edge_tetrahedra(x.size());
                if (!impl::has_bad_corner(x) && std::all_of(edges.begin(), edges.end(), positive))
                    CHECK(verdict == cell_validity::valid);
            }
        }
}

TEST_CASE("validity of cells: what is 0 inside stays undecided, and nothing is claimed of it")
{
    // The top is turned by 180 degrees: along the wedge the determinant is (1 - 2 t)^2, with positive corners.
    const std::vector<vec3> turned = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, -1, 1}, {-1, 0, 1}};
    CHECK(validity_of_cell(turned) == cell_validity::undecided);
}

} // namespace
