// SPDX-License-Identifier: MIT
#include <taut/map/parameterization.hpp>
#include <taut/map/parameterize.hpp>
#include <taut/map/untangle/untangle.hpp>
#include <taut/map/untangle/untangle_on_device.hpp>
