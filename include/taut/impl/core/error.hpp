// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace taut
{

/// Base of every exception that the library throws. Each layer derives its own, with data: mesh_error, io_error,
/// no_device, build_error, ... Numerical stops are results, never exceptions.
class error : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

/// Error of a parameter outside its domain. field() names it as the user wrote it.
class parameter_error : public error
{
public:
    parameter_error(std::string field, const std::string& remedy);

    const std::string& field() const noexcept { return field_; }

private:
    std::string field_;
};

/// Error of an input with more parts than 32-bit indices can number.
class size_error : public parameter_error
{
public:
    using parameter_error::parameter_error;
};

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/core/error.ipp>
#endif
