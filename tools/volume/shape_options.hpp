// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <string>
#include <vector>

#include <taut/map/smooth.hpp>

namespace taut::tools
{

/// What to minimise while a mesh deforms.
enum class shape_energy
{
    isometric,
    shape,
    volume,
    neo_hookean
};

/// What the user asked `taut deform` or `taut smooth` for.
struct shape_options
{
    std::string input, output, stats, picture, cut, device, progress;
    double time_limit = std::numeric_limits<double>::infinity();
    bool quiet = false;

    // deform
    std::string pins, rest;
    std::vector<std::string> moves, fixed; ///< of groups; smooth has fixed ones, too
    shape_energy energy = shape_energy::isometric;

    // smooth
    smooth_boundary boundary = smooth_boundary::sliding;
    int worst_exponent = 2;
};

} // namespace taut::tools
