// SPDX-License-Identifier: MIT
#include <taut/gltf/detail/read_gltf.ipp>
#include <taut/gltf/detail/write_gltf.ipp>
