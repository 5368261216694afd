// SPDX-License-Identifier: MIT
#pragma once

#include "precompiled.hpp"

#include <taut/impl/compute/opencl.hpp>
