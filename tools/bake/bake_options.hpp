// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <utility>

#include <taut/bake.hpp>
#include <taut/surface_file.hpp>

#include "bake/model_textures.hpp"
#include "shared/options.hpp"

namespace taut::tools
{

/// Options of `taut bake`.
struct bake_options
{
    std::string before, after, texture, output, difference, stats, device, size;
    io::surface_format format{};
    texture_content content = texture_content::colour;
    texture::filter filter = texture::filter::bilinear;
    texture::wrap wrap = texture::wrap::repeat;
    int samples = 1, bits = 0;                   ///< bits: 0: as the old texture
    int texcoord_set = 0, new_texcoord_set = -1; ///< of glTF; -1: the same
    double gutter = bake_params{}.gutter;
    bool colours_of_vertices = false, green_down = false, quiet = false;

    std::function<bool(const std::string&)> given; ///< whether an option was given

    /// Whether the textures of a model are made anew in the model.
    bool of_model() const { return texture.empty() && !colours_of_vertices; }
};

/// Declares the options; they are filled when the program's arguments are parsed.
void declare(const subcommand& app, bake_options& options);

/// Throws usage_error for options that do not fit together.
void check(const bake_options& options);

/// Parameters of the library.
bake_params to_params(const bake_options& options);

} // namespace taut::tools
