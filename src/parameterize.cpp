// SPDX-License-Identifier: MIT
#include <taut/impl/map/mapped.ipp>
#include <taut/impl/map/parameterize.ipp>
