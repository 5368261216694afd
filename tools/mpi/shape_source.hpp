// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <taut/dist.hpp>
#include <taut/files.hpp>
#include <taut/impl/dist/processes/communicator.hpp>
#include <taut/impl/dist/ranges/ranged_volume.hpp>

#include "mpi/mpi_options.hpp"
#include "mpi/mpi_report.hpp"

namespace taut::tools::mpi
{

/// The mesh of a run, its constraints, and its way back into files. All functions are collective.
template <class Element>
class shape_source
{
public:
    using points = std::vector<vec<Element::dimension>>; ///< one per vertex of the piece

    virtual ~shape_source() = default;

    dist::mesh_piece<Element> piece;
    dist::constraints<Element> pins;
    std::vector<std::int64_t> fixed; ///< vertices of groups that are held, for smoothing
    dist::impl::labelled_cells kept; ///< regions of cells and labelled faces that smoothing keeps; or none
    std::int64_t first_region = 0;   ///< the number of the first of these among the owners of the piece
    points initial;                  ///< the shape to begin with, if it is not that at rest; empty: it is
    std::vector<std::string> notes;  ///< of process 0
    bool mixed = false;              ///< there are cells other than simplices

    /// Regions of the cells of a piece of this source.
    std::vector<std::int64_t> regions_of(const dist::mesh_piece<Element>& of) const
    {
        std::vector<std::int64_t> regions;
        for (std::size_t c = 0; c < of.cells.size() && !kept.regions.empty(); ++c)
        {
            const auto cell = of.owners.empty() ? static_cast<std::int64_t>(c) : of.owners[c] - first_region;
            regions.push_back(kept.regions[static_cast<std::size_t>(cell)]);
        }
        return regions;
    }

    /// Cells of this process, by its own numbers, that are not known to be valid.
    virtual std::vector<idx> doubtful(const points& x) const = 0;

    /// The cells of the piece with the tetrahedra at the edges of some cells of doubtful(), ascending.
    virtual dist::mesh_piece<Element> edged(const std::vector<idx>& cells) const = 0;

    /// A mesh with the shape so far. Throws unsuitable_input where it is another one, io_error.
    virtual points read(const std::string& path) const = 0;
    virtual void write(const std::string& path, const points& x) const = 0;

    /// The files that write() makes, those of all processes.
    virtual std::vector<std::string> files_at(const std::string& path) const { return {path}; }

    /// Of process 0, once a report is complete: writes it, with further files that appear with it.
    using report_writer = std::function<void(std::vector<io::file_to_write>)>;

    /// Judges the shape as the output holds it, and writes both. Throws no_valid_map, output_error.
    virtual void finish(const points& x, mpi_report& report, const report_writer& write_report) = 0;
};

/// A volume that the processes read by ranges, or in its pieces; null where process 0 has to read it. Fills in what the
/// report says of the input.
std::unique_ptr<shape_source<tetrahedron>> ranged_source(const dist::impl::communicator& all, const mpi_options& o,
                                                         mpi_report& report);

/// What process 0 reads by itself, before anything is known of its dimension.
io::volume_file read_whole(const mpi_options& o);

/// A mesh that process 0 has read; the others give nothing.
template <class Element>
std::unique_ptr<shape_source<Element>> whole_source(const dist::impl::communicator& all, const mpi_options& o,
                                                    mpi_report& report, io::volume_file file);

} // namespace taut::tools::mpi
