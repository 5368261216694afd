// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/energy/distortion.hpp>
#include <taut/impl/map/deform_params.hpp>
#include <taut/impl/map/session/session_steps.hpp>
#include <taut/impl/mesh/validate.hpp>

namespace taut::impl
{

/// Binds the data and parameters to the user's energy. Throws parameter_error.
template <class Element>
deform_params<Element> validated(deform_params<Element> p)
{
    p.validate();
    if (!p.parameters.empty()) p.energy = p.energy.with_parameters(p.parameters);
    p.energy = p.energy.with_data(p.data.mean_attributes(), !p.data.directions.empty());
    return p;
}

/// Session of a deforming shape, from the given shape, untangled if need be.
template <class Element>
class shape_session : public session_steps<Element>
{
    using base = session_steps<Element>;
    using base::last, base::wanted;

public:
    static constexpr int D = Element::dimension;
    using typename base::map;

    shape_session(const queue& q, const mesh<Element>& m, const deform_params<Element>& params)
        : base(q, params),
          params_(validated(params)),
          start_(start_of(m, params_)),
          rest_(deformable(in_run_lengths(m, params_.rest), params_)),
          ideal_(ideals(rest_, params_, unit_scale(m)))
    {
        require_slides();
        this->lengths_ = unit_scale(m);
        wanted = params_.constraints.on(rest_);
        wanted.require_near(this->lengths_);
    }

private:
    void begin(run_clock& clock) override
    {
        session_report& r = last.report = {};
        this->held_ = held_places<Element>(start_, {}, params_.slides);
        this->held_.take(wanted);
        auto flips = this->certified(start_);
        last.x = start_;
        if (!flips && !mended(clock, flips))
        {
            last.x.clear();
            return;
        }
        last.x = start_;
        r.outcome = outcome::valid;
        r.flips = std::move(flips);
        this->note_gap();
        clock.has_result(true);
        if (this->proved(start_)) return;
        if (!clock.proceed())
        {
            r.energy = energy_of(start_);
            return;
        }
        const precision how = params_.precision != precision::automatic ? params_.precision
                              : this->queue_.device().has_fp64()        ? precision::mixed
                                                                        : precision::fp32;
        put(how, this->scaled(start_));
        this->changed = true;
        this->book(clock, &session_seconds::start, {.stage = "start"});
        const auto notes = std::exchange(r.notes, {});
        this->advance(clock);
        r.notes.insert(r.notes.begin(), notes.begin(), notes.end());
    }

    /// Untangles the initial shape with the defects `flips`, unless its elements have no orientation.
    bool mended(run_clock& clock, certificate& flips)
    {
        session_report& r = last.report;
        if constexpr (Element::oriented)
        {
            auto found = this->untangled(clock, start_);
            r.outcome = found.outcome == untangle_outcome::infeasible ? outcome::infeasible : outcome::gave_up;
            r.reason = std::move(found.reason);
            r.ids = std::move(found.ids);
            if (!found) return false;
            r.reason.clear();
            r.notes.push_back("the shape had " + describe_defects<Element>(flips, params_.owners) +
                              "; it was untangled");
            start_ = this->unscaled(std::move(found.map));
            flips = std::move(found.flips);
            return true;
        }
        else
        {
            r.outcome = outcome::gave_up;
            r.reason = "the shape to begin with has " + describe_defects<Element>(flips);
            r.ids = flips.ids;
            return false;
        }
    }

    bool may_be_doubled() const override
    {
        return this->live_->in_float() && params_.precision == precision::automatic && this->queue_.device().has_fp64();
    }

    bool in_double() override
    {
        if (!may_be_doubled()) return false;
        put(precision::fp64, this->scaled(this->placed()));
        last.report.notes.push_back("in float steps led no further; the last ones were in double");
        return true;
    }

    /// Energy of a shape without inverted elements, computed on the host.
    double energy_of(const map& x) const
    {
        const map run_lengths = this->scaled(x);
        const means e = mean_over(rest_, ideal_, std::span<const vec<D>>(run_lengths),
                                  [this](const element<double, D>& here) { return params_.energy(here); });
        return params_.weights == energy::weighting::measure ? e.measure : e.uniform;
    }

    /// Puts a map on the device, with fixed coordinates.
    void put(precision how, const map& run_lengths)
    {
        this->live_.emplace(this->queue_, rest_, params_, how, run_lengths,
                            params_.shapes == target_shapes::rest && params_.targets.empty() ? nullptr : &ideal_);
        this->load(run_lengths);
    }

    void require_slides() const
    {
        std::vector<idx> bad;
        for (const auto& s : params_.slides)
            if (s.vertex < 0 || s.vertex >= rest_.vertex_count() || params_.constraints.held(s.vertex) != 0)
                bad.push_back(s.vertex);
        refuse_vertices(constraint_fault::contradictory, std::move(bad),
                        "that the mesh does not have, or that is pinned, among the slides; leave it out");
    }

