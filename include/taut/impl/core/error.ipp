// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include <taut/impl/core/error.hpp>

namespace taut
{

parameter_error::parameter_error(std::string field, const std::string& remedy)
    : error("parameter " + field + ": " + remedy), field_(std::move(field))
{
}

} // namespace taut
