// SPDX-License-Identifier: MIT
#pragma once

/// Pictures of maps as pixels (class image) and SVG text. Encoding pixels to a file format is the caller's business.
#include <taut/io/picture/layout_picture.hpp>
#include <taut/io/picture/layout_svg.hpp>
#include <taut/io/picture/render_picture.hpp>
#include <taut/io/picture/side_by_side_svg.hpp>
#include <taut/io/picture/symmetric_distortion.hpp>
