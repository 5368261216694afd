// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <taut/atlas.hpp>
#include <taut/surface_file.hpp>

#include "atlas/atlas_source.hpp"
#include "shared/options.hpp"

namespace taut::tools
{

/// Charts of an atlas.
enum class chart_use
{
    make,
    keep, ///< those of the vt of the file, relaxed
    pack  ///< the same, as they are
};

/// Options of `taut atlas`.
struct atlas_options
{
    std::vector<std::string> inputs, outputs; ///< as many of these as of those
    std::vector<std::string> densities;       ///< NAME=FACTOR
    std::string seams, seam_weights, pinned, stats, picture, render, report, device, progress;
    io::surface_format format{};
    chart_preference prefer = chart_preference::seams;
    chart_use charts = chart_use::make;
    bool repair = false, keep_seams = false, symmetric = false, upright = false, quiet = false;
    bool stack = false;         ///< copies of charts lie on each other
    bool by_material = false;   ///< a tile for each material
    bool apart = false;         ///< source_options::apart
    bool in_scene = true;       ///< source_options::in_scene
    std::optional<double> weld; ///< repairs, too
    std::optional<double> max_distortion, mean_distortion, max_stretch;
    std::optional<double> padding;
    std::optional<int> tiles, mip_levels, read_texcoord_set;
    std::string size = "1024"; ///< N or WxH
    double hide = 0, crease_angle = 180;
    double texels_per_unit = 0; ///< 0: as many as fit
    int max_resolution = 0, align = 1, texcoord_set = 0;
    double time_limit = std::numeric_limits<double>::infinity();

    bool keep_charts() const { return charts != chart_use::make; }
};

/// Declares the options; they are filled when the program's arguments are parsed.
void declare(const subcommand& app, atlas_options& options);

/// Throws usage_error for options that do not fit together.
void check(const atlas_options& options);

/// Texels between charts.
double padding_of(const atlas_options& options);

/// Command line that reproduces a run.
std::string as_command_line(const atlas_options& options);

/// atlas_params::origin for these outputs.
vec2 origin_of(const atlas_options& options);

source_options to_source_options(const atlas_options& options);

/// Parameters of the library, without seams, initial map and observer.
atlas_params to_params(const atlas_options& options);

} // namespace taut::tools
