// SPDX-License-Identifier: MIT
#include <taut/impl/edit/feature.ipp>
#include <taut/impl/edit/feature_map.ipp>
#include <taut/impl/edit/geodesic_distances.ipp>
#include <taut/impl/edit/parameterize_feature.ipp>
#include <taut/impl/edit/paste.ipp>
#include <taut/impl/edit/rbf.ipp>
#include <taut/impl/edit/region.ipp>
#include <taut/impl/edit/tessellate.ipp>
