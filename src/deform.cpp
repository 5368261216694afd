// SPDX-License-Identifier: MIT
#include <taut/map/detail/session/shape_session.ipp>
