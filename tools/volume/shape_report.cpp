// SPDX-License-Identifier: MIT
#include "volume/shape_report.hpp"

#include "shared/text_table.hpp"

namespace taut::tools
{

nlohmann::ordered_json shapes_json(const shape_quality& q)
{
    return {{"mean_ratio", {{"worst", q.worst.mean_ratio}, {"mean", q.mean_ratio}}},
            {"scaled_jacobian", {{"worst", q.worst.scaled_jacobian}, {"mean", q.scaled_jacobian}}},
            {"angle", {{"least", q.worst.min_angle}, {"most", q.worst.max_angle}}},
            {"worst_ids", q.worst_ids}};
}

nlohmann::ordered_json insides_json(const volume_state& state)
{
    return {{"negative", state.negative_inside.size()},
            {"negative_ids", state.negative_inside},
            {"undecided", state.undecided.size()},
            {"undecided_ids", state.undecided}};
}

std::string insides_text(const volume_state& state)
{
    std::string text;
    if (!state.negative_inside.empty())
        text =
            count(state.negative_inside.size(), "cell", "cells") + " negative inside, though the corners are positive";
    if (!state.undecided.empty())
        text += (text.empty() ? "" : "; ") + count(state.undecided.size(), "cell", "cells") + " not decided";
    if (text.empty()) text = state.inverted.empty() ? "all valid" : "valid where corners are positive";
    return text + ", by Bezier bounds";
}

std::string shapes_text(const shape_quality& q)
{
    return "mean ratio " + number(q.worst.mean_ratio) + " worst, " + number(q.mean_ratio) + " mean; angles " +
           number(q.worst.min_angle) + " to " + number(q.worst.max_angle) + " degrees";
}

} // namespace taut::tools
