// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/dist/processes/phase_clock.hpp>
#include <taut/impl/dist/shape/algebraic_multigrid.hpp>
#include <taut/impl/dist/shape/fixed_part.hpp>
#include <taut/impl/dist/shape/local_elements.hpp>
#include <taut/impl/dist/shape/space.hpp>
#include <taut/solve_params.hpp>

namespace taut::dist::impl
{

/// Distortion of a mesh over many processes as an objective of the solvers (solve/objective.hpp), with a Hessian and
/// prescribed displacements. A point has the coordinates of the vertices of the part, halo included, in lengths of the
/// run; vectors those of owned vertices. Values, gradients and first flips are the same bits on any number of
/// processes: cells are summed in fixed point, and the gradient of a vertex by its owner, in the order of its cells.
///
/// An error of one process, as of its device, is told to all with the next reduction, and all throw.
template <class Element>
class dist_objective
{
public:
    static constexpr int D = Element::dimension;
    using vector = dist_space::vector;
    using point = std::vector<double>;

    /// scales: of a typical gradient and a typical rise of the value. Referred to: all else.
    dist_objective(const part<Element>& p, local_elements<Element>& elements, const fixed_part<Element>& held,
                   algebraic_multigrid& multigrid, phase_clock& clock)
        : part_(p),
          elements_(elements),
          held_(held),
          multigrid_(multigrid),
          clock_(clock),
          space_(p.all, static_cast<std::size_t>(D) * p.own),
          displaced_(static_cast<std::size_t>(D) * p.size(), 0.0)
    {
    }

    void set_scales(double gradient, double value, double rounding)
    {
        gradient_scale_ = gradient;
        value_scale_ = value;
        rounding_ = rounding;
    }

    /// Lengths of the run by those of the caller.
    void set_lengths(double lengths) { lengths_ = lengths; }

    /// Collective. After the fixed coordinates have changed, other than in their targets.
    void rows_changed()
    {
        const auto timed = clock_.measure(&phase_seconds::plan);
        std::vector<char> still(part_.size());
        for (std::size_t v = 0; v < still.size(); ++v) still[v] = held_.still(v);
        rows_ = free_rows(part_, elements_.pattern(), still, D);
        multigrid_.forget();
    }

    /// The fixed coordinates of the targets, towards which linearize_towards() goes; D a vertex of the part, in lengths
    /// of the run.
    void aim(std::vector<double> targets) { aim_ = std::move(targets); }

    const dist_space& space() const { return space_; }
    point make_point() const { return point(static_cast<std::size_t>(D) * part_.size(), 0.0); }
    void copy(const point& x, point& y) const { y = x; }

    void step(const point& x, double a, const vector& d, point& out) const
    {
        out.resize(x.size());
        for (std::size_t i = 0; i < d.size(); ++i) out[i] = x[i] + a * d[i];
        part_.update(out, D);
    }

    double value(const point& x)
    {
        const auto timed = clock_.measure(&phase_seconds::values);
        shared_sums sum(1);
        attempt([&] { add(elements_at(x).energies(), sum[0]); });
        springs_value(x, {}, 0, sum[0]);
        return totals(sum)[0];
    }

    double value_gradient(const point& x, vector& g)
    {
        double square = 0;
        return value_gradient(x, g, square);
    }

    /// The same; square = g'g.
    double value_gradient(const point& x, vector& g, double& square)
    {
        const auto timed = clock_.measure(&phase_seconds::values);
        shared_sums sums(2);
        attempt([&] { add(elements_at(x).energies(g), sums[0]); });
        springs_value(x, {}, 0, sums[0]);
        springs_gradient(x, g);
        held_.project(part_, g);
        for (const double k : g) sums[1].add(k * k);
        const auto found = totals(sums);
        square = found[1];
        return found[0];
    }

    void values(const point& x, const vector& d, std::span<const double> a, std::span<double> out)
    {
        const auto timed = clock_.measure(&phase_seconds::values);
        with_halo(d);
        attempt([&] { elements_at(x); });
        trial_values(x, a, out);
    }

    /// The least step at which an element flips.
    double max_step(const point& x, const vector& d)
    {
        const auto timed = clock_.measure(&phase_seconds::values);
        with_halo(d);
        return first_flip(x);
    }

    double capped_values(const point& x, const vector& d, double fraction, std::span<const double> a,
                         std::span<double> out, double most = 1)
    {
        const auto timed = clock_.measure(&phase_seconds::values);
        with_halo(d);
        const double bound = fraction * first_flip(x), unit = bound >= most ? most : bound;
        std::vector<double> steps;
        for (const double s : a) steps.push_back(unit * s);
        trial_values(x, steps, out);
        return unit;
    }

    double gradient_scale(const point&) const { return gradient_scale_; }
    double value_scale() const { return value_scale_; }
    double rounding() const { return rounding_; }

