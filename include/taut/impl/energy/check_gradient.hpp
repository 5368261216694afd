// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <ostream>
#include <random>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include <taut/impl/energy/any_energy.hpp>
#include <taut/impl/symbolic/differentiate.hpp>
#include <taut/impl/symbolic/evaluate.hpp>

namespace taut::impl
{

/// Result of check_gradient().
struct gradient_check
{
    double worst = 0;    ///< largest |derivative - finite difference| / max(1, |derivative|) over all trials
    double turned = 0;   ///< largest |E(S R) - E(S)| / max(1, |E(S)|) over all trials, each with a rotation R
    int trials = 0;      ///< elements tried
    bool barrier = true; ///< if the energy says that it is a barrier: it grew without bound as det S fell to 0

    /// True if the derivative of the kernels agrees with the function up to the error of finite differences.
    bool derivative() const { return worst < 1e-5; }

    /// True if the energy does not depend on the first corner of an element. If it does, so does the map.
    bool isotropic() const { return turned < 1e-9; }

    /// True if nothing was found.
    explicit operator bool() const { return derivative() && isotropic() && barrier; }
};

/// Prints the faults in words.
inline std::ostream& operator<<(std::ostream& out, const gradient_check& c)
{
    std::ostringstream text; // so that the user's stream keeps its format
    if (!c.derivative())
        text << "the derivative differs from finite differences by " << c.worst
             << ": the function takes another path for numbers than for traced scalars, or is not smooth; ";
    if (!c.isotropic())
        text << "E(S R) differs from E(S) by " << c.turned
             << " for a rotation R: the energy depends on which corner comes first; ";
    if (!c.barrier) text << "barrier = true, but the energy stays bounded as det S falls to 0; ";
    std::string found = text.str();
    if (found.empty()) return out << "no fault in " << c.trials << " trials";
    found.resize(found.size() - 2);
    return out << found;
}

/// A rotation by random angles.
template <int D, class Random>
mat<D> random_rotation(Random& random)
{
    std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi);
    mat<D> R(1.0);
    for (int i = 0; i < D; ++i)
        for (int j = i + 1; j < D; ++j)
        {
            const double a = angle(random);
            mat<D> turn(1.0);
            turn[i][i] = turn[j][j] = std::cos(a);
            turn[j][i] = -(turn[i][j] = std::sin(a));
            R = turn * R;
        }
    return R;
}

/// Returns whether a function of t grows without bound as t tends to 0, judged by three values: a bounded one hardly
/// grows after the second.
template <class F>
bool grows_without_bound(F&& f)
{
    const double first = f(1e-20), second = f(1e-40), third = f(1e-80);
    return std::isinf(third) ? third > 0 : third - second > 0.5 * (second - first) && second > first;
}

} // namespace taut::impl

namespace taut
{

/// Checks an energy on random elements of positive determinant: its traced derivative against central differences of
/// its host values, its invariance to rotations of the rest shape's frame, and that a barrier is one. For energies of
/// your own: a tape differentiates what was traced, so a disagreement means that the function branches differently for
/// numbers and for traced scalars (a cast, a table, a branch on T), or that it is not smooth.
template <int D>
impl::gradient_check check_gradient(const any_energy& energy, int trials = 100, unsigned seed = 1)
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
    const auto largest = [](double so_far, double found)
    { return std::isnan(found) ? std::numeric_limits<double>::infinity() : std::max(so_far, found); };
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> entry(-0.6, 0.6);
    impl::gradient_check result;
    while (result.trials < trials)
    {
        mat<D> m(1.0);
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r) m[c][r] += entry(random);
        if (glm::determinant(m) < 0.1) continue;
        ++result.trials;
        const double here = host(m), there = host(m * impl::random_rotation<D>(random));
        result.turned = largest(result.turned, std::abs(there - here) / std::max(1.0, std::abs(here)));

        std::vector<impl::binding> bindings;
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r) bindings.emplace_back(S[c][r], m[c][r]);
        const auto derivative = impl::evaluator(recorded, bindings)(std::span<const real>(partials));
        for (std::size_t k = 0; k < unknowns.size(); ++k)
        {
            constexpr double h = 1e-6;
            const int c = static_cast<int>(k) / D, r = static_cast<int>(k) % D;
            mat<D> up = m, down = m;
            up[c][r] += h;
            down[c][r] -= h;
            const double difference = (host(up) - host(down)) / (2 * h);
            const double error = std::abs(derivative[k] - difference) / std::max(1.0, std::abs(derivative[k]));
            result.worst = largest(result.worst, error);
        }
    }
    const auto at_height = [&](double t)
    {
        mat<D> flat(1.0);
        flat[0][0] = t;
        return host(flat);
    };
    result.barrier = !energy.barrier() || impl::grows_without_bound(at_height);
    return result;
}

} // namespace taut
