// SPDX-License-Identifier: MIT
#include <taut/impl/dist/file/volume_pieces.ipp>
