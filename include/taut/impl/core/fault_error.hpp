// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/error.hpp>
#include <taut/impl/core/types.hpp>

namespace taut::impl
{

/// Error of a fault, a value of an enumeration, and of the ids that it concerns, from 0. what() names the first ids and
/// the remedy.
template <class Fault>
class fault_error : public error
{
public:
    using fault_type = Fault;

    fault_error(Fault fault, std::vector<idx> ids, const std::string& message)
        : error(message), fault_(fault), ids_(std::move(ids))
    {
    }

    Fault fault() const noexcept { return fault_; }
    const std::vector<idx>& ids() const noexcept { return ids_; }

private:
    Fault fault_;
    std::vector<idx> ids_;
};

} // namespace taut::impl
