// SPDX-License-Identifier: MIT
// write_models FOLDER: writes models of glTF there as they are (NAME.in.*), and with other texture coordinates
// (NAME.*), for programs that judge them.
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <support/gltf_models.hpp>
#include <taut/files.hpp>
#include <taut/gltf.hpp>

using namespace taut;

namespace
{

/// Charts of `size` triangles in the order of the file, each a square.
std::vector<std::array<vec2, 3>> charts(const io::gltf_model& model, std::size_t size)
{
    std::vector<std::array<vec2, 3>> uv;
    for (std::size_t t = 0; t < model.triangles.size(); ++t)
    {
        std::array<vec2, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
        {
            const vec3& p = model.points[static_cast<std::size_t>(model.triangles[t][k])];
            corners[k] = {std::fmod(0.37 * static_cast<double>(t / size), 1), 0.5 + 0.1 * p.x + 0.01 * p.z};
        }
        uv.push_back(corners);
    }
    return uv;
}

void write_model(const std::filesystem::path& folder, const std::string& name, const test::gltf_builder& builder,
                 int set)
{
    io::write_file(folder / (name + ".in.glb"), builder.glb());
    const auto model = io::read_gltf(folder / (name + ".in.glb"), set);
    for (const std::size_t size : {std::size_t(1), std::size_t(40)})
        for (const char* const ending : {".glb", ".gltf"})
            model.write(folder / (name + '-' + std::to_string(size) + ending), charts(model, size), set);
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2) return 2;
    const std::filesystem::path folder = argv[1];
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    for (const std::uint32_t n : {8u, 15u})
    {
        const std::string size = std::to_string(n);
        write_model(folder, "textured" + size, test::textured_model(n), 0);
        write_model(folder, "second-set" + size, test::textured_model(n), 1);
        write_model(folder, "skinned" + size, test::skinned_model(n), 0);
        write_model(folder, "morphing" + size, test::morphing_model(n), 0);
    }
    const test::torus_arrays torus(110); // more corners than 16 bits number
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> triangles;
    for (std::size_t i = 0; i < torus.positions.size(); i += 3)
        points.emplace_back(torus.positions[i], torus.positions[i + 1], torus.positions[i + 2]);
    for (std::size_t i = 0; i < torus.indices.size(); i += 3)
        triangles.push_back({static_cast<idx>(torus.indices[i]), static_cast<idx>(torus.indices[i + 1]),
                             static_cast<idx>(torus.indices[i + 2])});
    triangles.push_back({-1, 0, 1});
    points.emplace_back(7e7, 0, std::nan(""));
    const auto model = io::gltf_model(points, triangles);
    for (const std::size_t size : {std::size_t(1), std::size_t(40)})
        model.write(folder / ("new-" + std::to_string(size) + ".glb"), charts(model, size));
    for (vec3& p : points) p = 1e30 * (p + vec3(500000, 5400000, 0)); // a node with a translation and a scale
    const auto far = io::gltf_model(points, triangles);
    far.write(folder / "far-40.glb", charts(far, 40), 0, io::gltf_model::numbers::fractions);
}
