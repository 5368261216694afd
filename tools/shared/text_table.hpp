// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace taut::tools
{

/// 4 significant digits unless told otherwise, without trailing zeros; "inf" and "nan" by name. Never by the locale.
std::string number(double x, int digits = 4);

/// Thousands in groups, as in 1,500,000; and with a noun, in the plural unless there is one.
std::string count(std::uint64_t n);
std::string count(std::uint64_t n, const std::string& noun, const std::string& nouns);

/// "0.25 s" or "12 ms".
std::string duration(double seconds);

/// Lines of a label and a text, the texts aligned.
class labelled_lines
{
public:
    void add(std::string label, std::string text) { lines_.push_back({std::move(label), std::move(text)}); }

    /// A line of the files that were written, without empty names; none if all are empty.
    void add_written(const std::vector<std::string>& files);
    friend std::ostream& operator<<(std::ostream& out, const labelled_lines& lines);

private:
    struct line
    {
        std::string label, text;
    };
    std::vector<line> lines_;
};

/// Rows of cells: the first column aligned left, the others right.
class text_table
{
public:
    void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
    friend std::ostream& operator<<(std::ostream& out, const text_table& table);

private:
    std::vector<std::vector<std::string>> rows_;
};

} // namespace taut::tools
