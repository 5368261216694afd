// SPDX-License-Identifier: MIT
// What the other tests of this folder show for triangles, one dimension up.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/mips_power.hpp>
#include <support/reference_problem.hpp>
#include <support/shared_context.hpp>

#include <taut/certify.hpp>
#include <taut/energies.hpp>
#include <taut/impl/core/energy/algebra.hpp>
#include <taut/impl/core/mesh/first_flip.hpp>
#include <taut/impl/core/objective/volume_objective.hpp>
#include <taut/solve.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

/// Sees the frame of the ideal element: there is no closed form for it.
struct stiff_along_x
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return (norm2(e.S) + T(2) * glm::dot(e.S[0], e.S[0])) * (T(1) + T(1) / (e.det * e.det));
    }
};

/// A cube of tetrahedra in the order of its layout, the lowest layer pinned and the highest one, too, turned by an
/// angle.
struct fixture
{
    queue q{test::shared_context()};
    mesh<tetrahedron> volume;
    idx free = 0;
    std::shared_ptr<const layout<tetrahedron>> local;
    std::vector<vec3> start;

    explicit fixture(int n = 3, double angle = 0.5) : volume(test::cube(n))
    {
        std::vector<bool> pinned;
        for (const vec3& p : volume.points()) pinned.push_back(p.z == 0 || p.z == 1);
        const solution_order order(volume, pinned);
        volume = permute(volume, order.order);
        free = order.free_count;
        local = std::make_shared<const layout<tetrahedron>>(volume, identity_order(volume), free);
        for (const vec3& p : volume.points())
        {
            const double a = angle * p.z, x = p.x - 0.5, y = p.y - 0.5;
            start.emplace_back(x * std::cos(a) - y * std::sin(a), x * std::sin(a) + y * std::cos(a), p.z);
        }
        // What is free is shaken a little.
        std::mt19937 rng(2);
        for (std::size_t v = 0; v < static_cast<std::size_t>(free); ++v)
            for (int k = 0; k < 3; ++k) start[v][k] += 0.02 / n * (double(rng()) / 2147483648.0 - 1);
    }

    newton_objective<tetrahedron> newton(const any_energy& energy, const real_types& types = {})
    {
        const std::vector<char> fixed = [&]
        {
            std::vector<char> flags(volume.points().size(), 0);
            std::fill(flags.begin() + free, flags.end(), char(1));
            return flags;
        }();
        return {q,
                {local, volume.cells(), {}, fixed, lane_form::for_device(q.device())},
                energy,
                energy::weighting::measure,
                std::make_shared<const newton_kernels<tetrahedron>>(q, energy, types)};
    }
};

} // namespace

TEST_CASE("tetrahedra: the device's value and gradient are those of the host")
{
    fixture s;
    for (const any_energy& energy : {any_energy(energy::isometric{}), any_energy(test::mips_power{.p = 2})})
        for (const precision how : {precision::fp64, precision::mixed})
        {
            map_objective<tetrahedron> f(s.q, s.local, energy, energy::weighting::measure, types_of(how));
            const test::reference_problem<tetrahedron> host(s.local, energy, energy::weighting::measure);
            auto x = f.make_point();
            f.upload(s.start, x);
            auto g = f.space().make();
            std::vector<double> expected(host.size());
            const auto local = s.local->to_local(s.start);
            const double value = host(local, expected);
            const double tolerance = how == precision::fp64 ? 1e-12 : 1e-6;
            CHECK(f.value_gradient(x, g) == doctest::Approx(value).epsilon(tolerance));
            CHECK(f.value(x) == doctest::Approx(value).epsilon(tolerance));
            const auto found = g.download();
            double worst = 0, largest = 0;
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t v = 0; v < static_cast<std::size_t>(s.free); ++v)
                {
                    const std::size_t i = k * s.local->vertex_stride + v;
                    worst = std::max(worst, std::abs(found[i] - expected[i]));
                    largest = std::max(largest, std::abs(expected[i]));
                }
            CHECK(worst <= tolerance * largest);
        }
}

TEST_CASE("tetrahedra: no step within the first flip folds, and one beyond does")
{
    fixture s;
    map_objective<tetrahedron> f(s.q, s.local, energy::isometric{}, energy::weighting::measure);
    std::mt19937 rng(4);
    auto x = f.make_point(), moved = f.make_point();
    f.upload(s.start, x);
    for (int trial = 0; trial < 8; ++trial)
    {
        std::vector<double> direction(3 * s.local->vertex_stride, 0.0);
        for (double& v : direction) v = double(rng()) / 2147483648.0 - 1;
        auto d = f.space().make();
        d.upload(direction);
        const double most = f.max_step(x, d);
        for (const double a : {0.25, 0.9, 0.9999})
        {
            f.step(x, a * most, d, moved);
            CHECK(std::isfinite(f.value(moved)));
        }
        f.step(x, 1.005 * most, d, moved);
        CHECK(std::isinf(f.value(moved)));
    }
}

TEST_CASE("tetrahedra: Newton's method and L-BFGS come to one minimum, without a flip")
{
    fixture s;
    for (const any_energy& energy : {any_energy(energy::isometric{}), any_energy(stiff_along_x{})})
    {
        auto f = s.newton(energy);
        auto x = f.make_point(), y = f.make_point();
        f.upload(s.start, x);
        f.upload(s.start, y);
        const auto newton = solve::minimize(f, x, {.gradient_tolerance = 1e-8});
        CHECK(newton.stop == solve::stop::gradient);
        CHECK(newton.iterations <= 25);
        map_objective<tetrahedron> g(s.q, s.local, energy, energy::weighting::measure);
        const auto lbfgs = solve::minimize(g, y, {.gradient_tolerance = 1e-7});
        CHECK(lbfgs.stop == solve::stop::gradient);
        CHECK(newton.value == doctest::Approx(lbfgs.value).epsilon(1e-9));
        CHECK(newton.value < newton.value_start);
        CHECK(certify<3>(s.volume.cells(), std::span<const vec3>(f.download(x))));
        // Pinned vertices stay bit for bit.
        const auto map = f.download(x);
        for (std::size_t v = static_cast<std::size_t>(s.free); v < map.size(); ++v) CHECK(map[v] == s.start[v]);
    }
}

TEST_CASE("tetrahedra: Newton's method in mixed precision, from far away")
{
    fixture s(4, 2.0);
    auto f = s.newton(energy::isometric{}, types_of(precision::mixed));
    auto x = f.make_point();
    f.upload(s.start, x);
    const auto r = solve::minimize(f, x, {.gradient_tolerance = 1e-4});
    CHECK(r.stop == solve::stop::gradient);
    CHECK(certify<3>(s.volume.cells(), std::span<const vec3>(f.download(x))));
}
