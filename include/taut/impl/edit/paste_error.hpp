// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/error.hpp>

namespace taut
{

/// Error of a feature that cannot be placed on a surface. what() has the reason and the remedy.
class paste_error : public error
{
public:
    using error::error;
};

} // namespace taut
