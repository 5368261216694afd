// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <support/chart_checks.hpp>
#include <taut/certify.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>
#include <taut/impl/core/start/isometric_newton.hpp>

namespace taut::test
{

/// Charts flattened on the host, each by itself, by Newton's method with a direct solver: an oracle, and a stand-in
/// where there is no device.
struct host_maps
{
    struct report
    {
        double energy = std::numeric_limits<double>::infinity();
        bool valid = false;
    };

    std::vector<vec2> uv;
    std::vector<report> charts;
};

/// A chart of a size near 1.
inline host_maps::report flatten_on_host(const mesh<triangle>& m, std::span<vec2> uv)
{
    const std::vector<char> fixed(m.points().size(), 0);
    impl::isometric_newton newton(m.points(), m.cells(), fixed);
    std::vector<vec2> x = impl::barycentric_map(m, impl::facets(m), {.stretch_rounds = 2}).uv;
    host_maps::report report;
    double energy = newton.value(x);
    for (int i = 0; i < 60 && energy < std::numeric_limits<double>::infinity(); ++i)
    {
        const double before = energy;
        energy = newton.step(x, before);
        if (before - energy < 1e-4 * (energy - 4) + 1e-9) break;
    }
    report.energy = energy;
    report.valid = bool(certify<2>(m.cells(), std::span<const vec2>(x)));
    std::copy(x.begin(), x.end(), uv.begin());
    return report;
}

inline host_maps flatten_on_host(const chart_mesh& charts)
{
    host_maps maps{std::vector<vec2>(charts.surface.points().size(), vec2(0.0)), {}};
    for (idx k = 0; k < charts.charts(); ++k)
        maps.charts.push_back(flatten_on_host(
            chart(charts, k),
            std::span(maps.uv).subspan(static_cast<std::size_t>(charts.first_vertex[static_cast<std::size_t>(k)]))));
    return maps;
}

} // namespace taut::test
