// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <taut/options.hpp>
#include <taut/solve_params.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// The lengths of the steps of a stage.
class step_tally
{
public:
    void add(double length, bool cut)
    {
        lengths_.push_back(length);
        cut_ += cut;
    }

    void tell(stage_report& did)
    {
        did.steps_cut = cut_;
        if (lengths_.empty()) return;
        const auto middle = lengths_.begin() + static_cast<std::ptrdiff_t>(lengths_.size() / 2);
        std::nth_element(lengths_.begin(), middle, lengths_.end());
        did.step_median = *middle;
    }

private:
    std::vector<double> lengths_;
    int cut_ = 0;
};

/// Stage report of a minimisation.
inline stage_report stage_of(std::string name, std::size_t level, std::size_t vertices, const solve::report& r)
{
    stage_report did{.stage = std::move(name),
                     .level = level,
                     .vertices = vertices,
                     .iterations = r.iterations,
                     .energy_before = r.value_start,
                     .energy_after = r.value,
                     .stop = std::string(to_string(r.stop))};
    step_tally steps;
    for (std::size_t i = 1; i < r.history.size(); ++i) steps.add(r.history[i].step, r.history[i].capped);
    steps.tell(did);
    return did;
}

/// Corners of chosen cells, each once. numbers: the user's numbers of the vertices; none: they are the same.
template <class Cells>
std::vector<idx> corners_of(const Cells& cells, const std::vector<int>& chosen, const std::vector<idx>& numbers = {})
{
    std::vector<idx> corners;
    for (const int c : chosen)
        for (const idx v : cells[static_cast<std::size_t>(c)])
            corners.push_back(numbers.empty() ? v : numbers[static_cast<std::size_t>(v)]);
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    return corners;
}

/// Log of the stages of a run in their order in time. Each has the time since the previous one.
class stage_log
{
public:
    /// Adds a stage that has just ended, and sets its seconds.
    void add(stage_report did)
    {
        const auto now = clock::now();
        did.seconds = std::chrono::duration<double>(now - std::exchange(mark_, now)).count();
        stages_.push_back(std::move(did));
    }

    /// Adds the stages of a part of the run with its own log that has just ended.
    template <class Stages>
    void append(const Stages& part)
    {
        for (const stage_report& s : part)
        {
            mark_ += std::chrono::duration_cast<clock::duration>(std::chrono::duration<double>(s.seconds));
            stages_.push_back(s);
        }
    }

    const std::vector<stage_report>& stages() const { return stages_; }

private:
    using clock = std::chrono::steady_clock;

    clock::time_point mark_ = clock::now();
    std::vector<stage_report> stages_;
};

} // namespace taut::impl
