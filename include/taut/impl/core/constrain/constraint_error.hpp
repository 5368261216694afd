// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/mesh/describe.hpp>

namespace taut::impl
{

/// Throws if there are ids: "2 vertices (4, 7) <what>; <remedy>".
inline void refuse_vertices(constraint_fault fault, std::vector<idx> ids, const std::string& what)
{
    if (ids.empty()) return;
    const std::string message = list_ids("vertex", "vertices", ids) + ' ' + what;
    throw constraint_error(fault, std::move(ids), message);
}

} // namespace taut::impl
