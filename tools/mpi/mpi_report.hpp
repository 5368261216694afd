// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/dist.hpp>

#include "mpi/mpi_options.hpp"
#include "mpi/traffic.hpp"
#include "volume/volume_case.hpp"

namespace taut::tools::mpi
{

/// What one process has to say of itself: numbers alone, as it is sent.
struct process_numbers
{
    dist::impl::phase_seconds seconds;
    double processor = 0; ///< seconds of all its threads
    double read = 0, write = 0;
    std::uint64_t peak_memory = 0, device_bytes = 0;
    std::int64_t own_vertices = 0, halo_vertices = 0, cells = 0;
    traffic distributed, solved; ///< until the mesh was distributed, and from then on
};

/// Everything that a run has to say; complete on the first process.
struct mpi_report
{
    dist::report run;
    std::string format, cells, device;
    std::string read_whole;              ///< why process 0 read the input as a whole; empty: all read it by ranges
    const char* element = "tetrahedron"; ///< a word
    bool mixed = false;                  ///< there are cells other than simplices
    int dimension = 3;
    std::size_t vertices = 0, elements = 0, pins = 0, springs = 0;
    volume_state before, after;
    std::vector<process_numbers> processes;
    struct
    {
        double read = 0, distribute = 0, solve = 0, total = 0;
    } seconds;
};

nlohmann::ordered_json to_json(const mpi_report& report, const mpi_options& options);

/// The table for people; notes go to standard error at once.
std::string text_of(const mpi_report& report, const mpi_options& options);

} // namespace taut::tools::mpi
