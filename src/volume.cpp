// SPDX-License-Identifier: MIT
#include <taut/impl/objective/volume_objective.ipp>
