// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include <taut/session.hpp>

#include "volume/refined_case.hpp"
#include "volume/shape_options.hpp"
#include "volume/volume_case.hpp"

namespace taut::tools
{

/// Everything that a run of `taut deform` or `taut smooth` has to say; the mesh itself aside, it knows no dimension.
struct deform_report
{
    session_report run;
    volume_state before, after;
    std::string format, cells, device;
    std::optional<refined_size> refined; ///< none: no element was split
    const char* element = "";            ///< a word
    std::size_t vertices = 0, elements = 0, pins = 0, springs = 0;
    double pin_rounding = 0; ///< by which pins were moved to where the file can hold them, at most
    int dimension = 3;
    bool mixed = false; ///< there are cells other than simplices
    struct
    {
        double read = 0, device = 0, solve = 0, total = 0;
    } seconds;

    /// Cells other than simplices have an inside to judge.
    bool has_insides() const { return mixed && dimension == 3; }
};

nlohmann::ordered_json to_json(const deform_report& report, const shape_options& options);

/// The table for people; notes go to standard error at once.
std::string text_of(const deform_report& report, const shape_options& options);

} // namespace taut::tools
