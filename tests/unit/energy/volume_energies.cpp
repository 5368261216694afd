// SPDX-License-Identifier: MIT
#include <cmath>

#include <doctest/doctest.h>

#include <taut/energies.hpp>

namespace
{

using namespace taut;

template <class Energy>
double value_at(const Energy& f, const mat3& S)
{
    return f(element<double, 3>{S, glm::determinant(S), 1.0});
}

const mat3 rotation(0.6, 0.8, 0.0, -0.8, 0.6, 0.0, 0.0, 0.0, 1.0);

} // namespace

TEST_CASE("neo-Hookean: nothing at rotations, and linear elasticity near them")
{
    for (const double nu : {0.0, 0.3, 0.45})
    {
        const energy::neo_hookean f{nu};
        CHECK(std::abs(value_at(f, rotation)) < 1e-15);
        const double mu = 0.5 / (1 + nu), lambda = nu / ((1 + nu) * (1 - 2 * nu)), h = 1e-4;
        const mat3 strain(2.0, 0.5, 0.0, 0.5, -1.0, 0.3, 0.0, 0.3, 0.4);
        double square = 0;
        for (int k = 0; k < 3; ++k) square += glm::dot(strain[k], strain[k]);
        const double trace = 1.4, linear = h * h * (mu * square + 0.5 * lambda * trace * trace);
        const mat3 S = rotation * (mat3(1.0) + h * strain);
        CHECK(value_at(f, S) == doctest::Approx(linear).epsilon(1e-3));
        const auto lame = energy::neo_hookean::of_poisson(nu);
        const element<double, 3> e{.S = S, .det = glm::determinant(S), .measure = 1.0, .parameters = lame};
        CHECK(energy::neo_hookean_of_parameters{}(e) == f(e));
    }
}

TEST_CASE("shape power: a power of the shape energy, 1 at similarities")
{
    const mat3 S(1.0, 0.2, 0.0, 0.1, 1.5, 0.3, 0.0, -0.2, 0.7);
    const double once = value_at(energy::shape{}, S);
    CHECK(value_at(energy::shape_power{1}, S) == doctest::Approx(once));
    CHECK(value_at(energy::shape_power{3}, S) == doctest::Approx(std::pow(once, 3)));
    CHECK(value_at(energy::shape_power{4}, 2.5 * rotation) == doctest::Approx(1));
}
