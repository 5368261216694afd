// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <taut/map/map_result.hpp>
#include <taut/map/parameterize_params.hpp>
#include <taut/map/problem.hpp>

namespace taut
{

namespace detail
{

/// Seconds since the last call of lap(), for the phases of a report.
class stopwatch
{
public:
    double lap()
    {
        const auto now = clock::now();
        return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
    }
    double total() const { return std::chrono::duration<double>(clock::now() - first_).count(); }

private:
    using clock = std::chrono::steady_clock;
    clock::time_point first_ = clock::now(), last_ = first_;
};

/// True if the energy does not see a dilation, as the shape energy: the scale of a map is then up to us.
inline bool is_scale_invariant(const any_energy& energy)
{
    const mat2 S(1.1, 0.2, -0.3, 0.9);
    const auto at = [&](double s) { return energy(element<double, 2>{s * S, s * s * glm::determinant(S), 1.0}); };
    return std::abs(at(3.0) - at(1.0)) < 1e-9 * std::abs(at(1.0));
}

/// One run of parameterize(): the phases in their order.
class parameterization
{
public:
    parameterization(queue q, const mesh<triangle>& m, const parameterize_params& p)
        : queue_(std::move(q)), mesh_(m), params_(p), counters_(queue_.counters())
    {
        params_.solve.validate();
    }

    map_result run()
    {
        const auto sides = facets(mesh_);
        validate(mesh_, sides, {.one_boundary = !params_.holes});
        const ideal_elements<triangle> ideal(mesh_);
        result_.report.seconds.setup += watch_.lap();

        make_start(sides, ideal);
        result_.report.seconds.start = watch_.lap();
        if (result_.report.start.flips.flipped > 0) return fail();

        optimize(sides, ideal);
        subtract_counters();
        return std::move(result_);
    }

private:
    void make_start(const facet_table& sides, const ideal_elements<triangle>& ideal)
    {
        auto& start = result_.report.start;
        if (params_.initial.empty())
        {
            start = barycentric_map(mesh_, sides, params_.start);
            return;
        }
        if (params_.initial.size() != mesh_.points().size())
            throw parameter_error("initial", std::to_string(params_.initial.size()) + " coordinates for " +
                                                 std::to_string(mesh_.points().size()) + " vertices");
        start.uv = params_.initial;
        start.assess(mesh_, ideal);
        if (start.flips.flipped == start.flips.elements && start.flips.max_det < 0)
        {
            for (auto& p : start.uv) p.x = -p.x;
            start.assess(mesh_, ideal);
            result_.report.notes.push_back("the start was mirrored as a whole; u was negated");
        }
    }

    map_result fail()
    {
        auto& r = result_.report;
        r.ids = r.start.flips.ids;
        r.reason = "the start map has " + std::to_string(r.start.flips.flipped) + " flipped of " +
                   std::to_string(r.start.flips.elements) + " triangles, first " + std::to_string(r.ids.front());
        r.flips = r.start.flips;
        result_.uv = r.start.uv;
        subtract_counters();
        return std::move(result_);
    }

    void optimize(const facet_table& sides, const ideal_elements<triangle>& ideal)
    {
        const auto local = std::make_shared<const layout<triangle>>(mesh_, pinned(sides));
        result_.report.seconds.setup += watch_.lap();
        solve_in(params_.precision, local);
        finish(*local, ideal);
        if (result_.report.flips.flipped > 0 && params_.precision != precision::full)
        {
            result_.report.notes.push_back("float arithmetic could not keep the slivers of this map upright; "
                                           "repeated in double");
            solve_in(precision::full, local);
            finish(*local, ideal);
        }
        if (result_.report.flips.flipped > 0)
        {
            result_.report.notes.push_back("rounding turned an element over; the start map is returned");
            result_.uv = result_.report.start.uv;
        }
        result_.report.flips = certify<2>(mesh_.cells(), result_.uv, ideal.measure);
        result_.report.outcome = outcome::valid;
        result_.report.seconds.setup += watch_.lap();
    }

