// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>

#include <taut/impl/core/mesh/cell_corners.hpp>
#include <taut/volume_file.hpp>

#include "untangle/untangle_report.hpp"
#include "volume/group_targets.hpp"
#include "volume/volume_case.hpp"
#include "volume/written_shape.hpp"

namespace taut::tools
{

/// Untangles the mesh of a volume file: towards its shape at rest, or regular elements.
template <class Element>
untangle_problem<Element> problem_of(const volume_case<Element>& input, const untangle_options& options,
                                     untangle_report& report)
{
    const auto& m = input.simplices();
    auto x = input.points();
    constraints<Element> pins(m);
    group_targets groups(input.file());
    for (const auto& name : options.fixed) groups.fix(name);
    held_by_file held(input.file());
    groups.pin(pins, held);
    if (!options.pins.empty()) pins.add(held(input.read_pins(options.pins)));
    report.pin_rounding = held.largest();
    if (!input.file().turned.empty()) report.notes.push_back(turned_note(input.file()));
    if (auto note = held.note(); !note.empty()) report.notes.push_back(std::move(note));
    if (!options.pins.empty() && pins.pins().size() == groups.all().size() && pins.springs().empty())
        report.notes.push_back(options.pins + ": has no pins besides --fix");
    if (!pins.springs().empty()) report.notes.push_back("untangling ignores springs");
    const bool named = !options.fixed.empty() || !options.pins.empty();
    if (options.boundary == untangle_boundary::fixed || (options.boundary == untangle_boundary::automatic && !named))
        for (const auto& facet : impl::boundary_facets(m, input.owners()))
            for (const idx v : facet)
                if (pins.held(v) == 0) pins.pin(v, x[static_cast<std::size_t>(v)]);
    auto problem = make_untangle_problem(m, std::move(x), pins);
    if (input.file().rest.empty()) problem.wanted = input.parts().regular;
    problem.owners = input.owners();
    return problem;
}

} // namespace taut::tools
