// SPDX-License-Identifier: MIT
#pragma once

#include "precompiled.hpp"

#include <taut/compute/detail/opencl.hpp>