    std::vector<bool> pinned(const facet_table& sides) const
    {
        if (params_.boundary == boundary_mode::free) return {};
        const auto loops = boundary_loops(mesh_, sides);
        std::vector<bool> flags(mesh_.points().size(), false);
        for (const index v : loops[result_.report.start.outline]) flags[static_cast<std::size_t>(v)] = true;
        return flags;
    }

    void solve_in(precision how, const std::shared_ptr<const layout<triangle>>& local)
    {
        switch (how)
        {
        case precision::full:
            return solve_with<double, double>(local);
        case precision::mixed:
            return solve_with<double, float>(local);
        case precision::single:
            return solve_with<float, float>(local);
        }
    }

    template <class P, class R>
    void solve_with(const std::shared_ptr<const layout<triangle>>& local)
    {
        problem<triangle, P, R> f(queue_, local, params_.energy, params_.weights);
        auto x = f.make_point();
        f.upload(result_.report.start.uv, x);
        // Drivers compile at the first launch; that is start-up, not solving.
        f.warm_up(x);
        result_.report.seconds.device += watch_.lap();

        auto p = params_.solve;
        p.stopping.time_limit = params_.time_limit - std::chrono::duration<double>(watch_.total());
        p.stopping.time_limit = std::max(p.stopping.time_limit, std::chrono::duration<double>(1e-9));
        result_.report.solve = solve::minimize(f, x, p, params_.observer);
        result_.uv = f.download(x);
        result_.report.seconds.solve += watch_.lap();
    }

    /// Restores what the solver was free to change without anyone asking for it, and certifies.
    void finish(const layout<triangle>& local, const ideal_elements<triangle>& ideal)
    {
        if (params_.boundary == boundary_mode::fixed)
            // The device may hold positions in float; pinned vertices are the start's, bit for bit.
            for (index v = local.free_count; v < local.vertex_count; ++v)
            {
                const auto old = static_cast<std::size_t>(local.order.vertices.new_to_old[static_cast<std::size_t>(v)]);
                result_.uv[old] = result_.report.start.uv[old];
            }
        else if (is_scale_invariant(params_.energy))
            keep_total_area(ideal);
        result_.report.flips = certify<2>(mesh_.cells(), result_.uv, ideal.measure);
    }

    /// Scales the map to the area of the surface.
    void keep_total_area(const ideal_elements<triangle>& ideal)
    {
        double rest = 0, mapped = 0;
        for (std::size_t c = 0; c < ideal.measure.size(); ++c)
        {
            rest += ideal.measure[c];
            const auto& t = mesh_.cells()[c];
            const auto at = [&](std::size_t k) { return result_.uv[static_cast<std::size_t>(t[k])]; };
            mapped += triangle::measure_factor * triangle::determinant({at(0), at(1), at(2)});
        }
        const double s = std::sqrt(rest / mapped);
        if (std::isfinite(s) && s > 0)
            for (auto& p : result_.uv) p *= s;
    }

    void subtract_counters()
    {
        auto& used = result_.report.counters;
        used = queue_.counters();
        used.launches -= counters_.launches;
        used.waits -= counters_.waits;
        used.bytes_read -= counters_.bytes_read;
        used.bytes_written -= counters_.bytes_written;
        used.builds -= counters_.builds;
        used.build_seconds -= counters_.build_seconds;
    }

    queue queue_;
    const mesh<triangle>& mesh_;
    parameterize_params params_;
    queue_counters counters_;
    stopwatch watch_;
    map_result result_;
};

} // namespace detail

/// Maps a surface to the plane with as little distortion as the energy asks for and without flipping a triangle:
/// validate -> start map -> minimise on the queue's device -> certificate in exact arithmetic.
///
/// The map comes in the user's vertex order and in the units of the surface; a scale-invariant energy leaves the scale
/// open, and the map then has the area of the surface. On a stop for any reason (limits, observer) the map is the best
/// one so far, which is as valid as any.
/// Throws mesh_error (not a disk, degenerate triangle, ...), parameter_error, device_error.
inline map_result parameterize(queue& q, const mesh<triangle>& m, const parameterize_params& params = {})
{
    return detail::parameterization(q, m, params).run();
}

} // namespace taut
