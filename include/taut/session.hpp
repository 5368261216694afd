// SPDX-License-Identifier: MIT
#pragma once

/// Interactive sessions: pins are dragged, the map follows.
#include <taut/impl/map/session.hpp>
