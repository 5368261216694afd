// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
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

/// The smallest box around some points: its centre and its larger side.
struct bounding_square
{
    vec2 centre{0};
    double size = 0;

    explicit bounding_square(const std::vector<vec2>& points)
    {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        vec2 least(infinity), most(-infinity);
        for (const vec2& p : points) least = glm::min(least, p), most = glm::max(most, p);
        centre = least / 2.0 + most / 2.0; // the sum may overflow
        size = std::max(most.x - least.x, most.y - least.y);
    }
};

/// One run of parameterize(): the phases in their order. Inside, lengths are those of the surface times a power of two
/// (unit_scale), so that nothing overflows; undoing that is exact.
class parameterization
{
public:
    parameterization(queue q, const mesh<triangle>& m, const parameterize_params& p)
        : queue_(std::move(q)), unit_(unit_scale(m)), mesh_(scaled(m, unit_)), params_(p), counters_(queue_.counters())
    {
        params_.validate();
    }

    map_result run()
    {
        const auto sides = facets(mesh_);
        validate(mesh_, sides, {.one_boundary = !params_.holes});
        ideal_.emplace(mesh_);
        report().seconds.setup += watch_.lap();

        make_start(sides);
        report().seconds.start = watch_.lap();
        if (report().reason.empty()) optimize(sides);
        subtract_counters();
        for (auto* uv : {&result_.uv, &report().start.uv})
            for (vec2& p : *uv) p /= unit_;
        return std::move(result_);
    }

private:
    static mesh<triangle> scaled(const mesh<triangle>& m, double unit)
    {
        auto points = m.points();
        for (vec3& p : points) p *= unit;
        return {std::move(points), m.cells()};
    }

    map_report& report() { return result_.report; }

    bool proceed() const
    {
        return watch_.total() < params_.time_limit.count() &&
               (!params_.observer || params_.observer({.seconds = watch_.total(), .iterate = false}));
    }

    void make_start(const facet_table& sides)
    {
        auto& start = report().start;
        if (params_.initial.empty())
        {
            auto p = params_.start;
            p.proceed = [this] { return proceed(); };
            start = barycentric_map(mesh_, sides, p);
        }
        else
            take_initial();
        if (start.flips.flipped == 0) return;
        report().ids = start.flips.ids;
        report().reason = "the start map has " + std::to_string(start.flips.flipped) + " flipped of " +
                          std::to_string(start.flips.elements) + " triangles, first " +
                          std::to_string(report().ids.front());
        report().flips = start.flips;
        result_.uv = start.uv;
    }

    void take_initial()
    {
        auto& start = report().start;
        if (params_.initial.size() != mesh_.points().size())
            throw parameter_error("initial", std::to_string(params_.initial.size()) + " coordinates for " +
                                                 std::to_string(mesh_.points().size()) + " vertices");
        start.uv = params_.initial;
        if (params_.boundary == boundary_mode::free)
            bring_to_size(start.uv);
        else
            for (vec2& p : start.uv) p *= unit_;
        start.assess(mesh_, *ideal_);
        if (start.flips.flipped == start.flips.elements && start.flips.max_det < 0)
        {
            for (vec2& p : start.uv) p.x = -p.x;
            start.assess(mesh_, *ideal_);
            report().notes.push_back("the start was mirrored as a whole; u was negated");
        }
        // Sums far from the origin cost digits, most of all in float.
        centre_ = bounding_square(start.uv).centre;
    }

    /// Scales by a power of two, so that the map's extent is that of a square with the area of the surface.
    void bring_to_size(std::vector<vec2>& uv) const
    {
        const double size = bounding_square(uv).size;
        if (!(size > 0) || !std::isfinite(size)) return;
        const double wanted = std::sqrt(std::accumulate(ideal_->measure.begin(), ideal_->measure.end(), 0.0));
        const int power = std::ilogb(wanted) - std::ilogb(size);
        for (vec2& p : uv) p = {std::ldexp(p.x, power), std::ldexp(p.y, power)};
    }

