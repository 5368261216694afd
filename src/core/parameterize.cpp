// SPDX-License-Identifier: MIT
#include <taut/impl/core/map/mapped.ipp>
#include <taut/impl/core/map/parameterize.ipp>
