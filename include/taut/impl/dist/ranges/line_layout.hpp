// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/dist/ranges/text_ranges.hpp>
#include <taut/volume_file.hpp>

namespace taut::dist::impl
{

/// Names of groups of vertices that a process met, each with a number of its own.
class group_names
{
public:
    struct key
    {
        std::string name;
        int dimension;
        bool spare;                                                ///< only where there are no others
        friend auto operator<=>(const key&, const key&) = default; // NOLINT(modernize-use-nullptr): clang-tidy 14
    };

    int number(const key& k)
    {
        const auto [at, fresh] = numbers_.try_emplace(k, static_cast<int>(keys_.size()));
        if (fresh) keys_.push_back(k);
        return at->second;
    }

    /// PREFIX:TAG.
    int tagged(const std::string& prefix, std::int64_t tag, int dimension, bool spare = false)
    {
        if (tag == tag_ && dimension == dimension_ && spare == spare_ && prefix == prefix_) return last_;
        tag_ = tag, dimension_ = dimension, spare_ = spare, prefix_ = prefix;
        return last_ = number({prefix + ':' + std::to_string(tag), dimension, spare});
    }

    const std::vector<key>& keys() const { return keys_; }

private:
    std::map<key, int> numbers_;
    std::vector<key> keys_;
    std::string prefix_;
    std::int64_t tag_ = 0;
    int dimension_ = -1, last_ = -1;
    bool spare_ = false;
};

/// Orders of the corners of a wedge: VTK's, and that of gmsh and MEDIT.
enum class wedge_order
{
    vtk,
    turned
};

/// A cell of a line: corners by the numbers of the file, and the groups that it belongs to.
struct line_cell
{
    io::cell_kind kind = io::cell_kind::tetrahedron;
    std::array<std::int64_t, 8> corners{};
    std::vector<int> groups;
    std::array<std::int64_t, 2> labels{}; ///< the second one counts where no cell of the file has the first; 0: none

    /// Takes corners from words.
    void take(const tokens& words, std::size_t first, wedge_order order = wedge_order::vtk)
    {
        const auto n = static_cast<std::size_t>(io::impl::shape_of(kind).corners);
        for (std::size_t k = 0; k < n; ++k) corners[k] = words.integer(first + k);
        if (kind != io::cell_kind::wedge || order == wedge_order::vtk) return;
        std::swap(corners[1], corners[2]);
        std::swap(corners[4], corners[5]);
    }
    int dimension() const { return io::impl::shape_of(kind).dimension; }
};

/// Items of a text that are read alike.
struct line_section
{
    enum class content
    {
        numbers,  ///< of vertices, the first word
        vertices, ///< coordinates
        cells
    };
    content what;
    std::size_t text; ///< which one of the texts
    item_range items;
    std::int64_t first = 0;                                   ///< of vertices: the place of the first in the mesh
    std::size_t word = 0;                                     ///< where coordinates begin
    bool numbered = false;                                    ///< the first word is the number of the vertex
    std::function<int(const tokens&)> group = {};             ///< of a vertex; -1: none
    std::function<void(const tokens&, line_cell&)> cell = {}; ///< reads a cell
};

/// How the lines of a mesh lie in its texts; the first of these has the coordinates.
struct line_layout
{
    std::vector<std::unique_ptr<text_ranges>> texts;
    std::vector<line_section> sections; ///< ascending within a text
    std::int64_t vertices = 0;
    std::int64_t first_number = 0; ///< of the vertices, where none is written
    std::unique_ptr<group_names> groups = std::make_unique<group_names>();
    std::vector<std::string> extensions = {}; ///< of the texts, where a mesh has several
};

/// The kind of a first word that is a letter, as keywords of formats are.
inline line_kind blank_or(std::string_view line, char comment, line_kind kind)
{
    for (const char c : line)
        if (!tokens::blank(c)) return c == comment && comment != '\0' ? line_kind::nothing : kind;
    return line_kind::nothing;
}

} // namespace taut::dist::impl
