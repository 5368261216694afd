// SPDX-License-Identifier: MIT
#include <taut/impl/charts/atlas/charts.ipp>
#include <taut/impl/charts/atlas/make_atlas.ipp>
#include <taut/impl/charts/atlas/segment.ipp>
#include <taut/impl/charts/atlas/symmetry/find_symmetry.ipp>
