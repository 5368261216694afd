// SPDX-License-Identifier: MIT
// volume_file IN OUT GROUP: lifts a named group of a volume mesh, and writes the mesh as it was but for coordinates.
#include <iostream>
#include <taut/taut.hpp>

int main(int argc, char** argv)
try
{
    if (argc != 4) throw taut::error("volume_file IN OUT GROUP");
    // [move]
    const auto file = taut::io::read_volume_file(argv[1]);
    const auto mesh = file.tetrahedra();
    auto points = file.points;
    const auto& group = file.find_group(argv[3]); // "inlet", "triangles:2", or 2 if one group ends so
    for (const taut::idx v : group.vertices) points[static_cast<std::size_t>(v)].z += 0.25;

    const auto kept = file.rounded(points); // what single precision would make of them
    const auto flipped = taut::certify<3>(mesh.cells(), std::span<const taut::vec3>(kept)).flipped;
    file.write(argv[2], points); // every other byte as it was
    // [move]
    std::cout << group.vertices.size() << " of " << points.size() << " vertices moved, " << flipped << " of "
              << mesh.cell_count() << " tetrahedra flipped\n";
}
catch (const taut::error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
