// SPDX-License-Identifier: MIT
#pragma once

/// Maps of surfaces to the plane, certified to be injective.
#include <taut/impl/map/parameterize.hpp>
