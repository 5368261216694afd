// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/mesh/describe.hpp>

namespace taut::impl
{

/// Error of points at which the interpolation system is singular. ids() holds them in pairs, as they were given.
class rbf_error : public error
{
public:
    rbf_error(std::vector<idx> ids, const std::string& what, const std::string& remedy)
        : error(what + impl::list_ids("pair", "pairs", ids, 2) + remedy), ids_(std::move(ids))
    {
    }
    const std::vector<idx>& ids() const noexcept { return ids_; }

private:
    std::vector<idx> ids_;
};

} // namespace taut::impl
