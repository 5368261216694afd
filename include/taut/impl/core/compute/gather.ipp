// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <vector>

#include <taut/impl/core/compute/gather.hpp>

namespace taut::impl
{

gather::gather(queue& q, std::span<const idx> offsets, std::span<const idx> cells, std::span<const idx> corners,
               const gather_layout& layout, scalar_type term, scalar_type sum)
    : term_(term), sum_(sum), vertices_(to_int(layout.vertex_stride)), cells_(to_int(layout.cell_stride))
{
    const auto D = static_cast<std::size_t>(layout.components);
    const std::size_t rows = offsets.empty() ? 0 : offsets.size() - 1;
    if (rows > layout.vertex_stride || layout.vertex_stride % 64 != 0)
        throw parameter_error("gather_layout.vertex_stride",
                              "a multiple of 64, at least the number of rows, is needed");
    const auto place = [&](std::size_t k)
    { return static_cast<std::size_t>(corners[k]) * D * layout.cell_stride + static_cast<std::size_t>(cells[k]); };
    if (!cells.empty())
    {
        const std::size_t last = largest_place(cells, layout.cell_stride, place);
        to_int(last); // the kernel computes in int
        reach_ = last + (D - 1) * layout.cell_stride + 1;
    }

    sums_ = D * layout.vertex_stride;

    // As kernels/gather.cl has them.
    const auto plan = reduction_plan::for_device(q.device());
    lanes_ = plan.width;
    const std::size_t slice = lanes_ == 1 ? 32 : lanes_;
    std::vector<idx> starts{0};
    std::size_t end = 0;
    for (std::size_t v = 0; v < layout.vertex_stride; v += slice)
    {
        idx longest = 0;
        for (std::size_t r = v; r < std::min(v + slice, rows); ++r)
            longest = std::max(longest, offsets[r + 1] - offsets[r]);
        end += static_cast<std::size_t>(longest) * slice;
        starts.push_back(to_int(end));
    }
    std::vector<idx> slots(end, -1);
    parallel_for(rows,
                 [&](std::size_t begin, std::size_t last)
                 {
                     for (std::size_t v = begin; v < last; ++v)
                     {
                         auto to = static_cast<std::size_t>(starts[v / slice]) + v % slice;
                         for (auto k = static_cast<std::size_t>(offsets[v]);
                              k < static_cast<std::size_t>(offsets[v + 1]); ++k, to += slice)
                             slots[to] = static_cast<idx>(place(k));
                     }
                 });
    starts_ = buffer<idx>(q, starts);
    slots_ = buffer<idx>(q, slots);
    gather_ = make_kernel(q, vector_program(sum, q.device(), plan),
                          "gather_" + std::string(spelling(term)) + "_" + std::to_string(D));
}

void gather::operator()(const real_buffer& contributions, real_buffer& out) const
{
    if (contributions.type() != term_ || out.type() != sum_)
        throw parameter_error("gather", "buffers of the types that it was made for are needed");
    if (contributions.size() < reach_ || out.size() < sums_)
        throw parameter_error("gather", "buffers of " + std::to_string(reach_) + " contributions and " +
                                            std::to_string(sums_) + " sums are needed");
    if (reach_ == 0) return out.fill(0);
    gather_({static_cast<std::size_t>(vertices_) / lanes_, 64 / lanes_}, vertices_, cells_, starts_, slots_,
            contributions, out);
}

idx gather::to_int(std::size_t n)
{
    if (n > static_cast<std::size_t>(std::numeric_limits<idx>::max()))
        throw size_error("gather", "more than 2^31 contributions");
    return static_cast<idx>(n);
}

} // namespace taut::impl
