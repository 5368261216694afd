// SPDX-License-Identifier: MIT
#include <taut/impl/dist/processes/curve_order.ipp>
#include <taut/impl/dist/processes/homes.ipp>
#include <taut/impl/dist/shape/entry_points/volume_pieces.ipp>
