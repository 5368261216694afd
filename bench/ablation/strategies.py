# SPDX-License-Identifier: MIT
"""The strategies of the library that can be taken out, each with the places where a switch is put in.

A place is (file below include/taut/impl, text that stands there once, text in its stead), in which {off} becomes the
question whether the strategy is switched off. It stands last in a condition, so that only what comes to the strategy
asks it. Texts that are not found, or more than once, end the run: then the library has changed, and the place must too.
"""


class Strategy:
    def __init__(self, name, what, *places):
        self.name, self.what, self.places = name, what, places


def stage(dimension, name, what):
    """A stage of untangling; all of them have one place, STAGES."""
    return Strategy(f"{dimension}D {name}", what)


STAGES = (
    "core/untangle/run_stages.hpp",
    "            if (exhausted[s]) continue;\n",
    "            if (exhausted[s]) continue;\n"
    "            if (::taut::impl::without((Element::dimension == 2 ? \"2D \" : \"3D \") +"
    " std::string(stages[s]->name()))) continue;\n",
)


def proof(name, what):
    """A search for proofs: what it has found is dropped. Its time is not saved."""
    call = f"impl::judge_{name}"
    arguments = {"stars": "(problem, found)", "winding": "(problem, found)", "patches": "(problem, f, found)",
                 "places": "(problem, f, found)"}[name]
    condition = "if constexpr (Element::dimension == 2) " if name not in ("patches", "stars") else ""
    whole = f"    {condition}{call}{arguments};\n"
    return Strategy(
        f"proof by {name}", what,
        ("core/untangle/proofs/infeasible.ipp", whole,
         "    {\n        const auto before = found;\n    " + whole +
         "        if (found.proofs.size() > before.proofs.size() && {off}) found = before;\n    }\n"))


