// SPDX-License-Identifier: MIT
#pragma once

#include <taut/errors.hpp>

#include "shared/exit_codes.hpp"

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

/// A signal came before there was a map without flips.
class interrupted_run : public error
{
public:
    using error::error;
};

/// It is proved that no map without flips exists.
class infeasible_problem : public error
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

/// A face that names a vertex which is not there, or a NaN, is a broken file rather than a difficult mesh.
inline exit_code code_of(mesh_error::fault_type fault)
{
    const bool broken = fault == mesh_error::index_out_of_range || fault == mesh_error::non_finite;
    return broken ? exit_code::unreadable_input : exit_code::unsuitable_input;
}

} // namespace taut::tools
