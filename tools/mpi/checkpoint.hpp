// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <taut/dist.hpp>
#include <taut/impl/dist/file/ranged_volume.hpp>
#include <taut/impl/io/volume_file.hpp>

#include "mpi/mpi_options.hpp"

namespace taut::tools::mpi
{

/// The shape so far in a mesh file, for a run that may be ended from outside. All functions are collective.
class checkpoint
{
public:
    /// volume: the input, if that was read by ranges; else file: as process 0 read it, of the others null. All are
    /// referred to.
    checkpoint(const dist::impl::communicator& all, const mpi_options& options, const dist::impl::ranged_volume* volume,
               const io::volume_file* file)
        : all_(all), options_(options), volume_(volume), file_(file)
    {
    }

    /// The shape that is there, one position per vertex of the pieces; nothing where there is none. Throws
    /// unsuitable_input where that is another mesh, io_error.
    std::vector<vec3> read() const;

    /// Brings a session to its end as solve() does, and writes the shape each time that the interval is over.
    dist::result<tetrahedron> solve(dist::session<tetrahedron>& session,
                                    const std::function<run_limits()>& limits_left) const;

    /// After the result is written.
    void remove() const;

private:
    void write(const std::vector<vec3>& x) const;

    const dist::impl::communicator& all_;
    const mpi_options& options_;
    const dist::impl::ranged_volume* volume_;
    const io::volume_file* file_;
};

} // namespace taut::tools::mpi
