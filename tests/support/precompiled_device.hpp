// SPDX-License-Identifier: MIT
#pragma once

#include "precompiled.hpp"
