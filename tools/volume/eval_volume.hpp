// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "shared/exit_codes.hpp"

namespace taut::tools
{

/// Options of `taut eval`.
struct eval_volume_options
{
    std::string input, rest; ///< rest: empty, if there is none
    std::string picture, clip;
    bool json = false;
    int zone = 0; ///< of a SU2 file of several; 0: none
};

/// Measures a map of a volume, or of a planar mesh, and prints what it found. Throws as readers do.
exit_code evaluate_volume(const eval_volume_options& options);

} // namespace taut::tools
