// SPDX-License-Identifier: MIT
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>

#include <taut/energies.hpp>
#include <taut/impl/core/objective/mesh_levels.hpp>
#include <taut/impl/core/objective/newton_objective.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>
#include <taut/solve.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

/// A bumpy disk, its levels, a start map, and constraints on a few of its vertices.
struct setting
{
    mesh<triangle> surface = test::bumpy(test::sized(16, 4), 0.25, 2);
    mesh_levels<triangle> levels{surface};
    mesh<triangle> finest = levels.level(0);
    std::vector<vec2> start = barycentric_map(finest, facets(finest), {.stretch_rounds = 3}).uv;
    point_constraints<2> wanted;
    queue q{test::shared_context()};

    setting()
    {
        const auto n = start.size();
        wanted.held = fixed_marks<2>(n);
        wanted.held[n / 2] = 1;
        wanted.held[n / 3] = 2;
        wanted.springs = {{static_cast<taut::idx>(n / 4), vec2(0.4, -0.1), vec2(3.0)},
                          {static_cast<taut::idx>(n / 4 + 1), vec2(-0.2, 0.3), vec2(0.5, 0.7)},
                          {static_cast<taut::idx>(n - 1), vec2(1.0, 1.5), vec2(40.0)}};
    }

    newton_objective<triangle> objective(const point_constraints<2>& constraints)
    {
        return {q,
                {levels, 0, lane_form::for_device(q.device())},
                energy::isometric{},
                energy::weighting::measure,
                std::make_shared<const newton_kernels<triangle>>(q, energy::isometric{}, real_types{}),
                constraints};
    }

    double spring_energy(const std::vector<vec2>& x) const
    {
        double sum = 0;
        for (const auto& s : wanted.springs)
        {
            const vec2 gap = x[static_cast<std::size_t>(s.vertex)] - s.target;
            sum += glm::dot(s.stiffness, gap * gap);
        }
        return sum;
    }
};

TEST_CASE("point constraints: the value is that of the energy plus that of the springs, along a line, too")
{
    setting s;
    auto plain = s.objective({}), sprung = s.objective(s.wanted);
    auto x = plain.make_point(), y = plain.make_point();
    plain.upload(s.start, x);
    CHECK(sprung.value(x) == doctest::Approx(plain.value(x) + s.spring_energy(s.start)).epsilon(1e-13));

    auto d = plain.space().make();
    plain.gradient(x, d);
    const double limit = plain.max_step(x, d);
    const double a[5] = {0, 0.1 * limit, 0.2 * limit, 0.3 * limit, -0.1 * limit};
    double e[5];
    sprung.values(x, d, a, e);
    for (int k = 0; k < 5; ++k)
    {
        plain.step(x, a[k], d, y);
        CHECK(e[k] == doctest::Approx(plain.value(y) + s.spring_energy(plain.download(y))).epsilon(1e-12));
    }
}

TEST_CASE("point constraints: the gradient is the derivative of the value, and 0 where a coordinate is held")
{
    setting s;
    auto f = s.objective(s.wanted);
    auto x = f.make_point(), y = f.make_point();
    f.upload(s.start, x);
    auto g = f.space().make(), d = f.space().make();
    f.value_gradient(x, g);

    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    std::vector<double> direction(d.size());
    for (double& v : direction) v = normal(random);
    d.upload(direction);
    const double h = 1e-6 * f.max_step(x, d);
    f.step(x, h, d, y);
    const double ahead = f.value(y);
    f.step(x, -h, d, y);
    const double behind = f.value(y);
    // The held coordinates of the direction are not the gradient's matter.
    const auto values = g.download();
    const auto layout = s.levels.make_layout(0);
    const auto local = layout->order.vertices.apply(s.wanted.held.bits());
    auto free = direction;
    for (std::size_t v = 0; v < local.size(); ++v)
        for (std::size_t k = 0; k < 2; ++k)
            if ((local[v] >> k & 1u) != 0)
            {
                CHECK(values[k * layout->vertex_stride + v] == 0);
                free[k * layout->vertex_stride + v] = 0;
            }
    d.upload(free);
    f.step(x, h, d, y);
    const double ahead_free = f.value(y);
    f.step(x, -h, d, y);
    const double behind_free = f.value(y);
    CHECK(ahead - behind != ahead_free - behind_free);
    CHECK(f.space().dot(g, d) == doctest::Approx((ahead_free - behind_free) / (2 * h)).epsilon(1e-5));
}

TEST_CASE("point constraints: the Hessian is the derivative of the gradient")
{
    setting s;
    auto f = s.objective(s.wanted);
    auto x = f.make_point(), y = f.make_point();
    f.upload(s.start, x);
    auto g = f.space().make(), d = f.space().make(), Hd = f.space().make(), other = f.space().make();
    f.value_gradient(x, d); // zero where held, as directions are
    f.linearize(x, true);
    f.hessian_product(d, Hd);
    const double h = 1e-6 * f.max_step(x, d);
    f.step(x, h, d, y);
    f.value_gradient(y, g);
    f.step(x, -h, d, y);
    f.value_gradient(y, other);
    const auto ahead = g.download(), behind = other.download(), product = Hd.download();
    double worst = 0, most = 0;
    for (std::size_t i = 0; i < product.size(); ++i)
    {
        worst = std::max(worst, std::abs((ahead[i] - behind[i]) / (2 * h) - product[i]));
        most = std::max(most, std::abs(product[i]));
    }
    CHECK(worst < 1e-5 * most);
}

TEST_CASE("point constraints: Newton's method converges, held coordinates stay and springs pull")
{
    setting s;
    auto f = s.objective(s.wanted);
    auto x = f.make_point();
    f.upload(s.start, x);
    solve::params how;
    how.gradient_tolerance = 1e-8;
    const auto report = solve::minimize(f, x, how);
    CHECK(report.stop == solve::stop::gradient);
    CHECK(report.iterations < 60);
    const auto end = f.download(x);
    for (std::size_t v = 0; v < end.size(); ++v)
        for (int k = 0; k < 2; ++k)
            if (s.wanted.held.test(v, k)) CHECK(end[v][k] == s.start[v][k]);
    CHECK(s.spring_energy(end) < 0.2 * s.spring_energy(s.start));
    CHECK(certify<2>(s.finest.cells(), std::span<const vec2>(end)).flipped == 0);
}

} // namespace
