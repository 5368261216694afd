// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstddef>
#include <iostream>
#include <memory>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/compute/program/signature.hpp>
#include <taut/impl/core/compute/record.hpp>
#include <taut/impl/core/objective/element_hessian.hpp>
#include <taut/impl/core/objective/mesh_levels.hpp>
#include <taut/impl/core/objective/newton_plan.hpp>
#include <taut/impl/core/objective/volume_objective.hpp>
#include <taut/impl/core/sparse/block_assembly.hpp>
#include <taut/impl/core/sparse/multigrid.hpp>

#include "commands.hpp"
#include "shared/shared_options.hpp"

namespace taut::tools
{

namespace
{

struct build_options
{
    int dimension = 2;
    std::string real, device;
};

/// A square or a cube of n points a side. In each of its small ones, each way along the axes from the first corner to
/// the last is a cell (Kuhn).
template <class Element>
mesh<Element> block(idx n)
{
    constexpr std::size_t D = Element::dimension;
    const std::array<idx, 3> steps = {1, n, n * n};
    std::vector<vec3> points;
    std::vector<typename mesh<Element>::cell> cells;
    for (idx k = 0; k < (D == 3 ? n : 1); ++k)
        for (idx j = 0; j < n; ++j)
            for (idx i = 0; i < n; ++i)
            {
                points.emplace_back(i, j, k);
                if (std::max({i, j, D == 3 ? k : 0}) + 1 == n) continue;
                std::array<std::size_t, D> way;
                std::iota(way.begin(), way.end(), std::size_t(0));
                do {
                    auto& cell = cells.emplace_back();
                    cell[0] = static_cast<idx>(points.size()) - 1;
                    for (std::size_t c = 0; c < D; ++c) cell[c + 1] = cell[c] + steps[way[c]];
                    const int turns =
                        D == 2 ? way[0] > way[1] : (way[0] > way[1]) + (way[0] > way[D - 1]) + (way[1] > way[D - 1]);
                    if (turns % 2 == 1) std::swap(cell[D - 1], cell[D]);
                } while (std::next_permutation(way.begin(), way.end()));
            }
    return {std::move(points), std::move(cells)};
}

/// Launches what matrices of a mesh of so many points a side launch, once: drivers compile at the first launch.
template <class Element>
void build(queue& q, scalar_type real, idx side)
{
    const impl::mesh_levels<Element> levels(block<Element>(side));
    impl::newton_plan<Element> plan(levels, 0, impl::lane_form::for_device(q.device()));
    impl::multigrid cycle(q, real, std::move(plan.cycle));
    const impl::block_assembly assemble(cycle.matrix(), plan.assembly);
    real_buffer hessians(q, real, impl::hessian_slots<Element::dimension>::count * plan.layout->cell_stride);
    hessians.fill(0);
    auto x = cycle.matrix().vector(), y = cycle.matrix().vector();
    assemble(hessians, cycle.matrix());
    cycle.refresh();
    cycle.matrix().multiply(x, y);
    cycle.apply(x, y);
    q.finish();
}

/// Launches kernels once that standard input names: build options, names, and the source of recorded kernels, which do
/// nothing for no indices.
void build_named(queue& q)
{
    std::string options, names, source;
    std::getline(std::cin, options);
    std::getline(std::cin, names);
    std::getline(std::cin, source, '\0');
    const buffer<double> nothing(q, 1);
    std::istringstream each(names);
    for (std::string name; each >> name;)
    {
        std::vector<kernel::argument> arguments;
        for (const auto& p : impl::signature_of(source, name, scalar_type::f64))
        {
            const kernel::argument number = p.type == "int" ? kernel::argument(idx(0)) : impl::number_of(p.type, 0);
            arguments.push_back(p.is_memory ? kernel::argument(nothing) : number);
        }
        kernel(q, source, name, options)(impl::items_for(kernel_form::run, 1), arguments);
    }
    q.finish();
}

exit_code run(const build_options& options)
{
    queue q(options.device.empty() ? find_device() : find_device(options.device, {}, "--device "));
    if (options.real.empty())
    {
        build_named(q);
        return exit_code::valid;
    }
    const auto real = options.real == impl::spelling(scalar_type::f64) ? scalar_type::f64 : scalar_type::f32;
    // With levels, and without.
    for (const idx side : options.dimension == 2 ? std::array{48, 4} : std::array{16, 3})
        options.dimension == 2 ? build<triangle>(q, real, side) : build<tetrahedron>(q, real, side);
    return exit_code::valid;
}

} // namespace

command add_build_kernels(command_line& program)
{
    const auto options = std::make_shared<build_options>();
    const auto app =
        program.add_subcommand("build-kernels", "Compile kernels into the driver's cache: those of matrices, or "
                                                "those that standard input names");
    app.hide();
    app.add_option("dimension", options->dimension).check_range(2, 3);
    app.add_option("real", options->real);
    add_device(app, options->device);
    return [options](const outputs&) { return run(*options); };
}

} // namespace taut::tools
