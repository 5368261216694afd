// SPDX-License-Identifier: MIT
// change_points IN OUT DESCRIPTION: writes IN with every second point moved to (2x + y, y - 3z, z + 0.5), in the plane
// (2x + y, y - 3x), and a text that says what was read.
#include <charconv>
#include <fstream>
#include <iostream>

#include <taut/impl/files/volume/write_volume.hpp>
#include <taut/volume_file.hpp>

namespace
{

using namespace taut;

std::string digits(double x)
{
    char text[32];
    return {text, std::to_chars(text, std::end(text), x).ptr};
}

void describe(std::ostream& out, const io::volume_file& file)
{
    out << "dimension " << file.dimension << '\n';
    for (const vec3& p : file.points)
        out << "point " << digits(p.x) << ' ' << digits(p.y) << ' ' << digits(p.z) << '\n';
    for (const auto& block : file.cells)
        for (std::size_t c = 0; c < block.size(); ++c)
        {
            out << "cell " << io::impl::shape_of(block.kind).name;
            for (const idx v : block.cell(c)) out << ' ' << v;
            out << '\n';
        }
    for (const auto& group : file.groups)
    {
        out << "group " << group.name << ' ' << group.dimension;
        for (const idx v : group.vertices) out << ' ' << v;
        out << '\n';
    }
}

} // namespace

int main(int argc, char** argv)
try
{
    if (argc != 4) return 2;
    const auto file = io::read_volume_file(argv[1]);
    std::ofstream out(argv[3]);
    describe(out, file);
    auto points = file.points;
    for (std::size_t v = 0; v < points.size(); v += 2)
    {
        const vec3 p = points[v];
        points[v] = file.places.per_point == 2 ? vec3(2 * p.x + p.y, p.y - 3 * p.x, 0)
                                               : vec3(2 * p.x + p.y, p.y - 3 * p.z, p.z + 0.5);
    }
    file.write(argv[2], points);
    return 0;
}
catch (const taut::error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
