// SPDX-License-Identifier: MIT
#pragma once

/// The same mesh with better shaped elements.
#include <taut/impl/map/smooth.hpp>
