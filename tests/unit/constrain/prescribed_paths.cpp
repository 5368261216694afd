// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/impl/core/constrain/prescribed_paths.hpp>

using namespace taut;
using namespace taut::impl;

TEST_CASE("held paths: two ends of a bar that turn against each other keep their shape all the way")
{
    const auto m = test::cube(3);
    auto from = m.points(), to = from;
    fixed_marks<3> marks(from.size());
    const rigid_motion<3> half{
        .from = vec3(0.5), .to = vec3(0.5), .axis = {0, 0, 1}, .angle = 0.999 * std::numbers::pi};
    for (std::size_t v = 0; v < from.size(); ++v)
    {
        if (from[v].z == 0) marks[v] = marks.every;
        if (from[v].z == 1) marks[v] = marks.every, to[v] = half(from[v]);
    }
    const prescribed_paths<3> paths(m.cells(), marks, from, to);
    CHECK(paths.parts() == 6);
    CHECK(paths.parts(7.0) == 1);
    for (const double t : {0.25, 0.5, 0.75, 1.0})
    {
        auto x = from;
        for (std::size_t v = 0; v < x.size(); ++v)
            if (marks.any(v)) x[v] = paths.place(v, t);
        for (std::size_t v = 0; v < x.size(); ++v)
        {
            if (from[v].z != 1) CHECK(x[v] == from[v]); // free, or at its place
            if (from[v].z == 1)
                CHECK(glm::distance(x[v], vec3(0.5, 0.5, 1)) ==
                      doctest::Approx(glm::distance(from[v], vec3(0.5, 0.5, 1))));
        }
        if (t == 1)
            for (std::size_t v = 0; v < x.size(); ++v)
                if (marks.all(v)) CHECK(std::memcmp(&x[v], &to[v], sizeof(vec3)) == 0);
    }
}

TEST_CASE("held paths: what changes its shape does so little by little, single coordinates go straight")
{
    const auto m = test::grid(3, 3);
    std::vector<vec2> from, to;
    fixed_marks<2> marks(m.points().size());
    for (const vec3& p : m.points())
    {
        from.emplace_back(p);
        to.emplace_back(2 * p.x, p.y);
    }
    for (std::size_t v = 0; v < from.size(); ++v)
        marks[v] = from[v].y == 0 ? marks.every : from[v].y == 1 ? std::uint8_t{1} : std::uint8_t{0};
    const prescribed_paths<2> paths(m.cells(), marks, from, to);
    CHECK(paths.parts() == 1);
    auto x = from;
    for (std::size_t v = 0; v < x.size(); ++v)
        for (int k = 0; k < 2; ++k)
            if (marks.test(v, k)) x[v][k] = paths.place(v, 0.5)[k];
    for (std::size_t v = 0; v < x.size(); ++v)
    {
        CHECK(x[v].y == from[v].y);
        const bool moves = marks.any(v);
        CHECK(x[v].x == doctest::Approx(moves ? 1.5 * from[v].x : from[v].x));
    }
}
