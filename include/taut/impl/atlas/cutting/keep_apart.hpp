// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/atlas/crossing_charts.hpp>
#include <taut/impl/atlas/flat_charts.hpp>

namespace taut::impl
{

inline void flat_charts::keep_apart(std::vector<char>& bad, bool roughly)
{
    constexpr idx most = 32;          // one by one: more would take long
    constexpr idx rough_most = 20000; // triangles
    const double begin = budget_.total();
    idx mended = 0, tried = 0;
    for (std::size_t k = 0; k < bad.size(); ++k)
    {
        if (!bad[k] || !report_.complete || tried == most) continue;
        if (roughly && charts_->first_cell[k + 1] - charts_->first_cell[k] > rough_most) continue;
        ++tried;
        const idx first = charts_->first_vertex[k], end = charts_->first_vertex[k + 1];
        std::vector<vec3> points(charts_->surface.points().begin() + first, charts_->surface.points().begin() + end);
        std::vector<std::array<idx, 3>> cells(charts_->surface.cells().begin() + charts_->first_cell[k],
                                              charts_->surface.cells().begin() + charts_->first_cell[k + 1]);
        for (auto& t : cells)
            for (idx& v : t) v -= first;
        parameterize_params params{.initial = {flat_.begin() + first, flat_.begin() + end},
                                   .placement = placement::as_solved,
                                   .holes = true,
                                   .no_overlap = true,
                                   .limits = {std::max(budget_.left(), budget::seconds(1e-6)), asking("flatten")}};
        if (roughly)
        {
            params.solve.stopping = rough_stopping();
            params.solve.stopping.max_iterations = 100;
            params.precision = rough_precision(queue_);
        }
        const mesh<triangle> chart(std::move(points), std::move(cells));
        if (!check(chart, {.one_boundary = false}).empty()) continue;
        const auto map = parameterize(queue_, chart, params);
        if (!map) continue;
        std::copy(map.uv.begin(), map.uv.end(), flat_.begin() + first);
        energy_[k] = map.report.solve.value;
        bad[k] = 0;
        ++mended;
    }
    if (mended > 0)
    {
        const auto crossing = crossing_charts(*charts_, flat_);
        for (std::size_t k = 0; k < bad.size(); ++k) bad[k] = bad[k] != 0 || crossing[k] != 0;
        auto note = std::to_string(mended) +
                    (mended == 1 ? " chart that overlapped itself was mapped anew with its border kept apart"
                                 : " charts that overlapped themselves were mapped anew with borders kept apart");
        auto& notes = report_.notes;
        if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(std::move(note));
    }
    report_.seconds.flatten += budget_.total() - begin;
}

} // namespace taut::impl
