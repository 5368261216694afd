// SPDX-License-Identifier: MIT
#include <taut/impl/io/detail/cut_seams.ipp>
#include <taut/impl/io/detail/read_surface.ipp>
#include <taut/impl/io/detail/write_files.ipp>
#include <taut/impl/io/detail/write_obj.ipp>
#include <taut/impl/io/volume/read_volume.ipp>
#include <taut/impl/io/volume/subdivided.ipp>
#include <taut/impl/io/volume/volume_file.ipp>
#include <taut/impl/io/volume/write_volume.ipp>
