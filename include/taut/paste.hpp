// SPDX-License-Identifier: MIT
#pragma once

/// Cut and paste: regions, features, and surfaces joined without a seam.
#include <taut/impl/edit/feature.hpp>
#include <taut/impl/edit/feature_map.hpp>
#include <taut/impl/edit/geodesic_distances.hpp>
#include <taut/impl/edit/paste.hpp>
#include <taut/impl/edit/rbf.hpp>
#include <taut/impl/edit/region.hpp>
#include <taut/impl/edit/self_intersections.hpp>
#include <taut/impl/edit/write_feature_map.hpp>
#include <taut/impl/edit/write_paste.hpp>
