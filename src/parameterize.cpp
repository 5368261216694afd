// SPDX-License-Identifier: MIT
#include <taut/impl/map/parameterize.ipp>
#include <taut/impl/map/session/map_session.ipp>
