// SPDX-License-Identifier: MIT
#define TAUT_IMPLEMENTATION // here, and in no other file
#include <taut/taut.hpp>
