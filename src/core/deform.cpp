// SPDX-License-Identifier: MIT
#include <taut/impl/core/map/deform.ipp>
#include <taut/impl/core/map/deform_refined.ipp>
#include <taut/impl/core/map/session/shape_session.ipp>
#include <taut/impl/core/map/smooth.ipp>
