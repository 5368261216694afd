// SPDX-License-Identifier: MIT
// model IN.glb|IN.obj OUT.glb: a model of glTF, or a surface as a new one, with an atlas as its texture coordinates.
#include <iostream>
#include <taut/atlas.hpp>
#include <taut/gltf.hpp>
#include <taut/read.hpp>

using namespace taut;

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
    // Certified as it is stored.
    const auto atlas = make_atlas(q, surface, {.origin = {0, -1}, .stored = io::gltf_model::stored<>});
    std::cout << atlas.report << '\n';

    auto uv = atlas.corner_uv();
    for (auto& triangle : uv)
        for (vec2& x : triangle) x.y = -x.y; // v downwards
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
