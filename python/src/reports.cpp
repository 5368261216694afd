// SPDX-License-Identifier: MIT
#include "reports.hpp"

#include <taut/impl/core/solve/stop.hpp>

namespace taut::python
{

nb::list texts(const std::vector<std::string>& all)
{
    nb::list list;
    for (const auto& s : all) list.append(text(s));
    return list;
}

nb::list stages_of(const std::vector<stage_report>& stages)
{
    nb::list list;
    for (const stage_report& s : stages)
    {
        nb::dict d;
        d["stage"] = text(s.stage);
        d["level"] = s.level;
        d["vertices"] = s.vertices;
        d["iterations"] = s.iterations;
        d["energy_before"] = s.energy_before;
        d["energy_after"] = s.energy_after;
        d["seconds"] = s.seconds;
        d["stop"] = text(s.stop);
        d["steps_cut"] = s.steps_cut;
        d["cut_by"] = array_of(s.cut_by);
        d["step_median"] = s.step_median;
        list.append(d);
    }
    return list;
}

nb::dict dict_of(const certificate& c)
{
    nb::dict d;
    d["elements"] = c.elements;
    d["flipped_count"] = c.flipped;
    d["flipped"] = array_of(c.ids);
    d["branch_count"] = c.branched;
    d["branch_points"] = array_of(c.branch_ids);
    d["min_det"] = c.min_det;
    d["max_det"] = c.max_det;
    return d;
}

nb::dict dict_of(const shape_quality& q)
{
    nb::dict d;
    d["mean_ratio"] = q.mean_ratio;
    d["scaled_jacobian"] = q.scaled_jacobian;
    d["worst_mean_ratio"] = q.worst.mean_ratio;
    d["worst_scaled_jacobian"] = q.worst.scaled_jacobian;
    d["min_angle"] = q.worst.min_angle;
    d["max_angle"] = q.worst.max_angle;
    d["worst_ids"] = array_of(q.worst_ids);
    return d;
}

const char* word_of(outcome o)
{
    switch (o)
    {
    case outcome::valid:
        return "valid";
    case outcome::no_valid_start:
        return "no_valid_start";
    case outcome::stopped:
        return "stopped";
    case outcome::infeasible:
        return "infeasible";
    case outcome::gave_up:
        return "gave_up";
    }
    return "unknown";
}

nb::dict dict_of(const map_report& r)
{
    nb::dict d;
    d["outcome"] = word_of(r.outcome);
    d["reason"] = text(r.reason);
    d["ids"] = array_of(r.ids);
    d["notes"] = texts(r.notes);
    d["converged"] = solve::impl::converged(r.solve.stop);
    d["stop"] = text(to_string(r.solve.stop));
    d["energy"] = r.solve.value;
    d["iterations"] = r.solve.iterations;
    d["scale"] = r.scale;
    d["concave"] = array_of(r.concave);
    d["stages"] = stages_of(r.stages);
    d["flips"] = dict_of(r.flips);
    const map_seconds& s = r.seconds;
    d["seconds"] = s.device + s.setup + s.hierarchy + s.start + s.untangle + s.solve + s.overlap;
    if (r.overlap) d["overlaps"] = r.overlap->crossings;
    return d;
}

nb::dict dict_of(const session_report& r)
{
    nb::dict d;
    d["outcome"] = word_of(r.outcome);
    d["reason"] = text(r.reason);
    d["ids"] = array_of(r.ids);
    d["notes"] = texts(r.notes);
    d["converged"] = r.converged;
    d["stopped"] = r.stopped;
    d["stop"] = r.converged ? "converged" : r.stopped ? "stopped" : "stuck";
    d["pins_held"] = r.pins_held;
    d["farthest"] = r.farthest;
    d["distance"] = r.distance;
    d["energy"] = r.energy;
    d["gradient"] = r.gradient;
    d["iterations"] = r.steps;
    d["flips"] = dict_of(r.flips);
    d["stages"] = stages_of(r.stages);
    d["seconds"] = r.seconds.total();
    return d;
}

} // namespace taut::python
