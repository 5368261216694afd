// SPDX-License-Identifier: MIT
#include <taut/impl/core/map/session/map_session.ipp>
#include <taut/impl/core/map/session/session.ipp>
