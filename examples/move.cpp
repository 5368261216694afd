// SPDX-License-Identifier: MIT
// The outer boundary of a map stays, 45 vertices inside are carried off, and the rest follows without a fold (the
// paper's figures 3 and 14): before and after, side by side.
//   move SURFACE [OUT.svg]
#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include <picture/layout_svg.hpp>
#include <picture/side_by_side_svg.hpp>
#include <picture/symmetric_distortion.hpp>
#include <taut/taut.hpp>

using namespace taut;

/// So many vertices inside a map, each as far as can be from the boundary and those before it.
std::vector<taut::idx> spread_out(const std::vector<vec2>& uv, const std::vector<taut::idx>& boundary, int count)
{
    std::vector<double> distance(uv.size(), INFINITY);
    const auto approach = [&](taut::idx from)
    {
        for (std::size_t v = 0; v < uv.size(); ++v)
            distance[v] = std::min(distance[v], glm::distance(uv[v], uv[static_cast<std::size_t>(from)]));
    };
    for (const taut::idx v : boundary) approach(v);
    std::vector<taut::idx> chosen;
    while (static_cast<int>(chosen.size()) < count)
    {
        const auto farthest = std::max_element(distance.begin(), distance.end());
        if (*farthest == 0) break; // a small mesh
        chosen.push_back(static_cast<taut::idx>(farthest - distance.begin()));
        approach(chosen.back());
    }
    return chosen;
}

int main(int argc, char** argv)
try
{
    if (argc < 2)
    {
        std::cerr << "usage: move SURFACE [OUT.svg]\n";
        return 2;
    }
    queue q;
    const auto surface = io::read_surface(argv[1]);
    const auto free = parameterize(q, surface);
    if (!free) return 1;

    // [move]
    const auto boundary = boundary_loops(surface).front();
    const auto inside = spread_out(free.uv, boundary, 45);
    const auto centre = free.uv[static_cast<std::size_t>(inside.front())];
    double radius = INFINITY;
    for (const auto v : boundary)
        radius = std::min(radius, glm::distance(centre, free.uv[static_cast<std::size_t>(v)]));
    const auto swirl = [&](const vec2& p) // a third of a turn at the centre, nothing at the boundary
    {
        const double a = 2.1 * std::max(0.0, 1 - glm::distance(p, centre) / radius), c = std::cos(a), s = std::sin(a);
        return centre + mat2(c, s, -s, c) * (p - centre);
    };
    const auto wanted = taut::constraints(surface).fix(boundary, free.uv).move(inside, free.uv, swirl);
    const auto moved = parameterize(q, surface, {.constraints = wanted});
    // [move]
    if (!moved)
    {
        std::cerr << moved.reason() << '\n';
        return 1;
    }

    auto torn = free.uv; // what was carried off without the rest
    for (const auto& [v, pin] : wanted.pins()) torn[static_cast<std::size_t>(v)] = pin.value;
    const auto& cells = surface.cells();
    const auto folded = certify<2>(cells, torn).flipped;
    if (argc > 2)
    {
        io::layout_overlay pins;
        for (const auto v : inside)
        {
            const auto i = static_cast<std::size_t>(v);
            pins.pins.push_back({free.uv[i], torn[i]});
        }
        const auto picture = [&](const std::vector<vec2>& uv, const char* title)
        {
            return io::layout_svg(uv, cells, io::symmetric_distortion(surface.points(), cells, uv),
                                  boundary_loops(surface), {.title = title}, pins);
        };
        const io::layout_style size;
        const std::vector<std::string> pictures{picture(torn, "before"), picture(moved.uv, "after")};
        io::write_file(argv[2], io::side_by_side_svg(pictures, size.width, size.height, 24));
    }
    std::cout << inside.size() << " vertices moved, " << folded << " triangles folded before; " << moved.report << '\n';
}
catch (const error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
