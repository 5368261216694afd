// SPDX-License-Identifier: MIT
// Launches the kernels of a problem, so that vectorized.sh can look at what the driver made of them. Exit status 77:
// the device does not leave its machine code where the script could find it.
#include <cstdio>

#include <support/meshes.hpp>

#include <taut/energy/isometric.hpp>
#include <taut/objective/map_objective.hpp>

namespace
{

template <class P, class R>
void launch_all(taut::queue& q, const taut::mesh<taut::triangle>& surface)
{
    const auto local = std::make_shared<const taut::layout<taut::triangle>>(surface);
    taut::problem<taut::triangle, P, R> f(q, local, taut::energy::isometric{}, taut::energy::weighting::uniform);
    std::vector<taut::vec2> flat;
    for (const auto& p : surface.points()) flat.emplace_back(p.x, p.y);
    auto x = f.make_point();
    f.upload(flat, x);
    f.warm_up(x);
}

} // namespace

int main()
{
    taut::queue q;
    std::printf("%s, %s\n", q.device().platform().c_str(), q.device().name().c_str());
    if (q.device().platform() != "Portable Computing Language" || !q.device().is_cpu()) return 77;
    const auto surface = taut::test::bumpy(8);
    launch_all<double, double>(q, surface);
    launch_all<double, float>(q, surface);
    launch_all<float, float>(q, surface);
    return 0;
}
