// SPDX-License-Identifier: MIT
// The module taut._taut: what the package taut is made on. It is no interface of its own.
#include <nanobind/nanobind.h>

#include <taut/version.hpp>

#include "bindings.hpp"
#include "call.hpp"
#include "errors.hpp"
#include "queues.hpp"

NB_MODULE(_taut, m)
{
    using namespace taut::python;
    nanobind::set_leak_warnings(false); // energies in modules of users live to the end
    m.attr("version") = TAUT_VERSION_STRING;
    add_errors(m);
    add_control(m);
    add_devices(m);
    add_energies(m);
    add_maps(m);
    add_atlas(m);
    add_packing(m);
    add_bake(m);
    add_repair(m);
    add_volumes(m);
    add_shells(m);
    add_paste(m);
    add_sessions(m);
    add_evaluator(m);
    add_files(m);
}
