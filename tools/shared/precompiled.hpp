// SPDX-License-Identifier: MIT
#pragma once

/// What most files of the programs include.
#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <taut/taut.hpp>

#include <taut/gltf.hpp>
#include <taut/impl/core/compute/record.hpp>
