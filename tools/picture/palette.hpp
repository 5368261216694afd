// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <string_view>

#include <picture/color.hpp>

namespace taut::io
{

/// The colour of constraints on a light ground: no colour scale here comes near it, and magenta is far.
inline constexpr rgb pin_color{0, 94, 190};

/// Colours of a picture besides its subject. The scale of distortions and magenta are the same on every ground, so that
/// pictures compare.
struct palette
{
    rgb ground{255, 255, 255};
    rgb ink{38, 42, 50};        ///< titles, outlines, numbers
    rgb soft_ink{94, 100, 112}; ///< captions
    rgb pin = pin_color;
    double lightness = 0.985; ///< OKLab, of the ground of renderings at the top
    double fall = 0.06;       ///< by so much it is darker at the bottom

    friend bool operator==(const palette&, const palette&) = default;
};

/// Light letters on a dark ground, for pages that are dark themselves.
inline constexpr palette dark_palette{.ground = {22, 25, 31},
                                      .ink = {226, 230, 238},
                                      .soft_ink = {160, 167, 180},
                                      .pin = {64, 148, 255},
                                      .lightness = 0.26,
                                      .fall = 0.05};

/// The palette that the user wishes: dark where the environment has TAUT_THEME=dark.
inline palette wished_palette()
{
    const char* theme = std::getenv("TAUT_THEME");
    return theme != nullptr && std::string_view(theme) == "dark" ? dark_palette : palette{};
}

} // namespace taut::io
