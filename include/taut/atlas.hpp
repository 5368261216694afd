// SPDX-License-Identifier: MIT
#pragma once

/// Atlases: a surface cut into charts, flattened, packed and certified.
#include <taut/impl/atlas/chart_mesh.hpp>
#include <taut/impl/atlas/cut_to_disk.hpp>
#include <taut/impl/atlas/flatten_charts.hpp>
#include <taut/impl/atlas/make_atlas.hpp>
#include <taut/impl/atlas/segment.hpp>
#include <taut/impl/atlas/symmetry.hpp>
