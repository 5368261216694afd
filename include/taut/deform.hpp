// SPDX-License-Identifier: MIT
#pragma once

/// Deformations of volumes, of shells and of meshes of the plane by pins.
#include <taut/impl/map/deform.hpp>
#include <taut/impl/map/deform_refined.hpp>
#include <taut/impl/map/interpolate.hpp>
#include <taut/impl/measure/rigid_motion.hpp>
