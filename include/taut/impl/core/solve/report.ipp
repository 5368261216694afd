// SPDX-License-Identifier: MIT
#pragma once

#include <locale>
#include <ostream>
#include <sstream>

#include <taut/solve_params.hpp>

namespace taut::solve
{

std::ostream& operator<<(std::ostream& stream, const report& r)
{
    std::ostringstream line; // so that the user's stream keeps its format, and its locale has no say
    line.imbue(std::locale::classic());
    line.precision(4);
    line << "stop: " << r.stop << ", " << r.iterations << (r.iterations == 1 ? " iteration" : " iterations") << ", E "
         << r.value_start << " -> " << r.value;
    return stream << line.str();
}

} // namespace taut::solve
