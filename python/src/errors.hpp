// SPDX-License-Identifier: MIT
#pragma once

#include <nanobind/nanobind.h>

namespace taut::python
{

/// Exceptions of the library become those of taut.errors, with their data.
void add_errors(nanobind::module_& m);

} // namespace taut::python
