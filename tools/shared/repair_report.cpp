// SPDX-License-Identifier: MIT
#include "shared/repair_report.hpp"

#include <cstddef>

#include <taut/impl/charts/repair/repair_finding.hpp>
#include <taut/impl/charts/repair/repair_surface.hpp>

namespace taut::tools
{

repaired_surface repair(const io::surface_soup& soup, std::optional<double> weld)
{
    const auto polygons = soup.faces.of_triangles();
    return repair_surface(soup.points, soup.triangles,
                          {.weld_tolerance = weld ? *weld : repair_params::usual_tolerance(soup.points, soup.triangles),
                           .normals = soup.normals,
                           .normal_cells = soup.normal_cells,
                           .polygons = polygons});
}

std::string describe_near_edges(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles,
                                std::span<const idx> bodies)
{
    const double within = repair_params::usual_tolerance(points, triangles);
    const std::size_t edges = impl::count_near_edges(points, triangles, within, bodies);
    if (edges == 0) return {};
    return count(edges, "open edge lies", "open edges lie") + " within " + number(within, 2) +
           " of each other; --weld " + number(within, 2) + " joins them";
}

nlohmann::ordered_json to_json(std::span<const repair_finding> findings)
{
    auto json = nlohmann::ordered_json::array();
    for (const auto& f : findings)
        json.push_back({{"fault", to_string(f.kind)},
                        {"count", f.ids.size() / static_cast<std::size_t>(impl::ids_each(f.kind))},
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
