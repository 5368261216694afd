// SPDX-License-Identifier: MIT
#pragma once

/// Maps of meshes: all that reads, constrains, makes, judges and writes them. What needs other libraries or is a
/// subject of its own has a header beside this one: <taut/atlas.hpp>, <taut/pack.hpp>, <taut/repair.hpp>,
/// <taut/paste.hpp>, <taut/gltf.hpp>, <taut/eigen.hpp>, <taut/solve.hpp>, <taut/kernel.hpp>.
#include <taut/certify.hpp>
#include <taut/constraints.hpp>
#include <taut/deform.hpp>
#include <taut/energy.hpp>
#include <taut/errors.hpp>
#include <taut/mesh.hpp>
#include <taut/options.hpp>
#include <taut/parameterize.hpp>
#include <taut/quality.hpp>
#include <taut/queue.hpp>
#include <taut/read.hpp>
#include <taut/session.hpp>
#include <taut/smooth.hpp>
#include <taut/untangle.hpp>
#include <taut/version.hpp>
#include <taut/volume_file.hpp>
#include <taut/write.hpp>
