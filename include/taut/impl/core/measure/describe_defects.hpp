// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include <taut/certify.hpp>
#include <taut/impl/core/mesh/describe.hpp>

namespace taut::impl
{

/// Describes the defects of a map that is not locally injective, with the first ids; else "no defect". For elements
/// without orientation, as hinges, these are collapsed triangles. owners: where the elements are the corners of cells,
/// the cell of each.
template <class Element>
std::string describe_defects(const certificate& c, std::span<const idx> owners = {})
{
    std::string text;
    if (!Element::oriented)
    {
        if (c.flipped > 0)
            text = impl::list_first_ids(Element::facet_name, Element::facet_names, c.flipped, c.ids) + " collapsed";
    }
    else if (c.flipped > 0)
        text = impl::list_first_elements<Element>(c.flipped, c.ids, owners) + " flipped";
    if (c.branched > 0)
    {
        text += text.empty() ? "" : ", and ";
        if constexpr (Element::dimension == 2)
            text += impl::list_first_ids("vertex", "vertices", c.branched, c.branch_ids) +
                    " that the map winds around more than once";
        else
            text += impl::list_first_ids("edge", "edges", c.branched, c.branch_ids, 2) +
                    " that tetrahedra go around more than once";
    }
    return text.empty() ? "no defect" : text;
}

} // namespace taut::impl
