// SPDX-License-Identifier: MIT
#include "shared/weight_list.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <system_error>

#include <picture/format.hpp>

#include <taut/errors.hpp>

namespace taut::tools
{

weight_list parse_weights(std::string_view text, const std::string& path, idx vertices)
{
    weight_list list;
    std::size_t line = 1;
    const auto fail = [&](const std::string& what) {
        throw io::io_error(path, what, io::file_place{io::file_place::line, line});
    };
    for (std::size_t begin = 0; begin < text.size(); ++line)
    {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view content = text.substr(begin, end - begin);
        const char *at = content.data(), *const stop = at + std::min(content.find('#'), content.size());
        begin = end + 1;
        std::vector<double> numbers;
        while (true)
        {
            while (at != stop && (*at == ' ' || *at == '\t' || *at == '\r' || *at == ',')) ++at;
            if (at == stop) break;
            double x = 0;
            const auto [next, error] = std::from_chars(at, stop, x);
            if (error != std::errc{}) fail("no line of numbers; write a vertex or two, from 0, and a factor");
            if (numbers.size() == 3) fail("more than three numbers; write a vertex or two, from 0, and a factor");
            numbers.push_back(x);
            at = next;
        }
        if (numbers.empty()) continue;
        if (numbers.size() == 1) fail("one number; write a vertex or two, from 0, and a factor");
        const double factor = numbers.back();
        if (!(factor >= 1e-3 && factor <= 1e3)) fail("a factor that is not from 0.001 to 1000");
        std::vector<idx> ends;
        for (std::size_t k = 0; k + 1 < numbers.size(); ++k)
        {
            if (!(numbers[k] >= 0 && numbers[k] < vertices) || numbers[k] != std::floor(numbers[k]))
                fail("vertex " + io::impl::format_number(numbers[k], 12) + " of " + std::to_string(vertices) +
                     "; vertices are whole numbers from 0");
            ends.push_back(static_cast<idx>(numbers[k]));
        }
        if (ends.size() == 2)
            list.of_edges[{std::min(ends[0], ends[1]), std::max(ends[0], ends[1])}] = factor;
        else
        {
            list.of_vertices.resize(static_cast<std::size_t>(vertices), 1);
            list.of_vertices[static_cast<std::size_t>(ends[0])] = factor;
        }
    }
    return list;
}

} // namespace taut::tools
