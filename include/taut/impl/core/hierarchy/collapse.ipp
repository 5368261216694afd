// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include <taut/impl/core/hierarchy/collapse.hpp>

namespace taut::impl
{

double fan_quality(const flat_star& s, std::size_t t, double normal_length, double enough, bool may_fold)
{
    double worst = 1;
    for (std::size_t i = 0; i < s.triangles(); ++i)
    {
        const std::size_t j = s.next(i);
        if (i == t || j == t) continue;
        const vec2 a2 = s.corner[i] - s.corner[t], b2 = s.corner[j] - s.corner[t], c2 = b2 - a2;
        const double flat = triangle_quality(cross(a2, b2), glm::dot(a2, a2) + glm::dot(b2, b2) + glm::dot(c2, c2));
        if (!(flat > 1e-3)) return 0;
        const vec3 a = s.spoke[i] - s.spoke[t], b = s.spoke[j] - s.spoke[t], c = b - a;
        const vec3 n = glm::cross(a, b);
        const double area = glm::length(n), lean = glm::dot(n, s.normal);
        if (!(lean > 0) && !may_fold) return 0;
        const double shape = triangle_quality(area, glm::dot(a, a) + glm::dot(b, b) + glm::dot(c, c));
        const double facing = lean > 0 ? 0.4 + 0.6 * lean / (area * normal_length) : 0.1;
        worst = std::min({worst, flat, shape * facing});
        if (!(worst > enough)) return 0;
    }
    return worst;
}

bool breaks_surface(const thinning_surface& m, std::span<const idx> ring, bool open, std::size_t t)
{
    const idx u = ring[t];
    const int n = static_cast<int>(ring.size());
    for (const idx w : m.rings[u])
    {
        const int at = find(ring, w);
        if (at >= 0 && !consecutive(at, static_cast<int>(t), n, open)) return true;
    }
    // Two triangles back to back would be left of a tetrahedron.
    if (n == 3 && !open && m.rings[u].size() == 3 && !m.open[static_cast<std::size_t>(u)]) return true;
    if (!m.keep[static_cast<std::size_t>(u)]) return false;
    for (std::size_t i = 0; i + (open ? 1 : 0) < ring.size(); ++i)
    {
        const std::size_t j = i + 1 < ring.size() ? i + 1 : 0;
        if (i != t && j != t && m.keep[static_cast<std::size_t>(ring[i])] && m.keep[static_cast<std::size_t>(ring[j])])
            return true;
    }
    return false;
}

int choose_target(const thinning_surface& m, idx v, const flat_star& s, const collapse_rules& rules)
{
    const auto ring = m.rings[v];
    if (s.open && s.angle < rules.sharpest_corner * std::numbers::pi) return -1;
    const double normal_length = glm::length(s.normal);
    // Where the surface has worse triangles, as in a strip of needles, it need not become better at once.
    const double least = std::min(rules.quality, 0.9 * star_quality(s));
    std::array<double, largest_star> liked{};
    for (std::size_t t = 0; t < s.size; ++t)
    {
        if (s.open && t != 0 && t + 1 != s.size) continue;
        // Hubs are unwelcome: their stars cannot be removed later.
        const auto valence = m.rings[ring[t]].size() + s.size - 4;
        liked[t] = valence <= 7 ? 1.0 : valence <= 9 ? 0.7 : valence <= 11 ? 0.3 : 0.1;
    }
    const auto quality = [&](std::size_t t, double enough)
    { return liked[t] > 0 ? liked[t] * fan_quality(s, t, normal_length, enough, rules.may_fold) : 0.0; };

    double best = 0;
    std::size_t target = 0;
    for (std::size_t t = 0; t < s.size; ++t)
    {
        if (liked[t] <= best) continue;
        const double here = quality(t, std::max(least, best / liked[t]));
        if (here <= best) continue;
        best = here;
        target = t;
    }
    if (best == 0) return -1;
    if (!breaks_surface(m, ring, s.open, target)) return static_cast<int>(target);

    // The others, of which half the quality of the best is good enough.
    std::array<double, largest_star> rest{};
    for (std::size_t t = 0; t < s.size; ++t)
        if (t != target) rest[t] = quality(t, std::max(least, 0.5 * best));
    for (;;)
    {
        const auto top = std::max_element(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(s.size));
        if (!(*top > 0)) return -1;
        const auto t = static_cast<std::size_t>(top - rest.begin());
        if (!breaks_surface(m, ring, s.open, t)) return static_cast<int>(t);
        *top = 0;
    }
}

} // namespace taut::impl
