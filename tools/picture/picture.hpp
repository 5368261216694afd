// SPDX-License-Identifier: MIT
#pragma once

/// Pictures of maps as pixels (class image) and SVG text. Encoding pixels to a file format is the caller's business.
#include <picture/layout_picture.hpp>
#include <picture/layout_svg.hpp>
#include <picture/render_picture.hpp>
#include <picture/side_by_side_svg.hpp>
#include <picture/symmetric_distortion.hpp>
