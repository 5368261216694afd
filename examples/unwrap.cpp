// SPDX-License-Identifier: MIT
// [unwrap]
#define TAUT_IMPLEMENTATION // in one file of a program
#include <iostream>
#include <taut/parameterize.hpp>
#include <taut/queue.hpp>
#include <taut/surface_file.hpp>

int main(int argc, char** argv)
// [unwrap]
try
// [unwrap]
{
    auto mesh = taut::io::read_surface(argc > 1 ? argv[1] : "surface.obj");
    taut::queue queue;                                   // $TAUT_DEVICE, else the best device
    auto [uv, report] = taut::parameterize(queue, mesh); // certified: no flips, no branch points
    std::cout << queue.device() << '\n' << report << '\n';
    taut::io::write_obj("flat.obj", mesh, uv);
}
// [unwrap]
catch (const taut::error& e) // of the file, the mesh, the device: what is wrong, and the remedy
{
    std::cerr << e.what() << '\n';
    return 1;
}
