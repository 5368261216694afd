// SPDX-License-Identifier: MIT
// An interactive session: a vertex of a map is dragged, as by a hand in an editor; each frame goes on from the last.
//   drag SURFACE
#include <chrono>
#include <iostream>

#include <taut/taut.hpp>

using namespace taut;

int main(int argc, char** argv)
try
{
    if (argc < 2)
    {
        std::cerr << "usage: drag SURFACE\n";
        return 2;
    }
    using namespace std::chrono_literals;
    queue q;
    const auto surface = io::read_surface(argv[1]);

    // [drag]
    session s(q, surface);
    if (const auto first = s.solve(); !first) // as parameterize()
    {
        std::cerr << first.reason() << '\n';
        return 1;
    }
    const auto boundary = boundary_loops(surface).front();
    const taut::idx left = boundary[0], right = boundary[boundary.size() / 2], held = surface.vertex_count() / 2;
    const auto place = [&](taut::idx v) { return s.x()[static_cast<std::size_t>(v)]; };
    s.pin(left, place(left)).pin(right, place(right));

    const vec2 from = place(held), way = 0.1 * (place(right) - place(left));
    for (int frame = 1; frame <= 30; ++frame)
    {
        const auto [uv, report] = s.pin(held, from + way * (frame / 30.0)).solve({.time = 15ms});
        // Here it would be drawn. The map is injective in each frame; report.distance says how far the pin is ahead.
    }
    const auto rest = s.solve(); // until it has converged
    // [drag]

    const bool exact = rest.x[static_cast<std::size_t>(held)] == from + way;
    std::cout << "E " << rest.report.energy << (rest.report.converged ? ", converged, pin " : ", pin ")
              << (exact ? "exact" : "moved") << ", " << rest.report.flips.flipped << " flipped\n";
}
catch (const error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
