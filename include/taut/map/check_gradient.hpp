// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include <taut/map/any_energy.hpp>
#include <taut/symbolic/differentiate.hpp>
#include <taut/symbolic/evaluate.hpp>

namespace taut
{

/// What check_gradient found.
struct gradient_check
{
    double worst = 0;    ///< largest |derivative - finite difference| / max(1, |derivative|) over all trials
    int trials = 0;      ///< elements tried
    bool barrier = true; ///< if the energy says that it is a barrier: it grew without bound as det S fell to 0

    /// True if the derivative that kernels use agrees with the function to what finite differences can tell.
    explicit operator bool() const { return worst < 1e-5 && barrier; }
};

/// Holds the traced derivative of an energy against central differences of its host values on random elements of
/// positive determinant. For energies of your own: a tape differentiates what was traced, so a disagreement means that
/// the function takes other paths for numbers than for traced scalars (a cast, a table, a branch on T), or that it is
/// not smooth.
template <int D>
gradient_check check_gradient(const any_energy& energy, int trials = 100, unsigned seed = 1)
{
    using real = sym<double>;
    tape recorded;
    const tape_scope scope(recorded);
    std::vector<real> unknowns;
    glm::mat<D, D, real> S;
    for (int c = 0; c < D; ++c)
        for (int r = 0; r < D; ++r) unknowns.push_back(S[c][r] = real::variable());
    const real value = energy(element<real, D>{S, glm::determinant(S), real(1.0)});
    const auto partials = differentiate(value, unknowns);

    const auto host = [&](const mat<D>& m) { return energy(element<double, D>{m, glm::determinant(m), 1.0}); };
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> entry(-0.6, 0.6);
    gradient_check result;
    while (result.trials < trials)
    {
        mat<D> m(1.0);
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r) m[c][r] += entry(random);
        if (glm::determinant(m) < 0.1) continue;
        ++result.trials;

        std::vector<binding> bindings;
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r) bindings.emplace_back(S[c][r], m[c][r]);
        const auto derivative = evaluator(recorded, bindings)(std::span<const real>(partials));
        for (std::size_t k = 0; k < unknowns.size(); ++k)
        {
            constexpr double h = 1e-6;
            const int c = static_cast<int>(k) / D, r = static_cast<int>(k) % D;
            mat<D> up = m, down = m;
            up[c][r] += h;
            down[c][r] -= h;
            const double difference = (host(up) - host(down)) / (2 * h);
            const double error = std::abs(derivative[k] - difference) / std::max(1.0, std::abs(derivative[k]));
            result.worst = std::isnan(error) ? std::numeric_limits<double>::infinity() : std::max(result.worst, error);
        }
    }
    if (energy.barrier())
    {
        mat<D> flat(1.0);
        flat[0][0] = 1e-60;
        result.barrier = host(flat) > 1e10;
    }
    return result;
}

} // namespace taut
