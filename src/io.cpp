// SPDX-License-Identifier: MIT
#include <taut/impl/io/atomic_file.hpp>
#include <taut/impl/io/file/file_target.ipp>
#if defined(__unix__) || defined(__APPLE__)
#include <taut/impl/io/file/posix_file.ipp>
#endif
#include <taut/impl/io/file/write_files.ipp>
#include <taut/impl/io/read_file.ipp>
#include <taut/impl/io/surface/cut_seams.ipp>
#include <taut/impl/io/surface/read_surface.ipp>
#include <taut/impl/io/surface/write_obj.ipp>
#include <taut/impl/io/volume/read_volume.ipp>
#include <taut/impl/io/volume/subdivided.ipp>
#include <taut/impl/io/volume/volume_file.ipp>
#include <taut/impl/io/volume/write_volume.ipp>
