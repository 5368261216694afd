// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <exception>
#include <span>
#include <string>
#include <utility>

#include <taut/impl/charts/paste/attach/seam.hpp>
#include <taut/impl/charts/paste/paste_report.hpp>
#include <taut/impl/charts/paste/region.hpp>
#include <taut/parameterize.hpp>
#include <taut/paste.hpp>

namespace taut::impl
{

/// The region around a vertex of the target with its map. Throws region_error, paste_error.
inline landing_place make_place(queue& q, const mesh<triangle>& target, idx onto, double radius, double covered,
                                paste_report& report)
{
    using clock = std::chrono::steady_clock;
    const auto start = clock::now();
    landing_place place{.region = geodesic_disk(target, onto, radius), .uv = {}, .centre = 0, .normal = vec3(0.0)};
    const auto& surface = place.region.surface;
    place.centre = static_cast<idx>(std::lower_bound(place.region.vertices.begin(), place.region.vertices.end(), onto) -
                                    place.region.vertices.begin());
    const vec3 centre = target.points()[static_cast<std::size_t>(onto)];
    for (idx f = 0; f < surface.cell_count(); ++f)
    {
        const auto x = surface.rest(f);
        const auto& t = surface.cells()[static_cast<std::size_t>(f)];
        if (glm::distance((x[0] + x[1] + x[2]) / 3.0, centre) <= covered ||
            std::find(t.begin(), t.end(), place.centre) != t.end())
            place.normal += glm::cross(x[1] - x[0], x[2] - x[0]);
    }
    if (!(glm::length(place.normal) > 0))
        throw paste_error("the surface around the target vertex has no normal; choose another vertex or another scale");
    place.normal = glm::normalize(place.normal);
    const auto mapped = clock::now();
    report.seconds.region = std::chrono::duration<double>(mapped - start).count();

    auto map = parameterize(q, surface, {.placement = placement::as_solved});
    report.seconds.map = std::chrono::duration<double>(clock::now() - mapped).count();
    if (!map) throw paste_error("the surface around the target vertex has no map: " + map.reason());
    place.uv = std::move(map.uv);
    if (boundary_crossings(std::span(&place.region.rim, 1), place.uv) > 0)
        throw paste_error(
            "the map of the surface around the target vertex covers itself; choose a smaller scale or reach");
    return place;
}

/// Site of a paste: the target region, its map and the image of the rim.
struct site
{
    landing_place place;
    landing rim;
    seam room;
};

/// Chooses the site with the given reach, or else with larger and smaller ones, as far as they leave room for the rim.
/// Throws the error of the first: region_error, paste_error.
inline site choose_site(queue& q, const mesh<triangle>& target, const feature& part, idx onto,
                        const paste_params& params, paste_report& report)
{
    require_in_range(std::array{onto}, target.vertex_count(), "vertex", "vertices");
    const double covered = params.pose.scale * part.radius;
    double edge = 0; // the longest one at the vertex: the rim needs some triangles around it
    for (const auto& t : target.cells())
        for (std::size_t k = 0; k < 3; ++k)
            if (t[k] == onto)
                for (const idx w : t)
                    edge = std::max(edge, glm::distance(target.points()[static_cast<std::size_t>(w)],
                                                        target.points()[static_cast<std::size_t>(onto)]));
    std::exception_ptr first;
    for (const double factor : {1.0, 1.35, 0.85, 0.7})
    {
        const double radius = factor * params.reach * covered + 3 * edge;
        if (radius < 1.15 * covered) continue;
        try
        {
            auto place = make_place(q, target, onto, radius, covered, report);
            using clock = std::chrono::steady_clock;
            const auto start = clock::now();
            auto rim = land(part, place, params.pose.scale, params.pose.turn);
            const auto landed = clock::now();
            report.seconds.land = std::chrono::duration<double>(landed - start).count();
            auto room = make_seam(place, rim.uv);
            report.seconds.seam = std::chrono::duration<double>(clock::now() - landed).count();
            return {std::move(place), std::move(rim), std::move(room)};
        }
        catch (const region_error&)
        {
            if (!first)
                first = std::make_exception_ptr(paste_error(
                    "there is no room for the feature: as far as it reaches around vertex " + std::to_string(onto) +
                    " the target is no disk; choose a smaller scale, radius or reach, or another vertex"));
        }
        catch (const paste_error&)
        {
            if (!first) first = std::current_exception();
        }
    }
    std::rethrow_exception(first);
}

} // namespace taut::impl