STRATEGIES = [
    # Untangling in the plane
    stage(2, "coarse", "a coarse level alone, and its map prolonged"),
    stage(2, "harmonic", "the harmonic map"),
    stage(2, "newton", "Newton's method on the regularised energy from the harmonic map"),
    stage(2, "pull", "springs from an injective map"),
    stage(2, "stretch", "the same towards regular triangles, with detours"),
    stage(2, "operator", "Algorithm 2 of the paper on the device"),
    Strategy("margin", "steps away from the boundary of the feasible set once a map is injective",
             ("core/untangle/margin.hpp", "if (steps == 0) return;", "if (steps == 0 || {off}) return;")),
    Strategy("local proofs on levels", "the search for proofs before a coarse level is untangled",
             ("core/untangle/coarse_stage.hpp", "if (!coarse.injective() && !find_infeasibility(part))",
              "if (!coarse.injective() && ({off} || !find_infeasibility(part)))")),
    # Untangling in space
    stage(3, "harmonic", "the harmonic map"),
    stage(3, "operator", "Algorithm 2 of the paper on the device"),
    stage(3, "proof", "a proof by the directions of edges around the last inverted tetrahedra"),
    stage(3, "newton", "Newton's method on the regularised energy from the harmonic map"),
    stage(3, "lead", "handles led to their places from the shape at rest"),
    # Proofs
    proof("stars", "empty stars of vertices"),
    proof("winding", "the turning and winding numbers of pinned outlines"),
    proof("patches", "the measure within pinned closed patches"),
    proof("places", "fixed vertices outside of a pinned outline, and edges that meet"),
    # Starts of maps
    Strategy("pins drawn", "pins reached by a penalty continuation, coarse to fine",
             ("core/map/starts.hpp", "{ return run.uses_continuation(); },", "{ return run.uses_continuation() && !{off}; },")),
    Strategy("free map brought near", "pins on a free boundary untangled from the unconstrained map",
             ("core/map/starts.hpp", "&& !run.outline_pinned();\n", "&& !run.outline_pinned() && !{off};\n")),
    Strategy("second start", "a barycentric start where that on levels is not certified",
             ("core/map/mapped.ipp", "if (first.certified || first.stopped || !start.coarse) return",
              "if (first.certified || first.stopped || !start.coarse || {off}) return")),
    Strategy("further hierarchies", "two other hierarchies of the robust start",
             ("core/start/robust.hpp", "        if (done || !proceed()) break;\n    }\n",
              "        if (done || !proceed() || {off}) break;\n    }\n")),
    Strategy("rings of tubes", "long tubes with both ends open begin on concentric rings",
             ("core/map/starts.hpp", "if (loops.size() < 2) return start;", "if (loops.size() < 2 || {off}) return start;")),
    Strategy("robust start of Tutte", "barycentric maps where no hierarchy gave a good start",
             ("core/start/robust.hpp", "        if (done || (!best.uv.empty() && !proceed())) break;\n",
              "        if (done || (!best.uv.empty() && (!proceed() || {off}))) break;\n")),
    Strategy("hard levels", "slow convergence: descended again with small ratios and tight tolerances",
             ("core/map/attempt.hpp", "if (run.vertices() >= nested_params::hard_vertices) descent",
              "if (run.vertices() >= nested_params::hard_vertices && !{off}) descent")),
    Strategy("patience on small levels", "three small decreases in a row end a small level, not one",
             ("core/start/nested.hpp", "if (levels_.vertices(l) <= params_.small_vertices)",
              "if (levels_.vertices(l) <= params_.small_vertices && !{off})")),
    Strategy("double after float", "a second attempt in double",
             ("core/map/attempt.hpp", "if (first.stopped || how == precision::fp64 || !run.queue.device().has_fp64())",
              "if (first.stopped || how == precision::fp64 || !run.queue.device().has_fp64() || {off})")),
    # Minimisation
    Strategy("elimination", "nonlinear elimination of patches far from quadratic",
             ("core/solve/newton.hpp", "step_.value_before - value_ < params_.eliminate_below * f_.size(value_);",
              "step_.value_before - value_ < params_.eliminate_below * f_.size(value_) && !{off};")),
    Strategy("relaxation of cut steps", "elements that cut a step below a half are relaxed",
             ("core/solve/newton.hpp", "const bool relaxed = t.step < params_.relax_below && f_.relax(x_);",
              "const bool relaxed = t.step < params_.relax_below && !{off} && f_.relax(x_);")),
    Strategy("relaxation of levels", "elements that would cut the first step on a level are relaxed",
             ("core/start/nested.hpp", "if (relax && params_.solve.max_iterations > 0) level.relax();",
              "if (relax && params_.solve.max_iterations > 0 && !{off}) level.relax();"),
             ("core/map/attempt.hpp", "if (start.coarse && run.iterates()) finest.relax();",
              "if (start.coarse && run.iterates() && !{off}) finest.relax();"),
             ("core/map/penalty_continuation.hpp", "            finest.relax();\n", "            if (!{off}) finest.relax();\n")),
    Strategy("negative curvature", "directions of negative curvature as part of a step",
             ("core/solve/pcg.hpp", "if ((result.steps > 0 || k > 1) && fallen > noise) n =",
              "if ((result.steps > 0 || k > 1) && fallen > noise && !{off}) n =")),
    Strategy("last direction", "the last direction in the first block of a hard system",
             ("core/solve/newton.hpp", "exact && hard ? &last_d_ : nullptr", "exact && hard && !{off} ? &last_d_ : nullptr")),
    Strategy("conjugate directions", "directions of the projected Hessian conjugate to the last one",
             ("core/solve/newton.hpp", "if (!exact_ && along_stand_in_) conjugate();",
              "if (!exact_ && along_stand_in_ && !{off}) conjugate();")),
    Strategy("steps beyond one", "trial steps up to four along the projected Hessian",
             ("core/solve/newton.hpp", "const bool far = !exact_;", "const bool far = !exact_ && !{off};")),
    Strategy("longer systems", "more steps of conjugate gradients where the Hessian has proved right",
             ("core/solve/newton.hpp", "else if (model_.steps >= system_steps_)\n",
              "else if (model_.steps >= system_steps_ && !{off})\n")),
    Strategy("exact Hessian", "the Hessian itself, not its projection, near the end",
             ("core/solve/newton.hpp", "const bool exact = step_.value_before - value_ < params_.exact_below * f_.size(value_);",
              "const bool exact = step_.value_before - value_ < params_.exact_below * f_.size(value_) && !{off};")),
    Strategy("gradient with the full step", "the gradient at the full step in one wait with the trial steps",
             ("core/solve/newton.hpp", "if (near_end_ && most == 1)\n", "if (near_end_ && most == 1 && !{off})\n")),
    Strategy("stop by decrement", "the end where the Newton decrement is negligible",
             ("core/solve/stopping.hpp", "if (promises_ >= params_.tuning.decrease_count) return",
              "if (promises_ >= params_.tuning.decrease_count && !{off}) return")),
    Strategy("stop when settled", "the end where steps next to a minimum gain nothing",
             ("core/solve/stopping.hpp", "if (settled(k)) return", "if (settled(k) && !{off}) return")),
    # Volumes and sessions
    Strategy("guesses of volumes", "initial guesses with fixed vertices at their targets",
             ("core/map/session/incremental_loading.hpp",
              "return D == 3 && Element::oriented && map_.fixed.slides().empty() && call_.lasts(20);",
              "return D == 3 && Element::oriented && map_.fixed.slides().empty() && call_.lasts(20) && !{off};")),
    Strategy("guesses on coarser volumes", "the same on a coarser volume first",
             ("core/map/session/initial_guess.hpp", "        if (!smaller) return {};\n", "        if (!smaller || {off}) return {};\n")),
    Strategy("repaired guesses", "shrunk elements of a guess untangled and minimised by themselves",
             ("core/map/session/initial_guess.hpp", "if (const auto inside = around_shrunk(poisson, here, found.x); !inside.empty())",
              "if (const auto inside = around_shrunk(poisson, here, found.x); !inside.empty() && !{off})")),
    Strategy("paths in parts", "bodies of fixed vertices that rotate are led in parts",
             ("core/map/session/incremental_loading.hpp", "    const int parts = path.parts();\n    bool goes_on",
              "    const int parts = path.parts() > 1 && {off} ? 1 : path.parts();\n    bool goes_on")),
    Strategy("double in shapes", "the same steps again in double where float leads no further",
             ("core/map/session/incremental_loading.hpp", "if (!map.may_be_doubled()) return false;",
              "if (!map.may_be_doubled() || {off}) return false;")),
    Strategy("untangling of stuck shapes", "untangling where steps bring pins no nearer",
             ("core/map/session/incremental_loading.hpp", "if (call_.lasts(20))\n", "if (call_.lasts(20) && !{off})\n")),
    Strategy("untangling around stuck pins", "the same around these pins first",
             ("core/map/session/repair.hpp", "if (!part || !clock.in_time()) break;", "if (!part || !clock.in_time() || {off}) break;")),
    # Charts
    Strategy("charts kept apart", "charts that overlap themselves mapped anew with their borders apart",
             ("charts/atlas/cutting/mend_charts.hpp", "    keep_apart(run, set, bad);\n    if (!of",
              "    if (!{off}) keep_apart(run, set, bad);\n    if (!of")),
    Strategy("planar-projection charts", "patches laid as they are seen where a chart has no map",
             ("charts/atlas/cutting/mend_charts.hpp", "    if (!report.reason.empty()) return;\n    if (of.params",
              "    if (!report.reason.empty()) return;\n    if ({off})\n    {\n"
              "        report.reason = \"a chart has no map\";\n        return;\n    }\n    if (of.params")),
]

