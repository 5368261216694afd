// SPDX-License-Identifier: MIT
#pragma once

/// Measures of maps and of meshes.
#include <taut/impl/energy/distortion.hpp>
#include <taut/impl/measure/quality.hpp>
#include <taut/impl/measure/shape_quality.hpp>
#include <taut/impl/measure/singular_values.hpp>
