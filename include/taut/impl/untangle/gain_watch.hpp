// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

namespace taut::impl
{

/// Progress test of a stage towards an injective map: fewer inverted elements than ever, or a hundredth less of their
/// measure. Energies do not show it, as they fall with every epsilon.
class gain_watch
{
public:
    /// After a step: how many elements are inverted, and their measure.
    void note(std::size_t inverted, double measure)
    {
        const bool gained = inverted < fewest_ || measure < 0.99 * least_;
        fewest_ = std::min(fewest_, inverted);
        if (gained) least_ = std::min(least_, measure);
        idle_ = gained ? 0 : idle_ + 1;
    }

    /// Returns whether there was no gain in so many steps that epsilon was large again at least once.
    bool stuck() const { return idle_ >= 60; }

private:
    std::size_t fewest_ = std::numeric_limits<std::size_t>::max();
    double least_ = std::numeric_limits<double>::infinity();
    int idle_ = 0;
};

} // namespace taut::impl
