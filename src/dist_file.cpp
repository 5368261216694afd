// SPDX-License-Identifier: MIT
#include <taut/impl/dist/entry_points/volume_pieces.ipp>