    /// Validates the mesh, which may have any number of components, holes and handles; vertices without cells keep
    /// their positions. Throws mesh_error, and parameter_error for parameters that are not of this mesh.
    static mesh<Element> deformable(mesh<Element> m, const deform_params<Element>& params)
    {
        params.data.validate(m.cells().size());
        if constexpr (Element::oriented) require_deformable(m, params); // a thin_shell is so
        return m;
    }

    static void require_deformable(const mesh<Element>& m, const deform_params<Element>& params)
    {
        for (const auto& [size, field] :
             {std::pair{params.targets.size(), "targets"}, {params.owners.size(), "owners"}})
            if (size != 0 && size != m.cells().size())
                throw parameter_error(field,
                                      std::to_string(size) + " for " + std::to_string(m.cells().size()) + " cells");
        auto found = check(
            m, {.referenced = false, .connected = false, .open = false, .one_boundary = false, .no_handles = false});
        if (params.shapes == target_shapes::regular) // which need no rest shape
            std::erase_if(found, [](const mesh_finding& f)
                          { return f.fault == mesh_fault::degenerate_cell || f.fault == mesh_fault::inverted_cell; });
        if constexpr (D == 3) // its hierarchy knows no facets
            std::erase_if(found, [](const mesh_finding& f) { return f.fault == mesh_fault::non_manifold_vertex; });
        if (!params.owners.empty()) // which share facets
            std::erase_if(found, [](const mesh_finding& f)
                          { return f.fault != mesh_fault::degenerate_cell && f.fault != mesh_fault::inverted_cell; });
        if (!found.empty()) throw mesh_error(describe<Element>(found[0].fault, found[0].ids, params.owners));
        if constexpr (D == 2)
            for (const vec3& p : m.points())
                if (p.z != 0)
                    throw parameter_error("mesh", "a surface in space has no shape in the plane; parameterize it");
    }

    /// unit: normalised unit by that of the parameters.
    static ideal_elements<Element> ideals(const mesh<Element>& m, const deform_params<Element>& params, double unit)
    {
        if constexpr (!Element::oriented)
            return ideal_elements<Element>(m);
        else
            return wanted_ideals(m, params, unit);
    }

    static ideal_elements<Element> wanted_ideals(const mesh<Element>& m, const deform_params<Element>& params,
                                                 double unit)
    {
        const bool regular = params.shapes == target_shapes::regular;
        if (params.targets.empty())
            return regular ? regular_elements<Element>(m.cells().size(), whole(m)) : ideal_elements<Element>(m);
        auto wanted = elements_with_edges<Element>(params.targets, unit, "targets");
        if (!regular) return wanted;
        const double factor = whole(m) / std::accumulate(wanted.measure.begin(), wanted.measure.end(), 0.0);
        for (auto& inverse : wanted.inverse) inverse /= std::pow(factor, 1.0 / D);
        for (double& measure : wanted.measure) measure *= factor;
        return wanted;
    }

    /// Measure of all cells, inverted or not.
    static double whole(const mesh<Element>& m)
    {
        double total = 0;
        for (idx c = 0; c < m.cell_count(); ++c)
        {
            const auto rest = m.rest(c);
            typename Element::mapped_corners x;
            for (std::size_t k = 0; k < x.size(); ++k) x[k] = vec<D>(rest[k]);
            total += std::abs(Element::determinant(x)) * Element::measure_factor;
        }
        return total;
    }

    static map start_of(const mesh<Element>& m, const deform_params<Element>& params)
    {
        const std::size_t n = m.points().size();
        if (!params.initial.empty() && params.initial.size() != n)
            throw parameter_error("initial", std::to_string(params.initial.size()) + " positions for " +
                                                 std::to_string(n) + " vertices");
        if (!params.initial.empty()) return params.initial;
        return map(m.points().begin(), m.points().end());
    }

    static mesh<Element> in_run_lengths(const mesh<Element>& m, const std::vector<vec3>& rest)
    {
        if (!rest.empty() && rest.size() != m.points().size())
            throw parameter_error("rest", std::to_string(rest.size()) + " positions for " +
                                              std::to_string(m.points().size()) + " vertices");
        auto points = rest.empty() ? m.points() : rest;
        const double unit = unit_scale(m);
        for (vec3& p : points) p *= unit;
        return {std::move(points), m.cells()};
    }

    const mesh<Element>& rest() const override { return rest_; }
    std::span<const double> rest_measure() const override { return ideal_.measure; }

    std::vector<mat<D>> wanted_elements() const override
    {
        std::vector<mat<D>> edges;
        if (params_.shapes == target_shapes::regular)
            for (const auto& inverse : ideal_.inverse) edges.push_back(invert_upper(inverse));
        return edges;
    }
    std::vector<idx> owners() const override { return params_.owners; }

    deform_params<Element> params_; ///< validated
    map start_;
    mesh<Element> rest_; ///< in normalised units
    ideal_elements<Element> ideal_;
};

} // namespace taut::impl
