// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/exact/certify.hpp>
#include <taut/mesh/describe.hpp>

namespace taut
{

/// What keeps a map from being locally injective, with the first ids; "no defect" if nothing does.
template <class Element>
std::string describe_defects(const certificate& c)
{
    std::string text;
    if (c.flipped > 0) text = detail::list_first_ids(Element::name, Element::names, c.flipped, c.ids) + " flipped";
    if (c.branched > 0)
    {
        text += text.empty() ? "" : ", and ";
        if constexpr (Element::dimension == 2)
            text += detail::list_first_ids("vertex", "vertices", c.branched, c.branch_ids) +
                    " that the map winds around more than once";
        else
            text += detail::list_first_ids("edge", "edges", c.branched, c.branch_ids, 2) +
                    " that tetrahedra go around more than once";
    }
    return text.empty() ? "no defect" : text;
}

} // namespace taut
