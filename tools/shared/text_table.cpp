// SPDX-License-Identifier: MIT
#include "shared/text_table.hpp"

#include <algorithm>

#include <picture/format.hpp>

#include "shared/printable.hpp"

namespace taut::tools
{

std::string number(double x, int digits)
{
    return io::impl::format_number(x, digits);
}

std::string count(std::uint64_t n)
{
    return io::impl::format_count(n);
}

std::string count(std::uint64_t n, const std::string& noun, const std::string& nouns)
{
    return count(n) + ' ' + (n == 1 ? noun : nouns);
}

std::string duration(double seconds)
{
    return seconds < 0.0995 ? number(1000 * seconds, 2) + " ms" : number(seconds, 3) + " s";
}

void labelled_lines::add_written(const std::vector<std::string>& files)
{
    std::string list;
    for (const auto& file : files)
        if (!file.empty()) list += (list.empty() ? "" : ", ") + file;
    if (!list.empty()) add("wrote", std::move(list));
}

std::ostream& operator<<(std::ostream& out, const labelled_lines& lines)
{
    std::size_t width = 0;
    for (const auto& line : lines.lines_) width = std::max(width, line.label.size());
    for (const auto& [label, text] : lines.lines_)
        out << label << std::string(width - label.size() + 2, ' ') << printable(text) << '\n';
    return out;
}

std::ostream& operator<<(std::ostream& out, const text_table& table)
{
    std::vector<std::size_t> widths;
    for (const auto& row : table.rows_)
    {
        widths.resize(std::max(widths.size(), row.size()), 0);
        for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
    }
    for (const auto& row : table.rows_)
    {
        std::string line;
        for (std::size_t k = 0; k < row.size(); ++k)
        {
            const std::string gap(widths[k] - row[k].size(), ' ');
            line += k == 0 ? row[k] + gap : "  " + gap + row[k];
        }
        line.erase(line.find_last_not_of(' ') + 1);
        out << printable(line) << '\n';
    }
    return out;
}

} // namespace taut::tools
