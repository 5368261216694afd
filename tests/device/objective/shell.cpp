// SPDX-License-Identifier: MIT
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>

#include <taut/impl/core/objective/mesh_levels.hpp>
#include <taut/impl/core/objective/newton_objective.hpp>
#include <taut/rigid_motion.hpp>
#include <taut/shell.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

/// A bumpy surface as a thin shell on a device, in double, no vertex held; shapes in the order of level 0.
struct shell_fixture
{
    using objective_type = newton_objective<hinge>;

    thin_shell shell;
    any_energy energy;
    mesh_levels<hinge> levels;
    queue q{test::shared_context()};
    objective_type objective;
    std::vector<vec3> rest;

    explicit shell_fixture(mesh<triangle> m, double thickness = 0.7)
        : shell(std::move(m)),
          energy(any_energy(energy::shell{})
                     .with_parameters({thickness})
                     .with_data(shell.rest().mean_attributes(), false)),
          levels(shell.hinges(), {}, {}, shell.rest()),
          objective(q, newton_plan<hinge>(levels, 0, lane_form::for_device(q.device())), energy,
                    energy::weighting::uniform,
                    std::make_shared<const newton_kernels<hinge>>(q, energy, types_of(precision::fp64))),
          rest(levels.points().begin(), levels.points().end())
    {
    }

    std::vector<vec3> shaken(double by) const
    {
        std::mt19937 generator(5);
        std::normal_distribution<double> normal(0.0, by * shell.mean_edge());
        auto x = rest;
        for (vec3& p : x)
            for (int c = 2; c >= 0; --c) p[c] += normal(generator); // arguments have no order
        return x;
    }

    double value(const std::vector<vec3>& x)
    {
        auto p = objective.make_point();
        objective.upload(x, p);
        return objective.value(p);
    }

    /// By the energy's own template, on the host.
    double host_value(const std::vector<vec3>& x) const
    {
        const ideal_elements<hinge> ideal(shell.hinges());
        const auto& user = levels.order().vertices.old_to_new;
        const auto n = shell_attributes::count;
        double sum = 0;
        for (std::size_t c = 0; c < shell.hinges().cells().size(); ++c)
        {
            auto cell = shell.hinges().cells()[c];
            for (taut::idx& v : cell) v = user[static_cast<std::size_t>(v)];
            const mat3 S = shape_matrix<3>(cell, std::span<const vec3>(x), ideal.inverse[c]);
            const std::span<const double> numbers(shell.rest().attributes.data() + c * n, n);
            sum += energy(element<double, 3>{S, glm::determinant(S), 1.0, numbers, energy.parameters()});
        }
        return sum / static_cast<double>(shell.hinges().cells().size());
    }
};

} // namespace

TEST_CASE("shell: rigid motions cost nothing, and all else does, on the device as on the host")
{
    shell_fixture f(test::bumpy(6));
    CHECK(f.value(f.rest) == doctest::Approx(0).epsilon(1e-12));
    const rigid_motion<3> turn{.from = {0, 0, 1}, .to = {3, 1, 0}, .axis = glm::normalize(vec3(1, 2, 3)), .angle = 2};
    auto moved = f.rest;
    for (vec3& p : moved) p = turn(p);
    CHECK(std::abs(f.value(moved)) < 1e-11);
    for (const double by : {0.01, 0.1, 0.3})
    {
        const auto x = f.shaken(by);
        CHECK(f.value(x) > 0);
        CHECK(f.value(x) == doctest::Approx(f.host_value(x)).epsilon(1e-10));
    }
}

TEST_CASE("shell: a bent plate costs what its thickness says, whatever its triangles")
{
    for (const int n : {16, 32})
        for (const double h : {0.05, 0.2})
        {
            shell_fixture f(test::grid(n, n), 1.0);
            double longest = 0;
            for (const vec3& p : f.rest) longest = std::max(longest, p.x);
            const double radius = 2 * longest, thickness = h * longest;
            f.objective.set_parameters(std::vector{thickness / f.shell.mean_edge()});
            auto x = f.rest;
            for (vec3& p : x) p = {radius * std::sin(p.x / radius), p.y, radius * (1 - std::cos(p.x / radius))};
            const double plate = thickness * thickness / (3 * radius * radius); // 4 strain^2, in the mean
            CHECK(f.value(x) == doctest::Approx(plate).epsilon(n == 16 ? 0.2 : 0.1));
        }
}

TEST_CASE("shell: gradient and Hessian are those of differences, and the stand-in is positive")
{
    shell_fixture f(test::bumpy(5));
    const auto& space = f.objective.space();
    auto x = f.objective.make_point(), y = f.objective.make_point();
    auto g = space.make(), other = space.make(), v = space.make(), Hv = space.make();
    f.objective.upload(f.shaken(0.15), x);
    f.objective.value_gradient(x, g);
    const double h = 1e-6;
    for (unsigned seed = 1; seed <= 4; ++seed)
    {
        std::mt19937 generator(seed);
        std::normal_distribution<double> normal;
        std::vector<vec3> direction(f.rest.size());
        for (vec3& d : direction) d = {normal(generator), normal(generator), normal(generator)};
        v.upload(f.objective.layout().to_local(direction));

        f.objective.step(x, h, v, y);
        const double after = f.objective.value_gradient(y, Hv);
        f.objective.step(x, -h, v, y);
        const double before = f.objective.value_gradient(y, other);
        CHECK((after - before) / (2 * h) == doctest::Approx(space.dot(g, v)).epsilon(1e-5));

        space.axpby(-1 / (2 * h), other, 1 / (2 * h), Hv); // of differences
        f.objective.linearize(x, true);
        f.objective.hessian_product(v, other);
        const double size = std::sqrt(space.dot(Hv, Hv));
        space.axpby(-1, other, 1, Hv);
        CHECK(std::sqrt(space.dot(Hv, Hv)) < 1e-5 * size);

        f.objective.linearize(x, false);
        f.objective.hessian_product(v, other);
        CHECK(space.dot(v, other) > 0);
    }
}
