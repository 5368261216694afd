// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <picture/color.hpp>
#include <taut/errors.hpp>

namespace taut::io
{

/// The fixed scale of distortion pictures: a distortion in [lowest, highest], by its logarithm, -> a colour from pale
/// blue grey (no distortion) over amber to dark brown. Fixed, so that two pictures compare.
///
/// The colours follow a quadratic Bezier curve through OKLab, resampled by arc length: equal ratios of distortion are
/// equally different to the eye. Lightness falls all the way, so the order survives grey print and every kind of colour
/// blindness; and the way over amber keeps clear of magenta for deuteranopes and protanopes too, to whom magenta is a
/// kind of blue, which a scale of blues and greens does not. The control points are our own; the requirements are those
/// of Nunez, Anderton and Renslow, "Optimizing colormaps with consideration for color vision deficiency", 2018.
class distortion_scale
{
public:
    static constexpr int colors = 256;

    /// Errors: parameter_error unless 0 < lowest < highest, both finite.
    explicit distortion_scale(double lowest = 1, double highest = 10) : lowest_(lowest), highest_(highest)
    {
        if (!(lowest > 0 && lowest < highest && std::isfinite(highest)))
            throw parameter_error("scale", "needs 0 < lowest < highest");
        fill_table();
    }

    double lowest() const noexcept { return lowest_; }
    double highest() const noexcept { return highest_; }

    /// Position of a distortion on the scale, in [0, 1]; beyond the ends it is clamped. NaN stays NaN.
    double position(double distortion) const
    {
        if (std::isnan(distortion)) return distortion;
        if (distortion <= lowest_) return 0;
        if (distortion >= highest_) return 1;
        return std::log(distortion / lowest_) / std::log(highest_ / lowest_);
    }

    /// The colour at a position in [0, 1].
    rgb at(double position) const { return table_[static_cast<std::size_t>(std::lround(position * (colors - 1)))]; }

    /// The colour of a distortion; NaN, "not known", is a plain grey.
    rgb operator()(double distortion) const
    {
        const double t = position(distortion);
        return std::isnan(t) ? unknown : at(t);
    }

    static constexpr rgb unknown{178, 178, 178};

private:
    void fill_table()
    {
        static constexpr int fine = 2048;
        const auto curve = [](double t)
        {
            const vec3 pale(0.93, -0.02, -0.025), amber(0.80, 0.045, 0.20), brown(0.33, 0.09, 0.05);
            return (1 - t) * (1 - t) * pale + 2 * t * (1 - t) * amber + t * t * brown;
        };
        std::array<double, fine + 1> length{}; // of the curve up to t = i / fine
        for (int i = 1; i <= fine; ++i)
        {
            const auto at = static_cast<std::size_t>(i);
            length[at] = length[at - 1] + glm::length(curve(i / double(fine)) - curve((i - 1) / double(fine)));
        }
        int i = 0;
        for (int k = 0; k < colors; ++k)
        {
            while (i < fine && length[static_cast<std::size_t>(i)] < length.back() * k / (colors - 1)) ++i;
            table_[static_cast<std::size_t>(k)] = to_rgb(oklab_to_linear(curve(i / double(fine))));
        }
    }

    double lowest_;
    double highest_;
    std::array<rgb, colors> table_{};
};

} // namespace taut::io