    void optimize(const facet_table& sides)
    {
        const auto local = std::make_shared<const layout<triangle>>(mesh_, pinned(sides));
        report().seconds.setup += watch_.lap();
        solve_in(params_.precision, local);
        if (!certified() && params_.precision != precision::full && queue_.device().has_fp64())
        {
            report().notes.push_back("float could not hold this map; repeated in double");
            solve_in(precision::full, local);
        }
        if (!certified())
        {
            report().notes.push_back("the minimum that was found is too small or too thin for its precision; the start "
                                     "map is returned");
            result_.uv = report().start.uv;
            report().solve.value = report().solve.value_start;
            certified();
        }
        report().outcome = outcome::valid;
        report().seconds.setup += watch_.lap();
    }

    /// Counts flips of the current map; false too if its energy was never finite.
    bool certified()
    {
        report().flips = certify<2>(mesh_.cells(), result_.uv, ideal_->measure);
        return report().flips.flipped == 0 && report().solve.stop != solve::stop::not_finite_start;
    }

    std::vector<bool> pinned(const facet_table& sides)
    {
        if (params_.boundary == boundary_mode::free) return {};
        const auto loops = boundary_loops(mesh_, sides);
        std::vector<bool> flags(mesh_.points().size(), false);
        for (const index v : loops[report().start.outline]) flags[static_cast<std::size_t>(v)] = true;
        return flags;
    }

    void solve_in(precision how, const std::shared_ptr<const layout<triangle>>& local)
    {
        if (how == precision::full) return solve_with<double, double>(local);
        if (how == precision::mixed) return solve_with<double, float>(local);
        solve_with<float, float>(local);
    }

    template <class P, class R>
    void solve_with(const std::shared_ptr<const layout<triangle>>& local)
    {
        problem<triangle, P, R> f(queue_, local, params_.energy, params_.weights);
        auto x = f.make_point();
        auto start = report().start.uv;
        for (vec2& p : start) p -= centre_;
        f.upload(start, x);
        // Drivers compile at the first launch; that is start-up, not solving.
        f.warm_up(x);
        report().seconds.device += watch_.lap();

        auto p = params_.solve;
        p.stopping.time_limit = params_.time_limit - std::chrono::duration<double>(watch_.total());
        p.stopping.time_limit = std::max(p.stopping.time_limit, std::chrono::duration<double>(1e-9));
        report().solve = solve::minimize(f, x, p, params_.observer);
        result_.uv = f.download(x);
        restore(*local);
        report().seconds.solve += watch_.lap();
    }

    /// Undoes what the solver was free to change without anyone asking for it.
    void restore(const layout<triangle>& local)
    {
        if (params_.boundary == boundary_mode::free && is_scale_invariant(params_.energy)) keep_total_area();
        for (vec2& p : result_.uv) p += centre_;
        // The device may hold positions in float; pinned vertices are the start's, bit for bit.
        for (index v = local.free_count; v < local.vertex_count; ++v)
        {
            const auto old = static_cast<std::size_t>(local.order.vertices.new_to_old[static_cast<std::size_t>(v)]);
            result_.uv[old] = report().start.uv[old];
        }
    }

    /// Scales the map to the area of the surface.
    void keep_total_area()
    {
        double rest = 0, mapped = 0;
        for (std::size_t c = 0; c < ideal_->measure.size(); ++c)
        {
            rest += ideal_->measure[c];
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
        auto& used = report().counters;
        used = queue_.counters();
        used.launches -= counters_.launches;
        used.waits -= counters_.waits;
        used.bytes_read -= counters_.bytes_read;
        used.bytes_written -= counters_.bytes_written;
        used.builds -= counters_.builds;
        used.build_seconds -= counters_.build_seconds;
    }

    queue queue_;
    double unit_;
    mesh<triangle> mesh_;
    parameterize_params params_;
    queue_counters counters_;
    stopwatch watch_;
    std::optional<ideal_elements<triangle>> ideal_;
    vec2 centre_{0};
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
