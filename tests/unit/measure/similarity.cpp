// SPDX-License-Identifier: MIT
#include <cmath>
#include <complex>
#include <vector>

#include <doctest/doctest.h>

#include <taut/impl/core/measure/similarity.hpp>

using namespace taut;
using namespace taut::impl;

TEST_CASE("similarity: one that moved the anchors is found again")
{
    const similarity moved{{1.0, -2.0}, {300.0, 40.0}, std::polar(3.5, 2.1)};
    std::vector<anchor> anchors;
    for (const vec2 p : {vec2(0, 0), vec2(1, 0.5), vec2(-4, 2), vec2(3, 3)}) anchors.push_back({p, moved(p), 1 + p.y});
    const auto [map, explained] = fit_similarity(anchors);
    CHECK(explained == doctest::Approx(1.0));
    for (const anchor& a : anchors) CHECK(glm::distance(map(a.from), a.to) < 1e-12);
}

TEST_CASE("similarity: a mirror image is not explained, and a heavy anchor pulls")
{
    const std::vector<anchor> mirrored{{{1, 0}, {-1, 0}}, {{0, 1}, {0, 1}}, {{-1, 0}, {1, 0}}, {{0, -1}, {0, -1}}};
    CHECK(fit_similarity(mirrored).explained < 1e-12);
    std::vector<anchor> apart{{{0, 0}, {0, 0}}, {{1, 0}, {1, 0}}, {{0, 1}, {5, 5}}};
    const double even = glm::distance(fit_similarity(apart).map({0, 1}), {5, 5});
    apart[2].weight = 100;
    CHECK(glm::distance(fit_similarity(apart).map({0, 1}), {5, 5}) < 0.2 * even);
}

TEST_CASE("similarity: one anchor fixes no turn")
{
    const std::vector<anchor> one{{{2, 3}, {5, 7}}};
    const auto [map, explained] = fit_similarity(one);
    CHECK(std::abs(map.turn) == 0.0);
    CHECK(map({2, 3}) == vec2(5, 7));
    CHECK(explained == 0.0);
}
