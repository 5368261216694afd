// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>
#include <ostream>
#include <random>
#include <sstream>
#include <string>

#include <taut/symbolic.hpp>

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
