// SPDX-License-Identifier: MIT
#include <taut/atlas/detail/flatten_charts.ipp>
