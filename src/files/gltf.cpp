// SPDX-License-Identifier: MIT
#include <taut/impl/files/gltf/images.ipp>
#include <taut/impl/files/gltf/read_gltf.ipp>
#include <taut/impl/files/gltf/scene.ipp>
#include <taut/impl/files/gltf/write_gltf.ipp>
