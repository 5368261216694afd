// SPDX-License-Identifier: MIT
#pragma once

/// Models of glTF, of which all but texture coordinates stays as it is. Needs nlohmann-json.
#include <taut/impl/gltf/gltf.hpp>
