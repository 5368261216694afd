// SPDX-License-Identifier: MIT
#include "repair_report.hpp"

#include <cstddef>

namespace taut::tools
{

repaired_surface repair(const io::surface_soup& soup, double weld_tolerance)
{
    const auto polygons = soup.faces.of_triangles();
    return repair_surface(soup.points, soup.triangles,
                          {.weld_tolerance = weld_tolerance,
                           .normals = soup.normals,
                           .normal_cells = soup.normal_cells,
                           .polygons = polygons});
}

nlohmann::ordered_json to_json(std::span<const repair_finding> findings)
{
    auto json = nlohmann::ordered_json::array();
    for (const auto& f : findings)
        json.push_back({{"fault", to_string(f.kind)},
                        {"count", f.ids.size() / static_cast<std::size_t>(ids_each(f.kind))},
                        {"ids", f.ids},
                        {"message", f.problem},
                        {"repair", f.action}});
    return json;
}

void describe(labelled_lines& lines, std::span<const repair_finding> findings)
{
    for (const auto& f : findings) lines.add("repair", f.message());
}

} // namespace taut::tools
