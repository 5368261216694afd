// SPDX-License-Identifier: MIT
#pragma once

/// Makes manifold meshes of the soups that files hold.
#include <taut/impl/repair/repair_surface.hpp>
