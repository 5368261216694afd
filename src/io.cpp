// SPDX-License-Identifier: MIT
// The bodies of io/ for the compiled form.
#include <taut/io/detail/cut_seams.ipp>
#include <taut/io/detail/read_surface.ipp>
#include <taut/io/detail/volume/read_volume.ipp>
#include <taut/io/detail/volume/subdivided.ipp>
#include <taut/io/detail/volume/volume_file.ipp>
#include <taut/io/detail/volume/write_volume.ipp>
#include <taut/io/detail/write_files.ipp>
#include <taut/io/detail/write_obj.ipp>

template taut::io::corner_simplices<taut::tetrahedron> taut::io::corner_simplices_of(const volume_file&,
                                                                                     std::span<const taut::idx>);
template taut::io::corner_simplices<taut::triangle> taut::io::corner_simplices_of(const volume_file&,
                                                                                  std::span<const taut::idx>);
