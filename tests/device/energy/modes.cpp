// SPDX-License-Identifier: MIT
// Not among the unit tests: Eigen aligns in another way under the address sanitizer, and the oracle is compiled
// without.
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <support/mips_power.hpp>
#include <support/symmetric_eigen.hpp>

#include <taut/energies.hpp>
#include <taut/impl/core/energy/algebra.hpp>
#include <taut/impl/core/energy/isotropic.hpp>
#include <taut/impl/core/energy/modes.hpp>
#include <taut/symbolic.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using matrix = Eigen::MatrixXd;

/// Of the sizes of S.
struct spread
{
    static constexpr bool barrier = false;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return norm2(e.S) * norm2(e.S) - e.det * T(3);
    }
};

/// The Hessian of an energy of space by the entries of S, from the tape and as space_modes has it, at matrices.
class hessians
{
public:
    hessians(const any_energy& energy, bool projected, bool absolute)
    {
        const tape_scope scope(tape_);
        glm::mat<3, 3, sym<double>> S;
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) unknowns_.push_back(S[c][r] = sym<double>::variable());
        const sym<double> value = energy(element<sym<double>, 3>{S, glm::determinant(S), 1.0});
        const auto gradient = differentiate(value, unknowns_);
        for (std::size_t j = 0; j < 9; ++j)
            for (const auto& entry : differentiate(gradient[j], unknowns_)) outputs_.push_back(entry);
        const auto psi = derivatives_by_invariants<3>(value, S);
        REQUIRE(psi.has_value());
        const auto H = space_modes<sym<double>>(S, *psi, scalar_type::f64, {projected, absolute}).hessian(1.0);
        for (int j = 0; j < 9; ++j)
            for (int i = 0; i < 9; ++i) outputs_.push_back(H(i, j));
    }

    std::pair<matrix, matrix> at(const mat3& S)
    {
        const tape_scope scope(tape_);
        std::vector<binding> values;
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) values.emplace_back(unknowns_[static_cast<std::size_t>(3 * c + r)], S[c][r]);
        const auto all = evaluate(outputs_, values);
        return {Eigen::Map<const matrix>(all.data(), 9, 9), Eigen::Map<const matrix>(all.data() + 81, 9, 9)};
    }

private:
    tape tape_;
    std::vector<sym<double>> unknowns_, outputs_;
};

mat3 diagonal(double a, double b, double c)
{
    return {a, 0, 0, 0, b, 0, 0, 0, c};
}

} // namespace

TEST_CASE("space modes: the Hessian, as it is, clamped or absolute, whatever the singular values")
{
    std::mt19937 rng(3);
    const auto random = [&]
    {
        mat3 m;
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) m[c][r] = double(rng()) / 2147483648.0 - 1;
        return m;
    };
    std::vector<mat3> tried = {mat3(1.0),
                               diagonal(2, 2, 2),
                               diagonal(3, 1, 1),
                               diagonal(1, 1, 0.1),
                               diagonal(1e-3, 5, 1),
                               diagonal(10, 0.2, 4),
                               diagonal(100, 1, 1e-3)};
    for (int n = 0; n < 40; ++n)
    {
        mat3 S = random();
        if (glm::determinant(S) < 0) S[1] = -S[1];
        tried.push_back(S);
    }
    // The same in other frames.
    const mat3 turn(0.36, 0.48, -0.8, -0.8, 0.6, 0, 0.48, 0.64, 0.6);
    for (std::size_t n = 0, all = tried.size(); n < all; ++n) tried.push_back(turn * tried[n] * glm::transpose(turn));

    for (const any_energy& energy :
         {any_energy(energy::isometric{}), any_energy(energy::shape{}), any_energy(test::mips_power{.p = 2}),
          any_energy(0.5 * energy::isometric{} + 0.5 * energy::area{}), any_energy(energy::neo_hookean{0.49}),
          any_energy(spread{})})
        for (const auto& kind : {std::pair(false, false), std::pair(true, false), std::pair(true, true)})
        {
            const bool projected = kind.first, absolute = kind.second; // lambdas of CHECK may not use a binding
            hessians H(energy, projected, absolute);
            for (const mat3& S : tried)
            {
                const auto [exact, modes] = H.at(S);
                const auto eigen = test::decompose(exact);
                const matrix expected = !projected ? exact : absolute ? eigen.absolute() : eigen.clamped();
                CAPTURE(projected);
                CAPTURE(absolute);
                CAPTURE(glm::determinant(S));
                CHECK((modes - expected).norm() <= 1e-9 * expected.norm() + 1e-12);
            }
        }
}

TEST_CASE("space modes: finite where S is singular, for energies that are")
{
    hessians H(any_energy(spread{}), true, false);
    for (const mat3& S : {diagonal(0, 0, 0), diagonal(1, 0, 0), diagonal(0, 2, 1), diagonal(1, -1, 2)})
    {
        const auto [exact, modes] = H.at(S);
        CHECK(modes.allFinite());
        CHECK(test::decompose(modes).values.minCoeff() >= -1e-9);
        const matrix expected = test::decompose(exact).clamped();
        CHECK((modes - expected).norm() <= 1e-9 * (expected.norm() + 1));
    }
}

TEST_CASE("isotropy is found in space as in the plane")
{
    CHECK(is_isotropic<3>(energy::isometric{}));
    CHECK(is_isotropic<3>(0.3 * energy::isometric{} + test::mips_power{.p = 3}));
    CHECK(is_isotropic<2>(energy::isometric{}));
}
