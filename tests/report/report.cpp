// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include <doctest/doctest.h>

#include <report/atlas_page.hpp>
#include <report/chart_table.hpp>
#include <report/shown_mesh.hpp>
#include <taut/errors.hpp>

using namespace taut;

namespace
{

/// A square of 2 n^2 triangles in space, cut in the middle into two charts that lie apart.
struct two_charts
{
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    std::vector<std::array<vec2, 3>> uv;
    std::vector<idx> chart;
    std::vector<double> energy;

    explicit two_charts(int n)
    {
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) points.emplace_back(double(i) / n, double(j) / n, 0.1 * std::sin(6.0 * i / n));
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
            {
                const idx a = j * (n + 1) + i;
                for (const auto& cell : {std::array<idx, 3>{a, a + 1, a + n + 2}, {a, a + n + 2, a + n + 1}})
                {
                    const idx label = 2 * i < n ? 0 : 1;
                    std::array<vec2, 3> places;
                    for (std::size_t k = 0; k < 3; ++k)
                        places[k] = vec2(points[static_cast<std::size_t>(cell[k])]) + vec2(2.0 * label, 0);
                    cells.push_back(cell);
                    uv.push_back(places);
                    chart.push_back(label);
                    energy.push_back(4 + label);
                }
            }
    }

    report::shown_mesh shown() const { return {points, cells, uv, chart}; }

    report::atlas_page page() const
    {
        report::atlas_page p;
        p.title = "two";
        p.points = points;
        p.cells = cells;
        p.uv = uv;
        p.chart = chart;
        p.energy = energy;
        return p;
    }
};

/// Edges of triangles with one side.
std::size_t open_edges(const std::vector<std::array<idx, 3>>& cells)
{
    std::set<std::pair<idx, idx>> sides;
    for (const auto& c : cells)
        for (std::size_t k = 0; k < 3; ++k) sides.emplace(c[k], c[(k + 1) % 3]);
    return static_cast<std::size_t>(std::count_if(sides.begin(), sides.end(),
                                                  [&](const auto& s) {
                                                      return !sides.contains({s.second, s.first});
                                                  }));
}

} // namespace

TEST_CASE("report: a small model is shown as it is, and charts share no place")
{
    const int n = 6;
    const two_charts two(n);
    auto m = two.shown();
    m.simplify(static_cast<idx>(two.cells.size()));
    CHECK(m.cells == two.cells);
    CHECK(m.points == two.points);
    CHECK(m.places.size() == 2 * (n + 1) * (n / 2 + 1));
    for (std::size_t t = 0; t < m.images.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) CHECK(m.places[static_cast<std::size_t>(m.images[t][k])] == two.uv[t][k]);
}

TEST_CASE("report: a large model gets simpler, without gaps, and its triangles keep their charts")
{
    const two_charts two(200);
    for (const idx most : {20'000, 3'000, 100})
    {
        auto m = two.shown();
        m.simplify(most);
        const auto left = static_cast<idx>(m.cells.size());
        CHECK(left <= most);
        CHECK(left > most / 3);
        REQUIRE(m.images.size() == m.cells.size());
        REQUIRE(m.origins.size() == m.cells.size());
        CHECK(std::is_sorted(m.origins.begin(), m.origins.end()));
        for (std::size_t t = 0; t < m.images.size(); ++t)
            for (const idx v : m.images[t])
            {
                const double u = m.places[static_cast<std::size_t>(v)].x;
                CHECK((two.chart[static_cast<std::size_t>(m.origins[t])] == 0 ? u <= 0.5 : u >= 2.5));
            }
        // Nothing is open but the outline: of the square, of the charts.
        const auto along = static_cast<std::size_t>(std::sqrt(left / 2.0));
        CHECK(open_edges(m.cells) < 6 * along);
        CHECK(open_edges(m.images) < 9 * along);
        // The outline stays where it is.
        const auto right = [](const vec3& a, const vec3& b) { return a.x < b.x; };
        CHECK(std::max_element(m.points.begin(), m.points.end(), right)->x == 1);
    }
}

TEST_CASE("report: the table and the histogram are of all triangles by their areas")
{
    const two_charts two(8);
    auto page = two.page();
    page.columns = {{"iterations", {5, 6}}};
    const auto table = report::chart_table(page);
    REQUIRE(table.size() == 5);
    CHECK(table[0].values == std::vector<double>{64, 64});
    CHECK(table[1].values[0] + table[1].values[1] == doctest::Approx(100));
    CHECK(table[2].values[1] == doctest::Approx(5));
    CHECK(table[3].values == std::vector<double>{4, 5});
    CHECK(table[4].name == "iterations");

    const auto parts = report::histogram(page, 10);
    REQUIRE(parts.size() == 12);
    const double range = std::log(report::most_excess / report::least_excess);
    const auto bar_of = [&](double energy)
    { return 1 + std::size_t(10 * std::log((energy / 4 - 1) / report::least_excess) / range); };
    CHECK(parts[0] > 0.1); // energy 4
    CHECK(parts[0] + parts.at(bar_of(5)) == doctest::Approx(1));
    std::vector<double> fine(two.energy.size(), 4.01);
    fine[0] = 4.1;
    page.energy = fine;
    CHECK(report::histogram(page, 10).at(bar_of(4.01)) > 0.9);
    CHECK(bar_of(4.1) > bar_of(4.01) + 1);
    std::vector<double> folded(two.energy.size(), std::numeric_limits<double>::infinity());
    page.energy = folded;
    CHECK(report::histogram(page, 10).back() == doctest::Approx(1));
}

TEST_CASE("report: what is shown cannot end the page's script, and asks for nothing else")
{
    const two_charts two(2);
    auto page = two.page();
    page.title = "</script><b>";
    page.repairs = {"caf\xe9"}; // names need not be UTF-8
    const auto html = report::atlas_report_html(page);
    CHECK(html.find("</script><b>") == html.npos);
    CHECK(html.find("\\u003c/script>\\u003cb>") != html.npos);
    CHECK(html.find("@data@") == html.npos);
    CHECK(html.find("@scene@") == html.npos);
    for (const char* other : {"src=\"", "@import", "url(", "href=\"http"}) CHECK(html.find(other) == html.npos);
    CHECK(html == report::atlas_report_html(page));
}

TEST_CASE("report: lists that do not fit together are refused by name")
{
    const two_charts two(2);
    const auto refused = [&](auto change)
    {
        auto page = two.page();
        change(page);
        try
        {
            report::atlas_report_html(page);
        }
        catch (const parameter_error& e)
        {
            return e.field();
        }
        return std::string();
    };
    const std::vector<idx> short_list(3, 0), wrong(two.cells.size(), -2);
    const std::vector<std::array<idx, 3>> beyond(two.cells.size(), {0, 1, 9});
    CHECK(refused([](auto&) {}).empty());
    CHECK(refused([&](auto& p) { p.chart = short_list; }) == "chart");
    CHECK(refused([&](auto& p) { p.chart = wrong; }) == "chart");
    CHECK(refused([&](auto& p) { p.cells = beyond; }) == "cells");
    CHECK(refused([&](auto& p) { p.energy = p.energy.subspan(1); }) == "energy");
    CHECK(refused([&](auto& p) { p.columns = {{"stretch", {1}}}; }) == "stretch");
}

TEST_CASE("report: a model without charts, or without triangles, is a page all the same")
{
    two_charts two(2);
    std::fill(two.chart.begin(), two.chart.end(), -1);
    CHECK(report::atlas_report_html(two.page()).size() > 1000);
    report::atlas_page empty;
    CHECK(report::atlas_report_html(empty).size() > 1000);
}
