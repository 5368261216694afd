// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include <taut/impl/core/core/disjoint_sets.hpp>
#include <taut/impl/core/measure/rigid_motion.hpp>
#include <taut/impl/dist/shape/fixed_part.hpp>
#include <taut/rigid_motion.hpp>

namespace taut::dist::impl
{

/// Paths of fixed vertices to their targets, as prescribed_paths of one process: bodies, connected by cells between
/// pinned vertices, move rigidly, and the remaining displacement is linear.
template <class Element>
class pinned_bodies
{
public:
    static constexpr int D = Element::dimension;
    using point = vec<D>;

    /// Collective. from: D numbers a vertex of the part; the targets are those of `held` times `lengths`.
    pinned_bodies(const part<Element>& p, const fixed_part<Element>& held, const std::vector<double>& from,
                  double lengths)
        : part_(p), held_(held), from_(from), to_(from.size()), body_(p.size(), -1)
    {
        for (std::size_t i = 0; i < to_.size(); ++i) to_[i] = held.targets[i] * lengths;
        find_bodies();
        fit_motions();
    }

    /// Number of parts of the path, so that none turns by more than `most` radians.
    int parts(double most = std::numbers::pi / 6) const
    {
        double largest = 0;
        for (const auto& m : motions_) largest = std::max(largest, std::abs(m.angle));
        return std::max(1, static_cast<int>(std::ceil(largest / most - 1e-9)));
    }

    /// Whether a body turns by nearly half a turn, so that its direction is an accident.
    bool half_turned() const
    {
        return std::any_of(motions_.begin(), motions_.end(),
                           [](const auto& m) { return std::abs(m.angle) > 0.95 * std::numbers::pi; });
    }

    /// Rotation of the body of a vertex, axis times angle; none where it is undetermined. other_way: of half turns.
    std::optional<vec3> turn(std::size_t v, bool other_way = false) const
    {
        if (body_[v] < 0 || sizes_[at(body_[v])] < D) return std::nullopt;
        const auto& m = motions_[at(body_[v])];
        const bool back = other_way && std::abs(m.angle) > 0.95 * std::numbers::pi;
        return (back ? m.angle - std::copysign(2 * std::numbers::pi, m.angle) : m.angle) * m.axis;
    }

    /// The rigid motion of all pinned vertices together.
    const rigid_motion<D>& whole() const { return whole_; }

    /// Positions of fixed coordinates at the fraction t of the path, D numbers a vertex of the part; exact where t
    /// is 1.
    std::vector<double> places(double t) const
    {
        std::vector<double> all(to_.size(), 0.0);
        for (std::size_t v = 0; v < part_.size(); ++v)
        {
            if (held_.marks[v] == 0) continue;
            const point p = t >= 1 ? position(to_, v) : where(v, t);
            for (int k = 0; k < D; ++k) all[D * v + static_cast<std::size_t>(k)] = p[k];
        }
        return all;
    }

    const std::vector<double>& targets() const { return to_; }

private:
    static std::size_t at(idx v) { return static_cast<std::size_t>(v); }

    point position(const std::vector<double>& x, std::size_t v) const
    {
        point p;
        for (int k = 0; k < D; ++k) p[k] = x[D * v + static_cast<std::size_t>(k)];
        return p;
    }

    point where(std::size_t v, double t) const
    {
        const point from = position(from_, v), to = position(to_, v);
        if (body_[v] < 0) return from + t * (to - from);
        const auto& m = motions_[at(body_[v])];
        return m(from, t) + t * m.turned(to - m(from), (t - 1) * m.angle);
    }

