// SPDX-License-Identifier: MIT
// Launches the kernels of an objective, so that vectorized.sh can look at what the driver made of them. Exit status 77:
// the device does not leave its machine code where the script could find it.
#include <cstdio>

#include <support/meshes.hpp>

#include <taut/energies.hpp>
#include <taut/impl/core/objective/map_objective.hpp>

namespace
{

void launch_all(taut::queue& q, const taut::mesh<taut::triangle>& surface, taut::precision how)
{
    const auto local = std::make_shared<const taut::impl::layout<taut::triangle>>(surface);
    taut::impl::map_objective<taut::triangle> f(q, local, taut::energy::isometric{}, taut::energy::weighting::uniform,
                                                taut::impl::types_of(how));
    std::vector<taut::vec2> flat;
    for (const auto& p : surface.points()) flat.emplace_back(p.x, p.y);
    auto x = f.make_point();
    f.upload(flat, x);
    f.warm_up(x);
    f.value(x);
}

} // namespace

int main()
{
    taut::queue q;
    std::printf("%s, %s\n", q.device().platform().c_str(), q.device().name().c_str());
    if (q.device().platform() != "Portable Computing Language" || !q.device().is_cpu()) return 77;
    const auto surface = taut::test::bumpy(8);
    for (const auto how : {taut::precision::fp64, taut::precision::mixed, taut::precision::fp32})
        launch_all(q, surface, how);
    return 0;
}
