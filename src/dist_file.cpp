// SPDX-License-Identifier: MIT
#include <taut/impl/dist/detail/volume_pieces.ipp>