SWITCH = """// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <fstream>
#include <mutex>
#include <set>
#include <string>

namespace taut::impl
{

/// Returns whether a strategy is switched off by TAUT_WITHOUT, names with commas between them; its name goes to the file
/// TAUT_REACHED the first time.
inline bool without(const std::string& name)
{
    static std::mutex guard;
    static std::set<std::string> reached;
    const std::lock_guard lock(guard);
    const char* off = std::getenv("TAUT_WITHOUT");
    const char* file = std::getenv("TAUT_REACHED");
    if (reached.insert(name).second && file) std::ofstream(file, std::ios::app) << name << '\\n';
    return off && ("," + std::string(off) + ",").find("," + name + ",") != std::string::npos;
}

} // namespace taut::impl
"""


def patch(include):
    """Puts the switches into a copy of the headers, the folder include/taut/impl."""
    texts = {}
    places = [(STAGES, "")] + [(p, s.name) for s in STRATEGIES for p in s.places]
    for (file, old, new), name in places:
        text = texts.get(file) or (include / file).read_text()
        if text.count(old) != 1:
            raise SystemExit(f"strategies.py: {name or 'stages'}: {text.count(old)} times in {file}: {old.strip()}")
        texts[file] = text.replace(old, new.replace("{off}", f'::taut::impl::without("{name}")'))
    for file, text in texts.items():
        (include / file).write_text(text.replace("#pragma once\n", "#pragma once\n\n#include <taut/impl/core/core/ablation.hpp>\n", 1))
    (include / "core/core/ablation.hpp").write_text(SWITCH)
