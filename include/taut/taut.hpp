// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_DEFORM
#define TAUT_PART_VOLUME_FILE
#endif
#ifndef TAUT_TAUT_HPP
#define TAUT_TAUT_HPP

/// Maps of meshes: reading, constraints, maps, certificates, measures, writing. Headers that need other libraries or
/// have their own subject are separate: <taut/atlas.hpp>, <taut/pack.hpp>, <taut/repair.hpp>,
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

#endif
#include <taut/impl/leave.inl>
