// SPDX-License-Identifier: MIT
#include "shared/edge_list.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <system_error>

#include <taut/errors.hpp>

namespace taut::tools
{

std::vector<std::array<idx, 2>> parse_edges(std::string_view text, const std::string& path, idx vertices)
{
    std::vector<std::array<idx, 2>> edges;
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
        const auto blank = [&] { return at != stop && (*at == ' ' || *at == '\t' || *at == '\r' || *at == ','); };
        std::vector<idx> numbers;
        while (true)
        {
            while (blank()) ++at;
            if (at == stop) break;
            idx v = 0;
            const auto [next, error] = std::from_chars(at, stop, v);
            if (error != std::errc{}) fail("no number of a vertex; write two a line, from 0");
            if (v < 0 || v >= vertices)
                fail("vertex " + std::to_string(v) + " of " + std::to_string(vertices) + "; write them from 0");
            numbers.push_back(v);
            at = next;
        }
        if (numbers.empty()) continue;
        if (numbers.size() != 2) fail(std::to_string(numbers.size()) + " numbers; write the two vertices of an edge");
        edges.push_back({std::min(numbers[0], numbers[1]), std::max(numbers[0], numbers[1])});
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

} // namespace taut::tools
