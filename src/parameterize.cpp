// SPDX-License-Identifier: MIT
#include <taut/map/detail/parameterize.ipp>
#include <taut/map/detail/session/map_session.ipp>
