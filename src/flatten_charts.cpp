// SPDX-License-Identifier: MIT
// flatten_charts() for the compiled form.
#include <taut/atlas/flatten_charts.hpp>

#include <taut/atlas/detail/flatten_charts.ipp>