    /// The least number of its vertices names a body: it spreads from part to part until nothing changes.
    void find_bodies()
    {
        taut::impl::disjoint_sets sets(static_cast<idx>(part_.size()));
        std::vector<char> joined(part_.size(), 0);
        for (const auto& c : part_.corners)
        {
            idx first = -1;
            for (const idx v : c)
            {
                if (!held_.pinned(at(v))) continue;
                if (first >= 0)
                {
                    sets.join(first, v);
                    joined[at(first)] = joined[at(v)] = 1;
                }
                else
                    first = v;
            }
        }
        std::vector<std::int64_t> name(part_.numbers);
        for (bool changed = true; changed;)
        {
            std::vector<std::int64_t> least(part_.numbers);
            for (std::size_t v = 0; v < name.size(); ++v)
            {
                auto& there = least[at(sets.find(static_cast<idx>(v)))];
                there = std::min(there, name[v]);
            }
            changed = false;
            for (std::size_t v = 0; v < name.size(); ++v)
                if (const auto now = least[at(sets.find(static_cast<idx>(v)))]; joined[v] && now < name[v])
                    name[v] = now, changed = true;
            part_.update(name);
            changed = part_.all.any(changed);
        }
        std::vector<std::int64_t> names;
        for (std::size_t v = 0; v < part_.own; ++v)
            if (joined[v]) names.push_back(name[v]);
        unique(names);
        names = part_.all.gathered(names);
        unique(names);
        for (std::size_t v = 0; v < name.size(); ++v)
            if (joined[v])
                body_[v] = static_cast<idx>(std::lower_bound(names.begin(), names.end(), name[v]) - names.begin());
        motions_.resize(names.size());
        sizes_.assign(names.size(), 0);
        // A vertex of the halo may be joined only beyond it.
        part_.update(body_);
    }

    static void unique(std::vector<std::int64_t>& numbers)
    {
        std::sort(numbers.begin(), numbers.end());
        numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    }

    /// Fits by moments, of the bodies and, last, of all pinned vertices.
    void fit_motions()
    {
        const std::size_t n = motions_.size() + 1;
        std::vector<double> first(n * (2 * D + 1), 0.0), second(n * D * D, 0.0);
        const auto each = [&](const auto& f)
        {
            for (std::size_t v = 0; v < part_.own; ++v)
            {
                if (!held_.pinned(v)) continue;
                if (body_[v] >= 0) f(at(body_[v]), position(from_, v), position(to_, v));
                f(n - 1, position(from_, v), position(to_, v));
            }
        };
        each(
            [&](std::size_t b, const point& p, const point& q)
            {
                double* const m = first.data() + b * (2 * D + 1);
                m[2 * D] += 1;
                for (int k = 0; k < D; ++k) m[k] += p[k], m[D + k] += q[k];
            });
        part_.all.add(std::span(first));
        std::vector<rigid_motion<D>> fits(n);
        for (std::size_t b = 0; b < n; ++b)
        {
            const double* const m = first.data() + b * (2 * D + 1);
            for (int k = 0; k < D && m[2 * D] > 0; ++k)
                fits[b].from[k] = m[k] / m[2 * D], fits[b].to[k] = m[D + k] / m[2 * D];
        }
        each(
            [&](std::size_t b, const point& p, const point& q)
            {
                const point from = p - fits[b].from, to = q - fits[b].to;
                for (std::size_t i = 0; i < D; ++i)
                    for (std::size_t j = 0; j < D; ++j)
                        second[(b * D + i) * D + j] += from[static_cast<int>(i)] * to[static_cast<int>(j)];
            });
        part_.all.add(std::span(second));
        for (std::size_t b = 0; b < n; ++b)
        {
            const auto fit = of_moments(std::span<const double>(second).subspan(b * D * D, D * D));
            fits[b].axis = fit.axis;
            fits[b].angle = fit.angle;
            if (b + 1 < n) motions_[b] = fits[b], sizes_[b] = first[b * (2 * D + 1) + 2 * D];
        }
        whole_ = fits.back();
    }

    /// The fit to points of these second moments: unit vectors, there and back.
    static rigid_motion<D> of_moments(std::span<const double> S)
    {
        std::vector<point> points, images;
        for (int sign : {1, -1})
            for (int i = 0; i < D; ++i)
            {
                point p(0.0), q;
                p[i] = sign;
                for (int j = 0; j < D; ++j) q[j] = 0.5 * sign * S[static_cast<std::size_t>(D * i + j)];
                points.push_back(p);
                images.push_back(q);
            }
        return taut::impl::fit_rigid_motion(std::span<const point>(points), std::span<const point>(images));
    }

    const part<Element>& part_;
    const fixed_part<Element>& held_;
    std::vector<double> from_, to_;
    std::vector<idx> body_;
    std::vector<rigid_motion<D>> motions_;
    std::vector<double> sizes_;
    rigid_motion<D> whole_;
};

} // namespace taut::dist::impl
