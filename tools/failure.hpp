// SPDX-License-Identifier: MIT
#pragma once

#include <taut/core/error.hpp>

namespace taut::tools
{

/// The command line asks for something impossible. what() names the option and the remedy.
class usage_error : public error
{
public:
    using error::error;
};

/// The file holds no map that could be used.
class unsuitable_input : public error
{
public:
    using error::error;
};

/// No map without flips was found.
class no_valid_map : public error
{
public:
    using error::error;
};

/// A result could not be written, say because the disk is full.
class output_error : public error
{
public:
    using error::error;
};

} // namespace taut::tools