    void linearize(const point& x, bool exact)
    {
        {
            const auto timed = clock_.measure(&phase_seconds::linearize);
            assemble(x, exact);
        }
        refresh(x);
    }

    void hessian_product(const vector& v, vector& out)
    {
        const auto timed = clock_.measure(&phase_seconds::products);
        with_halo(v);
        multiply(exact_, out);
        held_.project(part_, out);
    }

    void precondition(const vector& v, vector& out)
    {
        const auto timed = clock_.measure(&phase_seconds::apply);
        multigrid_.apply(rows_, v, out);
        held_.project(part_, out);
    }

    /// As newton_objective: d = a share of the way of the fixed coordinates to their targets, g = the gradient at x + d
    /// in the model.
    solve::impl::model_change linearize_towards(const point& x, double share, vector& d, vector& g)
    {
        double value = 0;
        {
            const auto timed = clock_.measure(&phase_seconds::linearize);
            for (std::size_t v = 0; v < part_.own; ++v)
                for (int k = 0; k < D; ++k)
                {
                    const auto i = D * v + static_cast<std::size_t>(k);
                    d[i] = held_.held(v, k) ? share * (aim_[i] - x[i]) : 0;
                }
            with_halo(d);
            shared_sums sums(3);
            attempt([&] { add(elements_at(x).energies(g), sums[0]); });
            springs_value(x, {}, 0, sums[0]);
            springs_gradient(x, g);
            assemble(x, false);
            vector product = space_.make();
            multiply(false, product);
            double before = 0, after = 0;
            for (std::size_t i = 0; i < g.size(); ++i)
            {
                before += g[i] * d[i];
                g[i] += product[i];
                after += g[i] * d[i];
            }
            held_.project(part_, g);
            sums[1].add(before);
            sums[2].add(after);
            const auto found = totals(sums);
            value = found[0];
            change_ = (found[1] + found[2]) / 2;
        }
        refresh(x, &g);
        return {value, change_};
    }

    /// Sets the fixed coordinates to their targets.
    void put(point& x) const
    {
        for (std::size_t v = 0; v < part_.size(); ++v)
            for (int k = 0; k < D; ++k)
                if (held_.held(v, k))
                    x[D * v + static_cast<std::size_t>(k)] = aim_[D * v + static_cast<std::size_t>(k)];
    }

    /// Relaxes single vertices of the worst elements, each process those that have no vertex of another beside them;
    /// returns whether any process had one.
    bool relax(point& x)
    {
        const auto timed = clock_.measure(&phase_seconds::values);
        if (inner_.empty()) find_inner();
        bool moved = false;
        attempt(
            [&]
            {
                std::vector<bool> still(part_.size());
                for (std::size_t v = 0; v < still.size(); ++v) still[v] = inner_[v] == 0 || held_.restrained(v);
                for (const auto& s : held_.springs) still[s.vertex] = true;
                moved = elements_.relax(x, still);
            });
        part_.all.agree(std::exchange(failure_, nullptr));
        if (!part_.all.any(moved)) return false;
        part_.update(x, D);
        return true;
    }

    std::int64_t unknowns() const { return rows_.total(); }

private:
    void find_inner()
    {
        inner_.assign(part_.size(), 1);
        for (const auto& c : part_.corners)
            if (std::any_of(c.begin(), c.end(), [&](idx v) { return !part_.owns(v); }))
                for (const idx v : c) inner_[static_cast<std::size_t>(v)] = 0;
        if (inner_.empty()) inner_.push_back(0);
    }

    template <class F>
    void attempt(const F& f)
    {
        if (failure_) return;
        try
        {
            f();
        }
        catch (...)
        {
            failure_ = std::current_exception();
        }
    }

    std::vector<double> totals(const shared_sums& sums)
    {
        return sums.totals(part_.all, std::exchange(failure_, nullptr));
    }

    local_elements<Element>& elements_at(const point& x)
    {
        elements_.move_to(x);
        return elements_;
    }

    /// Segment by segment of the cells, those that this process counts.
    void add(const std::vector<double>& energies, fixed_sum& sum, std::size_t segment = 0) const
    {
        const std::size_t n = elements_.cells();
        for (std::size_t c = 0; c < n; ++c)
            if (part_.counted[c]) sum.add(energies[segment * n + c]);
    }

    void with_halo(const vector& d)
    {
        std::copy(d.begin(), d.end(), displaced_.begin());
        part_.update(displaced_, D);
    }

    double first_flip(const point& x)
    {
        double least = std::numeric_limits<double>::infinity();
        attempt([&] { least = elements_at(x).first_flip(displaced_); });
        if (failure_) least = -1;
        least = part_.all.least(least);
        if (least < 0) part_.all.fail(std::exchange(failure_, nullptr));
        return least >= 0 ? least : 0; // no step is of use along a direction that is no number
    }

