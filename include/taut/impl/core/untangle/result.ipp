// SPDX-License-Identifier: MIT
#pragma once

#include <ostream>

#include <taut/untangle.hpp>

namespace taut
{

template <class Element>
std::ostream& operator<<(std::ostream& out, const untangle_result<Element>& r)
{
    out << (r ? "injective" : to_string(r.outcome));
    if (!r) return out << ": " << r.reason;
    return out << ", by " << r.stage;
}

template std::ostream& operator<<(std::ostream& out, const untangle_result<triangle>& r);

template std::ostream& operator<<(std::ostream& out, const untangle_result<tetrahedron>& r);

} // namespace taut
