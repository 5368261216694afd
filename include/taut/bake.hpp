// SPDX-License-Identifier: MIT
#pragma once

/// Textures of one atlas made for another one of the same surface.
#include <taut/impl/bake/bake.hpp>
#include <taut/impl/bake/compare_textures.hpp>
#include <taut/impl/bake/tangent_frames.hpp>
#include <taut/impl/bake/texture.hpp>
