// SPDX-License-Identifier: MIT
#pragma once

/// Packs charts into tiles, and certifies packings of any packer.
#include <taut/impl/packing/certificate.hpp>
#include <taut/impl/packing/chart_overlaps.hpp>
#include <taut/impl/packing/pack.hpp>
