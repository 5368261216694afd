// SPDX-License-Identifier: MIT
#include <taut/impl/core/objective/volume_objective.ipp>
