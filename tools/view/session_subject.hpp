// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <taut/session.hpp>
#include <taut/untangle.hpp>

#include "view/floats.hpp"
#include "view/subject.hpp"

namespace taut::view
{

/// The corners of a cross around a vertex that is outside of it: what takes a moment to untangle.
template <class Element>
untangle_problem<Element> tangled_star()
{
    constexpr int D = Element::dimension;
    std::vector<vec3> points(1, vec3(0.0));
    for (int k = 0; k < D; ++k)
        for (const double side : {-1.0, 1.0})
        {
            points.emplace_back(0.0);
            points.back()[k] = side;
        }
    std::vector<typename mesh<Element>::cell> cells;
    for (unsigned sides = 0; sides < 1u << D; ++sides)
    {
        typename mesh<Element>::cell c{};
        bool turned = false;
        for (int k = 0; k < D; ++k)
        {
            const int side = static_cast<int>(sides >> k & 1u);
            c[static_cast<std::size_t>(k) + 1] = 1 + 2 * k + side;
            turned ^= side == 0;
        }
        if (turned) std::swap(c[1], c[2]);
        cells.push_back(c);
    }
    std::vector<vec<D>> start;
    for (const vec3& p : points) start.emplace_back(p);
    start[0][0] = 1.5;
    taut::impl::fixed_marks<D> held(points.size());
    for (std::size_t v = 1; v < points.size(); ++v) held[v] = held.every;
    return {mesh<Element>(std::move(points), std::move(cells)), std::move(start), std::move(held)};
}

/// A session as a page sees it. Faces outside of a focus are held where they are, beside what is pinned.
template <class Element>
class session_subject : public subject
{
public:
    static constexpr int D = Element::dimension;
    using map = std::vector<vec<D>>;

    void pin(std::span<const place> pins) override
    {
        auto asked = asked_;
        for (const place& p : pins)
            if (p.held == constraints<Element>::all)
                asked.repin(p.vertex, point(p));
            else
                for (int k = 0; k < D; ++k)
                    if ((p.held >> k & 1) != 0) asked.repin(p.vertex, k, p.x[k]);
        asked_ = std::move(asked);
        for (const place& p : pins) tell(p.vertex);
    }

    void release(std::span<const std::int32_t> vertices) override
    {
        auto asked = asked_;
        for (const idx v : vertices) asked.release(v);
        asked_ = std::move(asked);
        for (const idx v : vertices) tell(v);
    }

    void focus(std::span<const std::int32_t> faces) override
    {
        const auto& cells = shown();
        std::vector<char> inside(cells.size(), 0);
        for (const std::int32_t f : faces)
        {
            if (static_cast<std::size_t>(f) >= cells.size())
                throw error("face " + std::to_string(f) + " is not there; there are " + std::to_string(cells.size()));
            inside[static_cast<std::size_t>(f)] = 1;
        }
        outside_.assign(faces.empty() ? 0 : mesh_.points().size(), 0);
        for (std::size_t f = 0; !outside_.empty() && f < cells.size(); ++f)
            for (const std::uint32_t v : cells[f])
                if (inside[f] == 0) outside_[v] = 1;
        go_to(session_->x());
    }

    void align(int axis, std::span<const std::int32_t> vertices) override
    {
        if (axis >= D) throw error("there is no such coordinate");
        double sum = 0;
        for (const idx v : vertices) sum += at(v)[axis];
        std::vector<place> pins;
        for (const idx v : vertices)
        {
            pins.push_back({v, static_cast<std::uint8_t>(1 << axis), {}});
            pins.back().x[axis] = sum / static_cast<double>(vertices.size());
        }
        pin(pins);
    }

    void pose(const ask::pose&) override { throw error(nothing_pasted); }
    void move(const ask::move&) override { throw error(nothing_pasted); }
    void keep() override { throw error(nothing_pasted); }
    int revision() const override { return 0; }

    void rehearse() override
    {
        // A vertex that goes a little aside has the kernels of a drag made, a star to be untangled those of repairs.
        const auto before = x();
        const auto& c = mesh_.cells().front();
        const auto v = static_cast<std::size_t>(c[0]);
        const auto report = std::exchange(report_, {});
        session_->pin(c[0], before[v] + 1e-3 * (before[static_cast<std::size_t>(c[1])] - before[v]));
        session_->solve({.steps = 2});
        go_to(before);
        report_ = report;
        if constexpr (Element::oriented) untangle(queue_, tangled_star<Element>(), {.stages = {"pull"}, .rounds = 1});
    }

    bool advance(std::chrono::duration<double> time, const std::function<bool()>& goes_on) override
    {
        // Steps that gain nothing: some more in one call can tell rounding from convergence, and untangle what is
        // stuck.
        constexpr int patience = 5;
        goes_on_ = goes_on;
        const auto r =
            session_->solve(idle_ < patience ? taut::session_budget{.time = time} : taut::session_budget{.steps = 25})
                .report;
        if (r.outcome != outcome::valid || !r.reason.empty()) throw error(r.reason);
        // Where a pin is in another one's way the energy creeps for ever.
        const bool gains = r.steps > 0 && (r.distance < 0.999 * distance_ || r.energy < (1 - 1e-5) * energy_);
        if (gains)
            idle_ = 0;
        else if (goes_on())
            ++idle_;
        distance_ = r.distance;
        energy_ = r.energy;
        report_ = r;
        return !r.converged && idle_ <= patience;
    }

