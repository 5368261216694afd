// SPDX-License-Identifier: MIT
// Meshes of the plane: the same code with another element.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include <dist/pieces.hpp>
#include <taut/deform.hpp>
#include <taut/impl/dist/ranges/deal.hpp>

namespace taut::test
{

namespace
{

/// A strip of n x 4 n squares of two triangles, 1 x 4.
mesh<triangle> strip(int n)
{
    const auto g = grid(n, 4 * n);
    auto points = g.points();
    vec3 high(0.0);
    for (const vec3& p : points) high = glm::max(high, p);
    for (vec3& p : points) p = {p.x / high.x, 4 * p.y / high.y, 0};
    return {std::move(points), g.cells()};
}

vec2 turned(const vec2& p, double angle)
{
    const double c = std::cos(angle), s = std::sin(angle), x = p.x - 0.5, y = p.y - 4;
    return {0.5 + c * x - s * y, 4 + s * x + c * y};
}

} // namespace

TEST_CASE("dist plane: a strip whose end is turned, as one process has it")
{
    const auto m = strip(6);
    const double angle = std::numbers::pi / 3;
    dist::constraints<triangle> c;
    taut::constraints<triangle> one(m);
    for (idx v = 0; v < m.vertex_count(); ++v)
    {
        const vec2 p(m.points()[static_cast<std::size_t>(v)]);
        if (p.y != 0 && p.y != 4) continue;
        const vec2 q = p.y == 0 ? p : turned(p, angle);
        one.pin(v, q);
        if (rank_of() == 0) c.pin(v, q);
    }
    const dist::impl::communicator all(MPI_COMM_WORLD);
    const auto mine = dist::impl::dealt<triangle>(all, rank_of() == 0 ? &m : nullptr);
    const auto [x, report] = dist::deform<triangle>(MPI_COMM_WORLD, mine, {.constraints = c, .queue = common_queue()});
    CHECK(report.converged);
    CHECK(report.pins_held);
    CHECK(report.flips.elements == m.cell_count());
    queue& q = common_queue();
    const auto alone = deform(q, m, deform_params<triangle>{.constraints = one, .precision = precision::fp64});
    CHECK(report.energy == doctest::Approx(alone.report.energy).epsilon(1e-9));
}

TEST_CASE("dist plane: smoothing, and a certificate")
{
    auto points = strip(4).points();
    std::mt19937 random(2);
    std::uniform_real_distribution<double> move(-0.06, 0.06);
    for (vec3& p : points)
        for (int k = 0; k < 2; ++k)
            if (p[k] > 0 && p[k] < (k == 0 ? 1 : 4)) p[k] += move(random);
    const mesh<triangle> m(points, strip(4).cells());
    const dist::impl::communicator all(MPI_COMM_WORLD);
    const auto mine = dist::impl::dealt<triangle>(all, rank_of() == 0 ? &m : nullptr);
    CHECK(dist::check(MPI_COMM_WORLD, mine));
    const auto [x, report] = dist::smooth<triangle>(MPI_COMM_WORLD, mine, {.queue = common_queue()});
    CHECK(report.outcome == outcome::valid);
    CHECK(report.converged);
    for (std::size_t v = 0; v < x.size(); ++v)
        if (mine.points[v].x == 0) CHECK(x[v].x == 0);
}

} // namespace taut::test
