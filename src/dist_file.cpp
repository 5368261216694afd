// SPDX-License-Identifier: MIT
#include <taut/impl/dist/entry_points/volume_pieces.ipp>
#include <taut/impl/processes/curve_order.ipp>
#include <taut/impl/processes/homes.ipp>
