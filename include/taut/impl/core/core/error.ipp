// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>

#include <taut/errors.hpp>

namespace taut
{

parameter_error::parameter_error(std::string field, const std::string& remedy)
    : error("parameter " + field + ": " + remedy), field_(std::move(field))
{
}

} // namespace taut