    void describe(state& s) const override
    {
        s.converged = report_.converged;
        s.held = report_.pins_held;
        s.flipped = static_cast<std::uint32_t>(report_.flips.flipped);
        s.energy = report_.energy;
        s.distance = report_.distance;
        for (const auto& [v, p] : asked_.pins())
        {
            s.pins.push_back({v, p.held, {}});
            for (int k = 0; k < D; ++k) s.pins.back().x[k] = p.value[k];
        }
        if (!origin_) origin_ = session_->x().front();
        for (int k = 0; k < D; ++k) s.origin[k] = (*origin_)[k];
        s.positions = as_floats(session_->x(), *origin_);
    }

    std::shared_ptr<const memory> remember() const override
    {
        return std::make_shared<moment>(asked_, outside_, session_->x(), report_);
    }

    void go_back(const memory& before) override
    {
        const auto& m = static_cast<const moment&>(before);
        asked_ = m.asked;
        outside_ = m.outside;
        go_to(m.x);
        report_ = m.report;
    }

protected:
    /// Queue and mesh are referred to. make: the session, with an observer.
    template <class Make>
    session_subject(queue& q, const mesh<Element>& m, const Make& make)
        : queue_(q),
          mesh_(m),
          session_(make([this](const progress&) { return !goes_on_ || goes_on_(); })),
          asked_(session_->constraints())
    {
        const auto r = session_->solve().report;
        if (r.outcome != outcome::valid) throw error(r.reason);
        report_ = r;
    }

    /// The corners of what is drawn.
    virtual const std::vector<std::array<std::uint32_t, 3>>& shown() const = 0;

    queue& queue_;

    const map& x() const { return session_->x(); }
    const taut::constraints<Element>& asked() const { return asked_; }

    /// Pins, and the vertices outside of the focus at their positions.
    taut::constraints<Element> all_held() const
    {
        auto all = asked_;
        for (std::size_t v = 0; v < outside_.size(); ++v)
            if (outside_[v] != 0) hold(all, static_cast<idx>(v));
        return all;
    }

    void go_to(const map& x)
    {
        session_->restore(asked_, x);
        if (!outside_.empty()) session_->restore(all_held(), x);
        changed();
    }

private:
    struct moment : memory
    {
        moment(taut::constraints<Element> a, std::vector<char> o, map m, session_report r)
            : asked(std::move(a)), outside(std::move(o)), x(std::move(m)), report(std::move(r))
        {
        }
        taut::constraints<Element> asked;
        std::vector<char> outside;
        map x;
        session_report report;
        std::size_t bytes() const override
        {
            using pin = typename std::decay_t<decltype(asked.pins())>::value_type;
            return outside.size() + x.size() * sizeof(vec<D>) + asked.pins().size() * (sizeof(pin) + 4 * sizeof(void*));
        }
    };

    static constexpr const char* nothing_pasted = "there is nothing to paste; start with --source";

    static vec<D> point(const place& p)
    {
        vec<D> x;
        for (int k = 0; k < D; ++k) x[k] = p.x[k];
        return x;
    }

    const vec<D>& at(idx v) const
    {
        if (static_cast<std::size_t>(v) >= x().size()) throw error("vertex " + std::to_string(v) + " is not there");
        return x()[static_cast<std::size_t>(v)];
    }

    /// Fixes a vertex at its position, except coordinates that are pinned.
    void hold(taut::constraints<Element>& c, idx v) const
    {
        for (int k = 0; k < D; ++k)
            if ((asked_.held(v) >> k & 1u) == 0) c.repin(v, k, at(v)[k]);
    }

    /// There may be something to gain again.
    void changed()
    {
        idle_ = 0;
        report_.converged = false;
    }

    /// The session what is asked of a vertex now.
    void tell(idx v)
    {
        session_->release(v);
        const auto p = asked_.pins().find(v);
        for (int k = 0; k < D; ++k)
            if (p != asked_.pins().end() && (p->second.held >> k & 1u) != 0)
                session_->pin(v, k, p->second.value[k]);
            else if (!outside_.empty() && outside_[static_cast<std::size_t>(v)] != 0)
                session_->pin(v, k, at(v)[k]);
        changed();
    }

    const mesh<Element>& mesh_;
    std::function<bool()> goes_on_; ///< asked by the session
    std::unique_ptr<session<Element>> session_;
    mutable std::optional<vec<D>> origin_; ///< of what pages get
    taut::constraints<Element> asked_;     ///< by the person at the page
    std::vector<char> outside_;            ///< of the focus, one per vertex; empty: there is none
    session_report report_;
    double distance_ = 0, energy_ = 0;
    int idle_ = 0; ///< calls in a row that gained nothing
};

} // namespace taut::view
