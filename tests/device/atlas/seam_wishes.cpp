// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include <support/closed_meshes.hpp>
#include <support/shared_context.hpp>
#include <taut/atlas.hpp>
#include <taut/impl/charts/atlas/seams/openness.hpp>

using namespace taut;

namespace
{

/// A ball with four deep grooves from pole to pole.
mesh<triangle> grooved_ball(int n)
{
    return test::moved(test::ball(n),
                       [](const vec3& x)
                       {
                           const double a = std::atan2(x.y, x.x), flat = x.x * x.x + x.y * x.y;
                           return x * (1 - 0.5 * flat * std::exp(-30 * std::pow(std::sin(2 * a), 2)));
                       });
}

/// Calls f(ends, length) for each edge inside the surface that an atlas cuts.
template <class F>
void for_seams(const mesh<triangle>& m, const atlas& made, F f)
{
    const auto cut = taut::impl::facets(made.charts.surface), whole = taut::impl::facets(m);
    for (idx s = 0; s < 3 * made.charts.surface.cell_count(); ++s)
    {
        if (cut.twin[std::size_t(s)] >= 0) continue;
        const idx own = 3 * made.charts.cell_origins[std::size_t(s / 3)] + s % 3;
        if (whole.twin[std::size_t(own)] < own) continue;
        const auto [a, b] = impl::side_vertices(m, own);
        f(own, a, b, glm::distance(m.points()[std::size_t(a)], m.points()[std::size_t(b)]));
    }
}

double length_of(const mesh<triangle>& m, const atlas& made)
{
    double sum = 0;
    for_seams(m, made, [&](idx, idx, idx, double length) { sum += length; });
    return sum;
}

} // namespace

TEST_CASE("seam wishes: hidden seams are seen less, within the bound, and the report says how much")
{
    queue q(test::shared_context());
    for (const auto prefer : {chart_preference::seams, chart_preference::packing})
    {
        const auto m = grooved_ball(14);
        const auto open = impl::vertex_openness(m);
        const auto seen = [&](const atlas& made)
        {
            double sum = 0;
            for_seams(m, made,
                      [&](idx, idx a, idx b, double length)
                      { sum += length * 0.5 * (open[std::size_t(a)] + open[std::size_t(b)]); });
            return sum / length_of(m, made);
        };
        const auto plain = make_atlas(q, m, {.prefer = prefer});
        const auto mild = make_atlas(q, m, {.prefer = prefer, .hide_seams = 0.5});
        const auto strong = make_atlas(q, m, {.prefer = prefer, .hide_seams = 1});
        REQUIRE(plain);
        REQUIRE(mild);
        REQUIRE(strong);
        CHECK(!plain.report.seen_seam);
        REQUIRE(mild.report.seen_seam);
        CHECK(*mild.report.seen_seam == doctest::Approx(seen(mild)));
        CAPTURE(seen(plain));
        CAPTURE(seen(mild));
        CHECK(seen(strong) < (prefer == chart_preference::seams ? 0.85 : 0.95) * seen(plain));
        CHECK(seen(strong) < 1.02 * seen(mild));
        if (prefer == chart_preference::seams) CHECK(strong.report.distortion <= 4.1);
    }
}

TEST_CASE("seam wishes: what is painted dear has fewer seams")
{
    queue q(test::shared_context());
    const auto m = grooved_ball(14);
    std::vector<double> weights;
    for (idx s = 0; s < 3 * m.cell_count(); ++s)
    {
        const auto [a, b] = impl::side_vertices(m, s);
        weights.push_back(m.points()[std::size_t(a)].z + m.points()[std::size_t(b)].z > 0 ? 30 : 1);
    }
    const auto above = [&](const atlas& made)
    {
        double sum = 0;
        for_seams(m, made,
                  [&](idx, idx a, idx, double length) { sum += m.points()[std::size_t(a)].z > 0 ? length : 0; });
        return sum;
    };
    const auto plain = make_atlas(q, m), painted = make_atlas(q, m, {.charts = {.weights = weights}});
    REQUIRE(painted);
    CHECK(above(painted) < 0.8 * above(plain));
    const auto again = make_atlas(q, m, {.charts = {.weights = weights}});
    CHECK(again.uv == painted.uv);
    weights.pop_back();
    CHECK_THROWS_AS(make_atlas(q, m, {.charts = {.weights = weights}}), parameter_error);
    CHECK_THROWS_AS(make_atlas(q, m, {.hide_seams = 2}), parameter_error);
    CHECK_THROWS_AS(make_atlas(q, m, {.crease_angle = -1}), parameter_error);
}

TEST_CASE("seam wishes: seams are along edges that are bent")
{
    queue q(test::shared_context());
    // A box whose faces are bent a little, so that they are to be cut somewhere.
    const auto m = test::moved(test::box(12), [](const vec3& x) { return x + 0.02 * vec3(std::sin(5 * x.y), 0, 0); });
    const auto on_edges = [&](const atlas& made)
    {
        const auto f = taut::impl::facets(m);
        double bent = 0;
        for_seams(m, made,
                  [&](idx s, idx, idx, double length)
                  {
                      const auto x = m.rest(s / 3), y = m.rest(f.twin[std::size_t(s)] / 3);
                      const vec3 n = glm::normalize(glm::cross(x[1] - x[0], x[2] - x[0])),
                                 o = glm::normalize(glm::cross(y[1] - y[0], y[2] - y[0]));
                      bent += glm::dot(n, o) < std::cos(0.7) ? length : 0;
                  });
        return bent / length_of(m, made);
    };
    const auto creased = make_atlas(q, m, {.crease_angle = 40});
    REQUIRE(creased);
    CHECK(on_edges(creased) > 0.95);
}
