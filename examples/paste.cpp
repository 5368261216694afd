// SPDX-License-Identifier: MIT
// Cut and paste: a feature of one surface on another, moved about while it stays attached.
//   paste SOURCE VERTEX RADIUS TARGET VERTEX [OUT.obj]
#include <cstdlib>
#include <iostream>

#include <taut/paste.hpp>
#include <taut/taut.hpp>

using namespace taut;

int main(int argc, char** argv)
try
{
    if (argc < 6)
    {
        std::cerr << "usage: paste SOURCE VERTEX RADIUS TARGET VERTEX [OUT.obj]\n";
        return 2;
    }
    const auto source = io::read_surface_file(argv[1]), target = io::read_surface_file(argv[4]);
    const taut::idx at = std::atoi(argv[2]), onto = std::atoi(argv[5]);

    // [paste]
    queue q;
    const feature part(geodesic_disk(source.surface, at, std::atof(argv[3])));
    paste p(q, target.surface, part, onto, {.pose = {.scale = 0.5}});
    for (int frame = 0; frame < 10; ++frame) // each costs a back-substitution or two and as many kernels
        p.pose({.turn = 0.1 * frame, .scale = 0.5, .softness = 0.05 * frame});
    const auto once = p.surface(); // the target of the next paste; p.target() is as it was
    // [paste]

    if (argc > 6) p.write(argv[6], target, source);
    const auto seam = p.measure_seam();
    std::cout << p.report().feature_triangles << " triangles pasted, rim " << p.report().way << ", "
              << (seam.manifold ? "manifold" : "not manifold") << ", " << seam.boundary_edges << " boundary edges, "
              << seam.degenerate << " degenerate\n";
}
catch (const error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
