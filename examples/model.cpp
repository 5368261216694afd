// SPDX-License-Identifier: MIT
// model IN.glb|IN.obj OUT.glb: a model of glTF, or a surface as a new one, with an atlas as its texture coordinates.
#include <iostream>
#include <taut/atlas.hpp>
#include <taut/gltf.hpp>
#include <taut/read.hpp>

using namespace taut;

// [stored]
/// Coordinates as the file will hold them: floats, of v that runs downwards.
vec2 in_gltf(vec2 x)
{
    const vec2 y = io::gltf_model::rounded({x.x, -x.y});
    return {y.x, -y.y};
}
// [stored]

io::gltf_model read(const std::filesystem::path& path)
{
    if (io::is_gltf(path)) return io::read_gltf(path);
    const auto surface = io::read_surface(path);
    return io::gltf_model(surface.points(), surface.cells());
}

int main(int argc, char** argv)
try
{
    if (argc != 3) return 2;
    queue q;
    const auto model = read(argv[1]); // io::read_gltf(), or gltf_model() of other surfaces
    // [atlas]
    const mesh<triangle> surface(model.points, model.triangles);
    const auto atlas = make_atlas(q, surface, {.origin = {0, -1}, .stored = in_gltf}); // certified as it is stored
    std::cout << atlas.report << '\n';

    std::vector<std::array<vec2, 3>> uv(model.triangles.size());
    const auto corners = atlas.corners();
    for (std::size_t t = 0; t < uv.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const vec2 x = atlas.uv[static_cast<std::size_t>(corners[t][k])];
            uv[t][k] = {x.x, -x.y};
        }
    model.write(argv[2], uv);
    // [atlas]
    if (!atlas) std::cerr << atlas.report.reason << '\n';
    return atlas ? 0 : 1;
}
catch (const error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
