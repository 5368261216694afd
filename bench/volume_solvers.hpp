// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <taut/deform.hpp>
#include <taut/energies.hpp>
#include <taut/evaluator.hpp>
#include <taut/solve.hpp>
#include <taut/untangle.hpp>

#include "direct_solver.hpp"
#include "measure.hpp"
#include "solver_run.hpp"
#include "volume_problem.hpp"

namespace bench
{

/// Solvers of the isometric energy of a volume from one untangled start with the ends at their places: the
/// library's, its L-BFGS with a scalar first Hessian, and projected Newton with a factorisation of each matrix.
class volume_solvers
{
public:
    using shape = std::vector<taut::vec3>;
    using tetrahedra = taut::tetrahedron;

    /// limit: seconds of one run. Throws where the moved ends could not be untangled.
    volume_solvers(taut::queue& q, const volume_problem& p, const std::string& motion, double limit)
        : queue_(q), mesh_(p.mesh), pins_(p.held(motion)), limit_(limit), held_(p.mesh.points().size())
    {
        taut::untangle_problem<tetrahedra> tangled{mesh_, {mesh_.points().begin(), mesh_.points().end()}, {}};
        for (const auto& [v, pin] : pins_.pins())
        {
            held_[static_cast<std::size_t>(v)] = held_.every;
            tangled.initial[static_cast<std::size_t>(v)] = pin.value;
        }
        tangled.held = held_;
        // Not the stage `lead`, whose shapes are all but the best ones.
        auto found = taut::untangle(q, tangled, {.stages = {"operator", "newton"}});
        if (!found) throw std::runtime_error("the ends could not be brought to their places: " + found.reason);
        start_ = std::move(found.map);
    }

    /// From the call to the certified shape, all set-up included.
    solver_run library()
    {
        solver_run run;
        const stopwatch watch;
        taut::deform_params<tetrahedra> params;
        params.constraints = pins_;
        params.initial = start_;
        const auto watched = [&](const taut::progress& p)
        {
            if (p.iterate) run.history.push_back(watch.at(p.iteration, p.value));
            return true;
        };
        const auto r = taut::deform(queue_, mesh_, params, {.observer = watched});
        run.valid = r && r.report.pins_held;
        run.iterations = r.report.steps;
        run.energy = r.report.energy;
        run.flipped = r.report.flips.flipped;
        run.stop = r.report.converged ? "converged" : "not converged";
        watch.stop(run);
        return run;
    }

    /// The same from the shape at rest, whose ends are led to their places; as its history the end alone.
    solver_run library_from_rest()
    {
        solver_run run;
        const stopwatch watch;
        const auto r = taut::deform(queue_, mesh_, taut::deform_params<tetrahedra>{.constraints = pins_});
        run.valid = r && r.report.pins_held;
        run.iterations = r.report.steps;
        run.energy = r.report.energy;
        run.flipped = r.report.flips.flipped;
        run.stop = r.report.converged ? "converged" : "not converged";
        run.history.push_back(watch.at(run.iterations, run.energy));
        watch.stop(run);
        return run;
    }

    /// enough: an energy that is low enough.
    solver_run lbfgs(double enough)
    {
        solver_run run;
        const stopwatch watch;
        taut::impl::map_objective<tetrahedra> f(queue_, std::make_shared<const taut::impl::layout<tetrahedra>>(mesh_),
                                                taut::energy::isometric{}, taut::energy::weighting::measure,
                                                taut::impl::types_of(taut::precision::mixed));
        f.constrain({held_, {}, {}});
        auto x = f.make_point();
        f.upload(start_, x);
        taut::solve::params how{.method = taut::solve::method::lbfgs};
        how.gradient_tolerance = 0;
        how.max_iterations = 1000000;
        const auto watched = [&](const taut::progress& p)
        {
            if (!p.iterate) return true;
            run.history.push_back(watch.at(p.iteration, p.value));
            return p.value > enough;
        };
        const auto r = taut::solve::minimize(f, x, how, {std::chrono::duration<double>(limit_), watched});
        run.valid = true;
        run.iterations = r.iterations;
        run.energy = r.value;
        run.stop = taut::solve::to_string(r.stop);
        watch.stop(run);
        return run;
    }

    /// Not valid where the build has no direct solver.
    solver_run direct_newton(double enough)
    {
        solver_run run;
        const stopwatch watch;
        taut::map_evaluator<tetrahedra> f(queue_, mesh_, taut::energy::isometric{});
        auto x = start_;
        shape g(x.size()), d(x.size());
        std::vector<bool> free(x.size());
        for (std::size_t v = 0; v < x.size(); ++v) free[v] = !held_.any(v);
        double value = f.value_gradient(x, g);
        std::unique_ptr<direct_solver> solver;
        run.history.push_back(watch.at(0, value));
        while (value > enough && watch.seconds() < limit_ && run.iterations < 200)
        {
            const auto H = f.hessian(x, taut::definiteness::projected);
            if (!solver) solver = make_direct_solver(H, free);
            if (!solver) return run;
            if (!solver->factorize(H)) break;
            for (auto& c : g) c = -c;
            solver->solve(g, d);
            shape next = x;
            double a = std::min(1.0, 0.9 * f.max_step(x, d));
            for (;; a /= 2)
            {
                for (std::size_t v = 0; v < x.size(); ++v) next[v] = x[v] + a * d[v];
                if (a < 1e-9 || f.value(next) < value) break;
            }
            if (a < 1e-9) break;
            x = std::move(next);
            value = f.value_gradient(x, g);
            run.history.push_back(watch.at(++run.iterations, value));
        }
        run.valid = true;
        run.energy = value;
        run.stop = value <= enough ? "low enough" : "time";
        watch.stop(run);
        return run;
    }

private:
    /// Wall-clock and processor time since it was made.
    class stopwatch
    {
    public:
        double seconds() const { return std::chrono::duration<double>(clock::now() - begin_).count(); }
        sample at(int iteration, double value) const
        {
            return {iteration, value, seconds(), bench::cpu_seconds() - cpu_};
        }
        void stop(solver_run& run) const
        {
            run.seconds.solve = seconds();
            run.cpu_seconds = bench::cpu_seconds() - cpu_;
        }

    private:
        clock::time_point begin_ = clock::now();
        double cpu_ = bench::cpu_seconds();
    };

    taut::queue& queue_;
    const taut::mesh<tetrahedra>& mesh_;
    taut::constraints<tetrahedra> pins_;
    double limit_;
    taut::impl::fixed_marks<3> held_;
    shape start_;
};

} // namespace bench
