// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/certify.hpp>
#include <taut/constraints.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>
#include <taut/surface_file.hpp>

#include "shared/failure.hpp"

namespace taut::tools
{

/// Options of `taut check`.
struct check_options
{
    std::string input, pins;
    std::optional<io::surface_format> format; ///< nothing: a problem
    bool json = false;
    int zone = 0; ///< of a SU2 file of several; 0: none
};

/// One thing that is wrong, or at least worth knowing.
struct finding
{
    bool wrong = true;
    std::string about; ///< "file", "mesh", "pins" or "feasibility"
    std::string fault; ///< a word for programs
    std::vector<idx> ids;
    std::string message;
    std::string repair = {}; ///< what --repair does about it; empty: nothing
};

/// Everything that `taut check` has to say.
struct check_report
{
    std::string kind; ///< of the input: "surface", "problem of triangles", ...
    std::size_t vertices = 0, cells = 0;
    std::string cells_name = triangle::names;
    std::size_t pins = 0, springs = 0;
    certificate map; ///< of a problem's initial map, or of the corners of a volume's cells
    bool has_map = false;
    std::vector<std::pair<std::string, std::string>> lines;            ///< more of a volume, for people, a label each
    nlohmann::ordered_json details = nlohmann::ordered_json::object(); ///< and for programs
    std::vector<finding> findings;
    exit_code code = exit_code::valid;

    /// The code is that of the most basic fault: unreadable, then unsuitable, then infeasible.
    void add(finding f, exit_code meaning)
    {
        if (f.wrong && (code == exit_code::valid || to_int(meaning) < to_int(code))) code = meaning;
        findings.push_back(std::move(f));
    }
};

inline void report_mesh(check_report& report, const mesh_finding& f, bool wrong, const std::string& repair = {})
{
    const bool holes = f.fault == mesh_error::several_boundaries;
    report.add(
        {wrong, "mesh", to_string(f.fault), f.ids, f.message + (holes ? ", or `taut unwrap --holes`" : ""), repair},
        code_of(f.fault));
}

template <class Element>
void report_pins(check_report& report, const constraint_error& e, const io::pin<Element::dimension>* pin = nullptr)
{
    const std::string where = pin ? "the pin of vertex " + std::to_string(pin->vertex) + ": " : "";
    report.add({true, "pins", to_string(e.fault()), e.ids(), where + e.what()}, exit_code::unsuitable_input);
}

} // namespace taut::tools
