// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_UNTANGLE
#endif
#ifndef TAUT_UNTANGLE_HPP
#define TAUT_UNTANGLE_HPP

#include <cstddef>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include <taut/certify.hpp>
#include <taut/errors.hpp>
#include <taut/impl/core/core/name_in.hpp>
#include <taut/impl/core/mesh/refine_elements.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/impl/core/solve/tuning.hpp>
#include <taut/impl/core/untangle/proofs/infeasibility.hpp>
#include <taut/impl/core/untangle/tuning.hpp>
#include <taut/options.hpp>
#include <taut/queue.hpp>
#include <taut/untangle_problem.hpp>

/// Moves free vertices until no element is inverted, or proves that none can be.
namespace taut
{

/// Outcome of a run. Only `valid` comes with a certified map: no element is inverted, and there is no inner vertex of a
/// surface that the map winds around other than once; in exact arithmetic.
enum class outcome
{
    valid,          ///< the map is certified; map_report::solve says why the optimisation ended
    no_valid_start, ///< no injective start was found; map_report::reason and ids say where
    stopped,        ///< the time limit or the observer ended the run before there was a map; there are no coordinates
    infeasible,     ///< no map obeys the pins without inverted elements; reason and ids are the proof
    gave_up         ///< untangling did not succeed; the map has the fewest defects that were seen, ids are theirs
};

/// Stable name of an outcome, for programs.
constexpr std::string_view to_string(outcome what) noexcept
{
    return taut::impl::name_in<outcome::gave_up>({"valid", "no valid start", "stopped", "infeasible", "gave up"}, what);
}
inline std::ostream& operator<<(std::ostream& out, outcome what)
{
    return out << to_string(what);
}

/// Report of one stage of an untangling. Energies are the regularised ones of its first and last step.
struct untangle_stage_report : stage_report
{
    std::size_t inverted = 0; ///< elements inverted in the best map when it ended
    std::size_t branched = 0; ///< branch points of that map
};

/// Result of untangle(): the outcome, the best map and its stages.
template <class Element>
struct untangle_result
{
    static constexpr int D = Element::dimension;

    taut::outcome outcome = outcome::gave_up;
    std::string reason;      ///< why there is no injective map; empty if there is one
    std::vector<idx> ids;    ///< infeasible: what the proof names; gave_up: the inverted elements of the map, or its
                             ///< branch points where none is inverted
    std::vector<vec<D>> map; ///< map with the fewest defects found; fixed coordinates as in the problem
    certificate flips;       ///< certificate of the map, exact; det in the units of the map, not divided by anything
    double least_relative_det = 0; ///< smallest mapped / rest measure, divided by that of the whole; 1: a dilation
    std::string stage;             ///< stage that found the injective map; "initial" if there was nothing to do
    std::vector<untangle_stage_report> stages; ///< those that ran, in their order, proofs and margin included
    double seconds = 0;                        ///< wall-clock seconds of the whole run

    /// True if the map is certified.
    explicit operator bool() const { return outcome == outcome::valid; }
};

template <class Element>
std::ostream& operator<<(std::ostream& out, const untangle_result<Element>& r);

/// Parameters of untangle(). Every field has a sensible default.
struct untangle_params
{
    /// Names of the stages to run, in this order; empty: all that the dimension and the device allow
    /// (stages.hpp).
    std::vector<std::string> stages = {};

    /// Maximum number of rounds, after which it gives up, whatever time is left. Range >= 1.
    int rounds = 5;

    /// Not for users: what tests and measurements set.
    impl::untangle_tuning tuning = {};

