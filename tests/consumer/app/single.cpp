// SPDX-License-Identifier: MIT
// A program of one file: it compiles the bodies of what it includes, and no others.
#define TAUT_IMPLEMENTATION
#include <filesystem>
#include <iostream>

#include <taut/parameterize.hpp>
#include <taut/read.hpp>
#include <taut/write.hpp>

int main()
{
    const taut::mesh<taut::triangle> roof({{0, 0, 0}, {1, 0, 1}, {2, 0, 0}, {0, 1, 0}, {1, 1, 1}, {2, 1, 0}},
                                          {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}});
    taut::queue queue;
    const auto result = taut::parameterize(queue, roof);
    taut::io::write_obj("roof.obj", roof, result.uv);
    const auto read = taut::io::read_surface("roof.obj");
    std::filesystem::remove("roof.obj");
    std::cout << result.report << '\n';
    return result && read.cell_count() == 4 ? 0 : 1;
}
