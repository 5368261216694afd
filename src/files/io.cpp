// SPDX-License-Identifier: MIT
#include <taut/files.hpp>
#include <taut/impl/files/file/file_target.ipp>
#include <taut/impl/files/file/read_file.ipp>
#include <taut/impl/files/file/write_files.ipp>
#include <taut/impl/files/surface/cut_seams.ipp>
#include <taut/impl/files/surface/pins.ipp>
#include <taut/impl/files/surface/prob.ipp>
#include <taut/impl/files/surface/read_surface.ipp>
#include <taut/impl/files/surface/write_obj.ipp>
#include <taut/impl/files/volume/make_untangle_problem.ipp>
#include <taut/impl/files/volume/new_volume.ipp>
#include <taut/impl/files/volume/read_volume.ipp>
#include <taut/impl/files/volume/subdivided.ipp>
#include <taut/impl/files/volume/volume_file.ipp>
#include <taut/impl/files/volume/write_volume.ipp>

#if defined(__unix__) || defined(__APPLE__)
#include <taut/impl/files/file/posix_file.ipp>
#endif
