// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <taut/impl/core/map/smooth.hpp>
#include <taut/smooth.hpp>

#include "shared/options.hpp"

namespace taut::tools
{

/// Energies of a deformation.
enum class shape_energy
{
    isometric,
    shape,
    volume,
    neo_hookean
};

/// Options of `taut deform` and `taut smooth`.
struct shape_options
{
    std::string input, output, stats, picture, clip, device, progress;
    double time_limit = std::numeric_limits<double>::infinity();
    std::optional<double> tolerance; ///< relative gradient; none: as the library has it
    bool quiet = false, smoothing = false;
    int zone = 0; ///< of a SU2 file of several; 0: none

    // deform
    std::string pins, rest;
    std::vector<std::string> moves, fixed; ///< of groups; smooth has fixed ones, too
    shape_energy energy = shape_energy::isometric;
    bool refine = false;
    std::string refined_map;         ///< a table of what elements are parts of; empty: none
    std::optional<double> thickness; ///< of a surface, in its lengths

    // smooth
    smooth_boundary boundary = smooth_boundary::sliding;
    bool free_interfaces = false; ///< between regions and on labelled faces inside, which are kept else
    int worst_exponent = 2;
};

/// A note of a mesh that nothing deforms.
inline constexpr const char* nothing_held =
    "nothing is fixed or moved, so the mesh takes its rest shape; use --pins, --fix "
    "or --move";

/// The end of a note on a file of pins.
inline constexpr const char* no_pins = ": no pins in it";

/// A note of what smoothing keeps inside.
std::string kept_interfaces_note(std::uint64_t vertices);

/// Declare the options of either command; they are filled when the program's arguments are parsed.
void declare_deform(const subcommand& app, shape_options& options);
void declare_smooth(const subcommand& app, shape_options& options);

/// Returns whether a file is one of a surface in space, by its extension.
bool names_surface(const std::string& path);

/// Throws usage_error for an output that is no file where it has to be one.
void check(const shape_options& options);

/// The energy to minimise while a mesh deforms.
any_energy energy_of(shape_energy choice);

} // namespace taut::tools
