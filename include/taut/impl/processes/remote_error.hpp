// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/impl/core/error.hpp>

namespace taut::dist
{

/// Error of another process of a communicator. Where one process of a collective call fails, it throws its own error,
/// and all others throw this one, with the same text.
class remote_error : public error
{
public:
    remote_error(int rank, const std::string& what) : error(what), rank_(rank) {}

    /// The process that failed, in the numbers of the communicator.
    int rank() const noexcept { return rank_; }

private:
    int rank_;
};

/// Error of MPI or PETSc, whose text what() has.
class backend_error : public error
{
public:
    using error::error;
};

} // namespace taut::dist
