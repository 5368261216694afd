// SPDX-License-Identifier: MIT
#include "report/chart_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <taut/errors.hpp>

namespace taut::report
{

namespace
{

double area(const atlas_page& page, std::size_t t)
{
    const auto corner = [&](std::size_t k) { return page.points[static_cast<std::size_t>(page.cells[t][k])]; };
    return glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0))) / 2;
}

} // namespace

std::vector<chart_column> chart_table(const atlas_page& page)
{
    std::size_t charts = 0;
    for (const idx c : page.chart)
    {
        if (c < -1) throw parameter_error("chart", "has a number below -1");
        charts = std::max(charts, static_cast<std::size_t>(c + 1));
    }
    std::vector<chart_column> table;
    for (const char* name : {"triangles", "area", "energy", "worst"}) table.push_back({name, std::vector(charts, 0.0)});
    auto &triangles = table[0].values, &share = table[1].values, &mean = table[2].values, &worst = table[3].values;
    double whole = 0;
    for (std::size_t t = 0; t < page.cells.size(); ++t)
    {
        if (page.chart[t] < 0) continue;
        const auto c = static_cast<std::size_t>(page.chart[t]);
        const double a = area(page, t);
        whole += a;
        ++triangles[c];
        share[c] += a;
        mean[c] += a * page.energy[t];
        worst[c] = std::max(worst[c], page.energy[t]);
    }
    for (std::size_t c = 0; c < charts; ++c)
    {
        mean[c] /= share[c];
        share[c] *= 100 / whole;
    }
    for (const auto& column : page.columns)
    {
        if (column.values.size() != charts) throw parameter_error(column.name, "needs one value a chart");
        table.push_back(column);
    }
    return table;
}

std::vector<double> histogram(const atlas_page& page, int steps)
{
    std::vector<double> parts(static_cast<std::size_t>(steps) + 2, 0);
    double whole = 0;
    for (std::size_t t = 0; t < page.cells.size(); ++t)
    {
        if (page.chart[t] < 0) continue;
        const double excess = page.energy[t] / 4 - 1, a = area(page, t);
        const double place = std::log(excess / least_excess) / std::log(most_excess / least_excess) * steps;
        if (excess < least_excess)
            parts.front() += a;
        else
            parts[place < steps ? static_cast<std::size_t>(place) + 1 : parts.size() - 1] += a; // NaN is beyond
        whole += a;
    }
    for (double& part : parts) part = whole > 0 ? part / whole : 0;
    return parts;
}

} // namespace taut::report
