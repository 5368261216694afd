// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <taut/options.hpp>

namespace taut::tools
{

/// A stage of a run as all commands report it.
nlohmann::ordered_json to_json(const stage_report& stage);

template <class Stages>
nlohmann::ordered_json to_json_array(const Stages& stages)
{
    auto all = nlohmann::ordered_json::array();
    for (const auto& s : stages) all.push_back(to_json(s));
    return all;
}

} // namespace taut::tools
