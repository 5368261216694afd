// SPDX-License-Identifier: MIT
#include <taut/impl/charts/bake/bake.ipp>
#include <taut/impl/charts/bake/compare_textures.ipp>
#include <taut/impl/charts/bake/tangent_frames.ipp>
