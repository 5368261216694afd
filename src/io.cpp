// SPDX-License-Identifier: MIT
#include <taut/io/detail/cut_seams.ipp>
#include <taut/io/detail/read_surface.ipp>
#include <taut/io/detail/volume/read_volume.ipp>
#include <taut/io/detail/volume/subdivided.ipp>
#include <taut/io/detail/volume/volume_file.ipp>
#include <taut/io/detail/volume/write_volume.ipp>
#include <taut/io/detail/write_files.ipp>
#include <taut/io/detail/write_obj.ipp>
