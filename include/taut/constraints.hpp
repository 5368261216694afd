// SPDX-License-Identifier: MIT
#pragma once

/// Pins, springs, boundaries and slides.
#include <taut/impl/constrain/constraints.hpp>
#include <taut/impl/constrain/placement.hpp>
#include <taut/impl/constrain/slide.hpp>
