// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include <taut/atlas.hpp>
#include <taut/surface_file.hpp>

#include "shared/text_table.hpp"

namespace taut::tools
{

/// Measures of texture coordinates as an atlas, all at one common scale.
struct atlas_measures
{
    atlas_report report;     ///< without a certificate and places
    double overlap_area = 0; ///< part of the images' area that lies on others: 1 - area of their union / sum of theirs
};

/// Measures the charts of texture coordinates. Overlaps are sampled at 2048 x 2048 points. Nothing if the surface is no
/// oriented manifold, or a triangle has no area.
/// cut: the surface cut open along seams; nullptr if there are none
std::optional<atlas_measures> measure_atlas(const io::surface_file& file, const io::cut_surface* cut);

/// The member "atlas" of `taut eval --json`.
nlohmann::ordered_json to_json(const atlas_measures& m);

void describe(labelled_lines& lines, const atlas_measures& m);

} // namespace taut::tools
