// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <optional>
#include <string>

#include <taut/parameterize.hpp>
#include <taut/surface_file.hpp>

#include "shared/options.hpp"

namespace taut::tools
{

enum class start_kind
{
    automatic,
    coarse,
    stretch,
    tutte,
    mean_value,
    conformal,
    uv
};

enum class solver_kind
{
    newton,
    multigrid_lbfgs,
    lbfgs,
    conjugate_gradient,
    gradient_descent
};

enum class boundary_kind
{
    free,
    circle,
    square
};

enum class energy_kind
{
    isometric,
    shape,
    area
};

/// Options of `taut unwrap`.
struct unwrap_options
{
    std::string input, output, pins, stats, picture, render, device, progress;
    io::surface_format format{};
    energy_kind energy{};
    boundary_kind boundary{};
    energy::weighting weights{};
    start_kind start{};
    boundary_spacing spacing{};
    solver_kind solver{};
    taut::precision precision{};
    taut::placement placement{};
    int iterations = solve::params{}.max_iterations;
    std::optional<double> tolerance; ///< none: the default, or where the map has settled
    double time_limit = std::numeric_limits<double>::infinity();
    std::optional<vec3> up, front; ///< of the render; guessed if not given
    bool cut = false;              ///< to a disk
    bool holes = false, no_overlap = false, quiet = false;
};

/// Declares the options; they are filled when the program's arguments are parsed.
void declare(const subcommand& app, unwrap_options& options);

/// Throws usage_error for options that do not fit together.
void check(const unwrap_options& options);

/// Parameters of the library, without initial coordinates and observer.
parameterize_params to_params(const unwrap_options& options);

/// Words for reports.
std::string to_string(energy_kind kind);
std::string to_string(solver_kind kind);
std::string to_string(taut::precision precision);
std::string describe_start(const unwrap_options& options);

} // namespace taut::tools
