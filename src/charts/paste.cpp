// SPDX-License-Identifier: MIT
#include <taut/impl/charts/paste/feature.ipp>
#include <taut/impl/charts/paste/feature_map.ipp>
#include <taut/impl/charts/paste/geodesic_distances.ipp>
#include <taut/impl/charts/paste/parameterize_feature.ipp>
#include <taut/impl/charts/paste/paste.ipp>
#include <taut/impl/charts/paste/rbf.ipp>
#include <taut/impl/charts/paste/region.ipp>
#include <taut/impl/charts/paste/tessellate.ipp>
