// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <nanobind/nanobind.h>

#include <taut/certify.hpp>
#include <taut/parameterize.hpp>
#include <taut/quality.hpp>
#include <taut/session.hpp>

#include "arrays.hpp"

namespace taut::python
{

inline nb::str text(std::string_view s)
{
    return nb::str(s.data(), s.size());
}

nb::list texts(const std::vector<std::string>& all);
nb::list stages_of(const std::vector<stage_report>& stages);
nb::dict dict_of(const certificate& c);
nb::dict dict_of(const shape_quality& q);

const char* word_of(outcome o);

/// What taut._results.Map is made of, without coordinates.
nb::dict dict_of(const map_report& r);
nb::dict dict_of(const session_report& r);

template <class Element>
nb::dict dict_of(untangle_result<Element> r)
{
    nb::dict d;
    d["outcome"] = r.outcome == outcome::valid ? "valid" : r.outcome == outcome::infeasible ? "infeasible" : "gave_up";
    d["reason"] = text(r.reason);
    d["ids"] = array_of(r.ids);
    d["converged"] = bool(r);
    d["stop"] = text(r ? r.stage : std::string(to_string(r.outcome)));
    std::vector<stage_report> stages(r.stages.begin(), r.stages.end());
    d["stages"] = stages_of(stages);
    d["flips"] = dict_of(r.flips);
    d["seconds"] = r.seconds;
    d["x"] = array_of<Element::dimension>(std::move(r.map));
    return d;
}

} // namespace taut::python
