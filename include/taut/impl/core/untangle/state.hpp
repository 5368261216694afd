// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/core/budget.hpp>
#include <taut/impl/core/objective/stage_report.hpp>
#include <taut/impl/core/start/harmonic.hpp>
#include <taut/impl/core/untangle/proofs/infeasibility.hpp>
#include <taut/impl/core/untangle/regularized_newton.hpp>
#include <taut/options.hpp>
#include <taut/untangle.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// Shared state of the stages of an untangling: the problem, the best map so far, the clock and the observer.
///
/// Stages work in a unit of length in which the largest coordinate of the initial map is in [1, 2). It is a power of
/// two, so changing units is exact.
template <class Element>
class untangle_state
{
public:
    static constexpr int D = Element::dimension;
    using map = std::vector<vec<D>>;

    /// Refers to the problem.
    untangle_state(const untangle_problem<Element>& problem, const run_limits& limits, newton_maker<Element> newton)
        : problem_(problem),
          newton_(std::move(newton)),
          budget_(limits.time_limit, limits.observer),
          best_(problem.initial),
          flips_(certified(best_))
    {
        double largest = 0;
        for (const auto& p : problem.initial)
            for (int k = 0; k < D; ++k) largest = std::max(largest, std::abs(p[k]));
        if (largest > 0) unit_ = std::ldexp(1.0, std::clamp(-std::ilogb(largest), -1000, 1000));
        initial_ = scaled(problem.initial);
        draft_ = scaled(problem.draft);
    }

    const untangle_problem<Element>& problem() const { return problem_; }
    const auto& cells() const { return problem_.rest.cells(); }
    const map& initial() const { return initial_; } ///< in the unit of the stages
    const map& draft() const { return draft_; }     ///< of the problem, in the unit of the stages; may be empty
    /// The harmonic map that keeps fixed coordinates, in the unit of the stages.
    const map& harmonic()
    {
        if (harmonic_.empty()) harmonic_ = impl::harmonic_start(problem_, initial_);
        return harmonic_;
    }
    map best() const { return scaled(best_); }          ///< in the unit of the stages
    const map& best_map() const { return best_; }       ///< in the unit of the problem
    const certificate& flips() const { return flips_; } ///< of best_map(), exact
    bool injective() const { return static_cast<bool>(flips_); }
    int iterations() const { return iterations_; }

    /// Newton's steps for a stage.
    std::unique_ptr<regularized_newton<Element>> make_newton(regularized_problem<Element> p) const
    {
        p.owners = problem().owners;
        return newton_(std::move(p));
    }

    /// Takes x, in the unit of the stages, as the best map if it has fewer defects; its fixed coordinates are replaced
    /// by those of the problem before they are counted. Returns what was counted.
    certificate offer(std::span<const vec<D>> x) { return keep(restored(x, unit_)); }

    /// The same with x in the unit of the problem.
    certificate take(std::span<const vec<D>> x) { return keep(restored(x, 1)); }

    /// Replaces an injective map by another one; returns false, without effect, if x is not injective.
    bool replace(std::span<const vec<D>> x)
    {
        map trial = restored(x, unit_);
        certificate flips = certified(trial);
        if (!flips) return false;
        best_ = std::move(trial);
        flips_ = std::move(flips);
        return true;
    }

    /// Takes a proof that there is no injective map.
    void disprove(infeasibility_finding proof) { proof_ = std::move(proof); }
    const std::optional<infeasibility_finding>& proof() const { return proof_; }

    /// Checks the limits after each iteration. Returns false once the time limit is reached or the observer has
    /// returned false.
    bool proceed(int iterations = 1)
    {
        iterations_ += iterations;
        return budget_.proceed({.iteration = iterations_, .value = static_cast<double>(flips_.defects())});
    }

    /// Report of the current stage, to which it may add.
    stage_report& now() { return now_; }

    /// Records a Newton step for the report of the current stage.
    void stepped(double before, double after, double length)
    {
        if (!(now_.energy_before < std::numeric_limits<double>::infinity())) now_.energy_before = before;
        now_.energy_after = after;
        if (length > 0) steps_.add(length, length < 1);
    }

    /// Records the stage that has just ended.
    void ended(std::string name, std::string stop)
    {
        untangle_stage_report did{std::exchange(now_, {}), flips_.flipped, flips_.branched};
        std::exchange(steps_, {}).tell(did);
        did.stage = std::move(name);
        did.vertices = best_.size();
        did.iterations = iterations_ - std::exchange(reported_, iterations_);
        did.stop = std::move(stop);
        did.seconds = budget_.lap();
        stages_.push_back(std::move(did));
    }

    /// Records the stages of a coarser level, whose iterations count as those of this one.
    void append(const std::vector<untangle_stage_report>& coarser, std::size_t level)
    {
        for (const auto& s : coarser)
        {
            stages_.push_back(s);
            stages_.back().level = level;
            iterations_ += s.iterations;
        }
        reported_ = iterations_;
        budget_.lap();
    }

    const std::vector<untangle_stage_report>& stages() const { return stages_; } ///< that have ended

    /// The same within a part of the work with a state of its own, `part`.
    bool proceed(progress part)
    {
        part.iteration += iterations_;
        return budget_.proceed(part);
    }

    bool cancelled() const { return budget_.refused(); }
    bool stopped() const { return budget_.over(); }
    double seconds() const { return budget_.total(); }
    double seconds_left() const { return budget_.left().count(); }

private:
    certificate keep(map trial)
    {
        certificate flips = certified(trial);
        if (flips.defects() < flips_.defects())
        {
            best_ = std::move(trial);
            flips_ = flips;
        }
        return flips;
    }

    map scaled(const map& x) const
    {
        map result = x;
        for (auto& p : result) p *= unit_;
        return result;
    }

    map restored(std::span<const vec<D>> x, double unit) const
    {
        map result = problem_.initial;
        for (std::size_t v = 0; v < result.size(); ++v)
            for (int k = 0; k < D; ++k)
                if (!problem_.held.test(v, k)) result[v][k] = x[v][k] / unit;
        return result;
    }

    certificate certified(const map& x) const
    {
        return certify<D>(problem_.rest.cells(), std::span<const vec<D>>(x), {}, 0, problem_.owners);
    }

    const untangle_problem<Element>& problem_;
    newton_maker<Element> newton_;
    budget budget_;
    double unit_ = 1;
    map initial_, draft_, harmonic_, best_;
    certificate flips_;
    std::optional<infeasibility_finding> proof_;
    int iterations_ = 0, reported_ = 0;
    std::vector<untangle_stage_report> stages_;
    stage_report now_; // of the stage at work, as far as it tells
    step_tally steps_;
};

} // namespace taut::impl
