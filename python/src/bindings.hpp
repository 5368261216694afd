// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <nanobind/nanobind.h>

#include <taut/parameterize.hpp>

#include "control.hpp"
#include "options.hpp"

namespace taut::python
{

/// What unwrap() and sessions of maps take. The mesh is to live as long as the parameters.
parameterize_params map_params(const options& given, const mesh<triangle>& m);

// Each adds what its file is about to the module.
void add_maps(nb::module_& m);
void add_atlas(nb::module_& m);
void add_packing(nb::module_& m);
void add_bake(nb::module_& m);
void add_repair(nb::module_& m);
void add_volumes(nb::module_& m);
void add_shells(nb::module_& m);
void add_paste(nb::module_& m);
void add_sessions(nb::module_& m);
void add_energies(nb::module_& m);
void add_evaluator(nb::module_& m);
void add_files(nb::module_& m);

} // namespace taut::python
