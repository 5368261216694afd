// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include <taut/queue.hpp>
#include <taut/surface_file.hpp>

#include "view/subject.hpp"

namespace taut::view
{

/// The part of another surface that is pasted.
struct pasted
{
    std::string source; ///< its file; empty: none
    idx at = 0, onto = 0;
    double radius = 0;
    double scale = 1;
    idx triangles = 0; ///< of its tessellation from its map; 0: as it is
};

/// Source of a subject: files and options.
struct source
{
    std::string path;
    io::surface_format format = io::surface_format::automatic;
    std::string pins; ///< a file, or empty
    bool holes = false;
    bool shell = false; ///< a surface deforms in space, and is not mapped
    pasted feature;
    int zone = 0; ///< of a SU2 file of several; 0: none
};

/// A map of the surface of a file, that surface as a shell, or the shape of a volume file or planar mesh, with its
/// first map or shape. Throws as readers do; unsuitable_input, error where there is no valid first one.
std::unique_ptr<subject> make_subject(queue& q, const source& from);

/// A feature on the surface of a file. Throws as readers do; region_error, paste_error.
std::unique_ptr<subject> make_paste_subject(queue& q, const source& from);

} // namespace taut::view
