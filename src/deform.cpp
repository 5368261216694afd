// SPDX-License-Identifier: MIT
#include <taut/impl/map/session/shape_session.ipp>
