// SPDX-License-Identifier: MIT
#include <taut/map/parameterization.hpp>
#include <taut/map/parameterize.hpp>