    /// At x + a d, where x is on the device and d in displaced_.
    void trial_values(const point& x, std::span<const double> a, std::span<double> out)
    {
        constexpr std::size_t most = local_elements<Element>::trials;
        shared_sums sums(a.size());
        for (std::size_t first = 0; first < a.size(); first += most)
        {
            const auto some = a.subspan(first, std::min(most, a.size() - first));
            attempt(
                [&]
                {
                    const auto energies = elements_.energies(displaced_, some);
                    for (std::size_t k = 0; k < some.size(); ++k) add(energies, sums[first + k], k);
                });
        }
        for (std::size_t k = 0; k < a.size(); ++k) springs_value(x, displaced_, a[k], sums[k]);
        const auto found = totals(sums);
        std::copy(found.begin(), found.end(), out.begin());
    }

    void assemble(const point& x, bool exact)
    {
        attempt(
            [&]
            {
                elements_at(x).linearize(definiteness::projected);
                if (exact) elements_.linearize(definiteness::indefinite);
            });
        exact_ = exact;
    }

    /// The preconditioner of the projected matrix.
    void refresh(const point& x, const vector* tried = nullptr)
    {
        const auto timed = clock_.measure(&phase_seconds::setup);
        const bool due = multigrid_.due();
        std::vector<double> values;
        attempt(
            [&]
            {
                if (due) values = elements_.values();
            });
        part_.all.agree(std::exchange(failure_, nullptr));
        if (!due) return;
        std::vector<double> stiff(part_.own, 0.0); // of springs
        for (const auto& s : held_.springs) stiff[s.vertex] += 2 * s.weight / (lengths_ * lengths_);
        rows_.set(
            [&](std::size_t v, std::size_t w, std::size_t place, const auto& put)
            {
                mat<D> K;
                for (int i = 0; i < D; ++i)
                    for (int j = 0; j < D; ++j) K[j][i] = values[place * D * D + static_cast<std::size_t>(i * D + j)];
                if (v == w)
                    for (int i = 0; i < D; ++i) K[i][i] += stiff[v];
                if (held_.restrained(v) || held_.restrained(w))
                {
                    const mat<D> P = held_.projection(v);
                    const double typical = v == w ? trace(K) / D : 0;
                    K = P * K * held_.projection(w);
                    if (v == w) K += typical * (mat<D>(1.0) - P); // of what cannot move
                }
                for (int i = 0; i < D; ++i)
                    for (int j = 0; j < D; ++j) put(static_cast<std::size_t>(i), static_cast<std::size_t>(j), K[j][i]);
            });
        // Alternating numbers try what an aligned vector would not.
        vector trial = tried ? *tried : space_.make();
        if (!tried)
            for (std::size_t i = 0; i < trial.size(); ++i) trial[i] = i % 2 == 0 ? 1.0 : -0.5;
        multigrid_.refresh(rows_, D, x, trial);
    }

    static double trace(const mat<D>& K)
    {
        double sum = 0;
        for (int i = 0; i < D; ++i) sum += K[i][i];
        return sum;
    }

    /// A product with the vector in displaced_, springs included.
    void multiply(bool exact, vector& out)
    {
        std::fill(out.begin(), out.end(), 0.0);
        attempt([&] { elements_.product(exact, displaced_, out); });
        for (const auto& s : held_.springs)
            for (std::size_t k = 0; k < D; ++k)
                out[D * s.vertex + k] += 2 * s.weight / (lengths_ * lengths_) * displaced_[D * s.vertex + k];
    }

    void springs_value(const point& x, const std::vector<double>& d, double a, fixed_sum& sum) const
    {
        for (const auto& s : held_.springs)
            for (int k = 0; k < D; ++k)
            {
                const auto i = D * s.vertex + static_cast<std::size_t>(k);
                const double gap = (x[i] + (d.empty() ? 0 : a * d[i])) / lengths_ - s.target[k];
                sum.add(s.weight * gap * gap);
            }
    }
    void springs_gradient(const point& x, vector& g) const
    {
        for (const auto& s : held_.springs)
            for (int k = 0; k < D; ++k)
            {
                const auto i = D * s.vertex + static_cast<std::size_t>(k);
                g[i] += 2 * s.weight * (x[i] / lengths_ - s.target[k]) / lengths_;
            }
    }

    const part<Element>& part_;
    local_elements<Element>& elements_;
    const fixed_part<Element>& held_;
    algebraic_multigrid& multigrid_;
    phase_clock& clock_;
    dist_space space_;
    free_rows rows_;
    std::vector<double> displaced_, aim_;
    std::vector<char> inner_; ///< a flag per vertex: all its neighbours are owned here
    double gradient_scale_ = 1, value_scale_ = 0, rounding_ = 1e-14, lengths_ = 1, change_ = 0;
    bool exact_ = false;
    std::exception_ptr failure_; ///< of this process, not told yet
};

} // namespace taut::dist::impl
