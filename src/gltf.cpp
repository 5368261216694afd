// SPDX-License-Identifier: MIT
#include <taut/impl/gltf/images.ipp>
#include <taut/impl/gltf/read_gltf.ipp>
#include <taut/impl/gltf/write_gltf.ipp>
