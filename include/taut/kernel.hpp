// SPDX-License-Identifier: MIT
#pragma once

/// Kernels of your own: recorded from C++ with traced scalars, or in OpenCL C.
#include <taut/impl/compute/event.hpp>
#include <taut/impl/compute/handler.hpp>
#include <taut/impl/compute/kernel.hpp>
#include <taut/impl/compute/record.hpp>
#include <taut/impl/compute/reductions.hpp>
#include <taut/impl/symbolic/cast.hpp>
#include <taut/impl/symbolic/differentiate.hpp>
#include <taut/impl/symbolic/glm.hpp>
#include <taut/impl/symbolic/loop.hpp>
#include <taut/impl/symbolic/math.hpp>
#include <taut/impl/symbolic/recording.hpp>
