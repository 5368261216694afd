// SPDX-License-Identifier: MIT
#include "eval/overlapping.hpp"
#include "shared/at.hpp"

#include <algorithm>
#include <string>

#include <taut/certify.hpp>
#include <taut/impl/charts/packing/chart_overlaps.hpp>
#include <taut/impl/core/exact/crossings.hpp>
#include <taut/impl/core/exact/predicates.hpp>

namespace taut::tools
{

namespace
{

/// Whether two triangles have a side in common, each the other way around: if both are positive, it parts them.
bool share_a_side(const std::array<idx, 3>& t, const std::array<idx, 3>& s)
{
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if (t[i] == s[(j + 1) % 3] && t[(i + 1) % 3] == s[j]) return true;
    return false;
}

} // namespace

overlapping_triangles find_overlapping(std::span<const std::array<idx, 3>> cells, std::span<const vec2> uv)
{
    constexpr std::size_t most = 100'000, told = 8;
    // A box is an edge from its lower to its upper corner.
    std::vector<vec2> corners;
    std::vector<std::array<idx, 2>> boxes;
    std::vector<char> positive;
    for (const auto& t : cells)
    {
        const vec2 &a = uv[at(t[0])], &b = uv[at(t[1])], &c = uv[at(t[2])];
        const auto k = static_cast<idx>(corners.size());
        corners.push_back(glm::min(glm::min(a, b), c));
        corners.push_back(glm::max(glm::max(a, b), c));
        boxes.push_back({k, k + 1});
        positive.push_back(impl::orient2d(a, b, c) > 0);
    }
    const auto image = [&](std::size_t c) {
        return std::array<vec2, 3>{uv[at(cells[c][0])], uv[at(cells[c][1])], uv[at(cells[c][2])]};
    };
    overlapping_triangles found;
    std::size_t tests = 64 * cells.size() + 10 * most;
    impl::edge_tree(boxes, corners)
        .for_each_pair(
            [&](std::size_t i, std::size_t j)
            {
                found.all = tests-- > 0;
                if (!found.all) return false;
                if ((positive[i] && positive[j] && share_a_side(cells[i], cells[j])) ||
                    !impl::interiors_meet(image(i), image(j)))
                    return true;
                found.first.push_back({static_cast<idx>(i), static_cast<idx>(j)});
                found.all = ++found.pairs < most;
                return found.all;
            });
    std::sort(found.first.begin(), found.first.end());
    found.first.resize(std::min(found.first.size(), told));
    return found;
}

void add_overlapping(nlohmann::ordered_json& json, const overlapping_triangles& o)
{
    json["overlapping_pairs"] = o.pairs;
    json["all_overlaps_counted"] = o.all;
    json["overlapping_ids"] = o.first;
}

void describe(labelled_lines& lines, const overlapping_triangles& o)
{
    if (o.pairs == 0)
    {
        lines.add("overlapping", o.all ? "no two triangles" : "too many triangles lie close together to look at all");
        return;
    }
    std::string ids;
    for (std::size_t k = 0; k < std::min<std::size_t>(o.first.size(), 3); ++k)
        ids += (k == 0 ? ": " : ", ") + std::to_string(o.first[k][0]) + "-" + std::to_string(o.first[k][1]);
    lines.add("overlapping", (o.all ? "" : "at least ") + count(o.pairs, "pair", "pairs") + " of triangles" + ids +
                                 (o.pairs > 3 ? ", ..." : ""));
}

} // namespace taut::tools
