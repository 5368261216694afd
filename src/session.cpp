// SPDX-License-Identifier: MIT
#include <taut/impl/map/session/incremental_loading.ipp>
#include <taut/impl/map/session/map_session.ipp>
#include <taut/impl/map/session/session_run.ipp>
#include <taut/impl/map/session/shape_setup.ipp>
#include <taut/impl/objective/running_map.ipp>
