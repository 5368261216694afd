// SPDX-License-Identifier: MIT
#include <taut/impl/charts/atlas/flatten_charts.ipp>
