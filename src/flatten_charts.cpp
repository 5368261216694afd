// SPDX-License-Identifier: MIT
#include <taut/impl/atlas/flatten_charts.ipp>
