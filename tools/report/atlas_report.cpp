// SPDX-License-Identifier: MIT
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <nlohmann/json.hpp>

#include <taut/errors.hpp>
#include <taut/impl/files/volume/coding/base64.hpp>

#include "report/atlas_page.hpp"
#include "report/chart_table.hpp"
#include "report/report_page.hpp"
#include "report/shown_mesh.hpp"

namespace taut::report
{

namespace
{

static_assert(std::endian::native == std::endian::little,
              "reports hold arrays as this machine has them, and browsers take them as little-endian; build taut for a "
              "little-endian machine, or without its tools (TAUT_TOOLS=OFF)");

/// Numbers as the page reads them back into a typed array: little-endian bytes in base64.
template <class Number>
std::string base64(const std::vector<Number>& numbers)
{
    return io::impl::to_base64({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)});
}

template <class Number, class Row>
std::vector<Number> flat(const std::vector<Row>& rows, std::size_t width)
{
    std::vector<Number> all;
    all.reserve(rows.size() * width);
    for (const Row& row : rows)
        for (std::size_t k = 0; k < width; ++k) all.push_back(static_cast<Number>((&row[0])[k]));
    return all;
}

void require(const atlas_page& page)
{
    const auto n = page.cells.size();
    if (page.uv.size() != n) throw parameter_error("uv", "needs one entry a triangle");
    if (page.chart.size() != n) throw parameter_error("chart", "needs one entry a triangle");
    if (page.energy.size() != n) throw parameter_error("energy", "needs one entry a triangle");
    for (const auto& cell : page.cells)
        for (const idx v : cell)
            if (v < 0 || static_cast<std::size_t>(v) >= page.points.size())
                throw parameter_error("cells", "names vertex " + std::to_string(v) + ", which is not there");
}

nlohmann::ordered_json known(double x)
{
    return std::isfinite(x) ? nlohmann::ordered_json(x) : nullptr;
}

} // namespace

std::string atlas_report_html(const atlas_page& page)
{
    require(page);
    nlohmann::ordered_json data;
    data["title"] = page.title;
    data["command"] = page.command;
    data["numbers"] = page.numbers;
    data["repairs"] = page.repairs;
    for (auto& list = data["stages"] = nlohmann::ordered_json::array(); const auto& s : page.stages)
        list.push_back({{"name", s.name}, {"seconds", known(s.seconds)}, {"energy", known(s.energy)}});
    for (auto& list = data["columns"] = nlohmann::ordered_json::array(); const auto& column : chart_table(page))
    {
        auto values = nlohmann::ordered_json::array();
        for (const double x : column.values) values.push_back(known(x));
        list.push_back({{"name", column.name}, {"values", std::move(values)}});
    }
    data["histogram"] = {{"least", least_excess}, {"most", most_excess}, {"parts", histogram(page, 40)}};

    shown_mesh shown(page.points, page.cells, page.uv, page.chart);
    shown.simplify(page.most_triangles);
    std::vector<float> energy;
    std::vector<std::int32_t> chart;
    for (const idx t : shown.origins)
    {
        energy.push_back(static_cast<float>(page.energy[static_cast<std::size_t>(t)]));
        chart.push_back(page.chart[static_cast<std::size_t>(t)]);
    }
    data["triangles"] = page.cells.size();
    data["points"] = base64(flat<float>(shown.points, 3));
    data["cells"] = base64(flat<std::uint32_t>(shown.cells, 3));
    data["places"] = base64(flat<float>(shown.places, 2));
    data["images"] = base64(flat<std::uint32_t>(shown.images, 3));
    data["origins"] = base64(shown.origins);
    data["charts"] = base64(chart);
    data["energies"] = base64(energy);

    std::string text = data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    std::string html(report_html);
    const auto put = [&html](std::string_view mark, std::string_view what)
    { html.replace(html.find(mark), mark.size(), what); };
    for (std::size_t i = text.find('<'); i != text.npos; i = text.find('<', i))
        text.replace(i, 1, "\\u003c"); // no tag ends the script
    put("@scene@", scene_script);      // before the data, which may say so, too
    put("@data@", text);
    return html;
}

} // namespace taut::report