    /// Throws parameter_error that names the field; the names of stages are looked up by untangle().
    void validate() const
    {
        if (rounds < 1) throw parameter_error("rounds", "must be at least 1");
        tuning.validate();
    }
};

/// Untangles a map: moves free coordinates until every element is positive, by a sequence of stages
/// (untangle_params::stages). The outcome is injective only with a certificate in exact arithmetic, infeasible only
/// with a proof; a map that was not found to be either comes with the reason and the inverted elements. Fixed
/// coordinates are those of `problem.initial`, bit for bit, in all cases.
///
/// Newton's method runs on the device, except on small planar meshes, and the paper's operator is a further stage. In
/// the plane that one comes last, as the others are more reliable, and in space early; untangle_params::stages gives
/// another order.
/// The observer is told the iteration, the fewest inverted elements so far (value) and seconds.
/// Throws parameter_error for a problem or parameters that are not valid, device_error.
template <class Element>
untangle_result<Element> untangle(const queue& q, const untangle_problem<Element>& problem,
                                  const untangle_params& params = {}, const run_limits& limits = {});

/// Untangles a map with all stages that need no device.
untangle_result<triangle> untangle(const untangle_problem<triangle>& problem, const untangle_params& params = {},
                                   const run_limits& limits = {});

untangle_result<tetrahedron> untangle(const untangle_problem<tetrahedron>& problem, const untangle_params& params = {},
                                      const run_limits& limits = {});

/// Limits of the refinement of a mesh. Every field has a sensible default.
struct refine_params
{
    /// Maximum number of rounds of splits. Range >= 0.
    int rounds = 8;

    /// Maximum ratio of elements of the refined mesh to those of the mesh. Range >= 1.
    double max_growth = 4;

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (rounds < 0) throw parameter_error("refine.rounds", "must not be negative");
        if (!(max_growth >= 1)) throw parameter_error("refine.max_growth", "must be at least 1");
    }
};

/// Problem on a refined mesh.
template <class Element>
struct refined_problem
{
    untangle_problem<Element> problem;
    impl::subdivision how = {};  ///< subdivision of the original mesh; empty: none
    std::vector<idx> cells = {}; ///< element of the original mesh that contains each element
    int rounds = 0;              ///< rounds of splits
    std::string obstacle = {};   ///< the proof that no split refutes, or which limit was met; empty: none
};

/// Result of untangle() with refinement: the untangling, and the refined mesh.
template <class Element>
struct refined_untangling
{
    untangle_result<Element> result; ///< ids of elements are those of the refined mesh
    refined_problem<Element> refined;
};

/// Untangles a map with refinement: where it is proved that no map is injective, or none was found, elements are split
/// and it is tried again. Split are the inner edges between fixed vertices that the proofs name, else those of or
/// around the elements left inverted (proofs/mending_splits.hpp). Fixed vertices keep their positions, the boundary is
/// not split, and the certificate is of all elements of the refined mesh. Attempts other than the last one, which is of
/// the whole mesh, are short, in space by the operator and one round of Newton's method. `infeasible`: the proof holds
/// for all splits inside the mesh; reason says what.
/// Throws parameter_error as untangle() and refine_problem() do, device_error.
template <class Element>
refined_untangling<Element> untangle(const queue& q, const untangle_problem<Element>& problem,
                                     const untangle_params& params, const run_limits& limits,
                                     const refine_params& refine);

/// Searches for a proof that no map with these fixed coordinates is locally injective, without solving, in exact
/// arithmetic. Where none is found the problem may be feasible or not. Near-linear time: searches that would take
/// longer are cut short. Throws parameter_error as validate() does.
///
/// The proofs. The determinant of an element with all corners fixed does not change. The sum of the determinants within
/// a pinned outline is the area or volume that the outline encloses, and has to be positive. A surface of positive
/// triangles covers each point as often as its outline winds about it (the degree of the map), so no winding number is
/// negative; and with angles in (0, 2 pi] at the outline, which are the least, and multiples of 2 pi inside, the
/// theorem of Gauss and Bonnet says that the outline turns at least chi times. An inner vertex is covered, so its
/// winding number is positive. Within a simple boundary no point is covered twice, so no edges meet; elsewhere overlap
/// is no proof: a staircase in spirals has positive triangles only.
template <class Element>
impl::infeasibility find_infeasibility(const untangle_problem<Element>& problem);

} // namespace taut

#endif
#include <taut/impl/leave.inl>
