// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include <taut/compute/queue.hpp>
#include <taut/io/read_surface.hpp>

#include "subject.hpp"

namespace taut::view
{

/// What is to be seen.
struct source
{
    std::string path;
    io::surface_format format = io::surface_format::automatic;
    std::string pins; ///< a file, or empty
    bool holes = false;
};

/// A map of the surface of a file, or the shape of a volume file or planar mesh, with its first map or shape. Throws as
/// readers do; unsuitable_input, error where there is no valid first one.
std::unique_ptr<subject> make_subject(queue& q, const source& from);

} // namespace taut::view
