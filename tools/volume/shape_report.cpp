// SPDX-License-Identifier: MIT
#include "volume/shape_report.hpp"

#include "text_table.hpp"

namespace taut::tools
{

nlohmann::ordered_json shapes_json(const shape_quality& q)
{
    return {{"mean_ratio", {{"worst", q.worst.mean_ratio}, {"mean", q.mean_ratio}}},
            {"scaled_jacobian", {{"worst", q.worst.scaled_jacobian}, {"mean", q.scaled_jacobian}}},
            {"angle", {{"least", q.worst.min_angle}, {"most", q.worst.max_angle}}},
            {"worst_ids", q.worst_ids}};
}

std::string shapes_text(const shape_quality& q)
{
    return "mean ratio " + number(q.worst.mean_ratio) + " worst, " + number(q.mean_ratio) + " mean; angles " +
           number(q.worst.min_angle) + " to " + number(q.worst.max_angle) + " degrees";
}

} // namespace taut::tools
