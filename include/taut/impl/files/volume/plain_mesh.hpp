// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/files/volume/volume_file_bodies.hpp>
#include <taut/volume_file.hpp>

namespace taut::io::impl
{

/// Mesh that is written anew: points, cells and labels; format, dimension and groups are those of a file.
struct plain_mesh
{
    const volume_file& of;
    std::vector<vec3> points, rest;
    std::vector<cell_block> cells; ///< corners in the order of the file
    std::vector<volume_label> labels;
    std::vector<idx> turned; ///< cells in the other order, as of volume_file

    std::size_t cell_count() const
    {
        std::size_t n = 0;
        for (const auto& block : cells) n += block.size();
        return n;
    }

    /// The values of a label; none if there is none of that name.
    std::span<const long long> values(std::string_view name, bool of_cells) const
    {
        for (const auto& l : labels)
            if (l.name == name && l.of_cells == of_cells) return l.values;
        return {};
    }
};

/// Text made of numbers and words with blanks between them.
class text_lines
{
public:
    template <class T>
    requires std::is_arithmetic_v<T> text_lines& operator<<(T x)
    {
        std::array<char, 32> digits;
        gap();
        text_.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr);
        return *this;
    }
    text_lines& operator<<(std::string_view words)
    {
        gap();
        text_ += words;
        return *this;
    }
    text_lines& point(const vec3& p, int coordinates)
    {
        for (int k = 0; k < coordinates; ++k) *this << p[k];
        return *this;
    }
    text_lines& corners(std::span<const idx> cell, idx first)
    {
        for (const idx v : cell) *this << v + first;
        return *this;
    }
    void end() { text_ += '\n'; }
    std::string take() { return std::move(text_); }

private:
    void gap()
    {
        if (!text_.empty() && text_.back() != '\n') text_ += ' ';
    }
    std::string text_;
};

inline long long value_or_0(std::span<const long long> values, std::size_t i)
{
    return i < values.size() ? values[i] : 0;
}

inline std::string medit_text(const plain_mesh& m)
{
    text_lines out;
    const int d = m.of.places.per_point;
    (out << "MeshVersionFormatted" << (m.of.places.single ? 1 : 2)).end();
    (out << "Dimension" << d).end();
    (out << "Vertices").end();
    (out << m.points.size()).end();
    const auto of_points = m.values("reference", false), of_cells = m.values("reference", true);
    for (std::size_t v = 0; v < m.points.size(); ++v) (out.point(m.points[v], d) << value_or_0(of_points, v)).end();
    std::size_t number = 0;
    for (const auto& block : m.cells)
    {
        out << (block.kind == cell_kind::line       ? "Edges"
                : block.kind == cell_kind::triangle ? "Triangles"
                                                    : "Tetrahedra");
        out.end();
        (out << block.size()).end();
        for (std::size_t c = 0; c < block.size(); ++c)
            (out.corners(block.cell(c), 1) << value_or_0(of_cells, number++)).end();
    }
    for (const auto& [keyword, group] : {std::pair("Corners", "corners"), {"RequiredVertices", "required_vertices"}})
        for (const auto& g : m.of.groups)
            if (g.name == group)
            {
                (out << keyword).end();
                (out << g.vertices.size()).end();
                for (const idx v : g.vertices) (out << v + 1).end();
            }
    (out << "End").end();
    return out.take();
}

inline std::string gmsh_text(const plain_mesh& m)
{
    text_lines out;
    (out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat").end();
    const std::string_view bytes = m.of.bytes, last = "$EndPhysicalNames";
    const auto names = bytes.find("\n$PhysicalNames"), end = bytes.find(last);
    if (names != bytes.npos && end != bytes.npos && names < end)
        (out << bytes.substr(names + 1, end + last.size() - names - 1)).end();
    (out << "$Nodes").end();
    (out << m.points.size()).end();
    for (std::size_t v = 0; v < m.points.size(); ++v) (out << v + 1).point(m.points[v], 3).end();
    (out << "$EndNodes\n$Elements").end();
    (out << m.cell_count()).end();
    const auto physical = m.values("physical", true), entity = m.values("entity", true);
    std::size_t number = 0;
    for (const auto& block : m.cells)
        for (std::size_t c = 0; c < block.size(); ++c, ++number)
        {
            const int type = block.kind == cell_kind::vertex     ? 15
                             : block.kind == cell_kind::line     ? 1
                             : block.kind == cell_kind::triangle ? 2
                                                                 : 4;
            (out << number + 1 << type << 2 << value_or_0(physical, number) << value_or_0(entity, number))
                .corners(block.cell(c), 0 + 1)
                .end();
        }
    (out << "$EndElements").end();
    return out.take();
}

inline int vtk_type(cell_kind kind)
{
    return kind == cell_kind::vertex ? 1 : kind == cell_kind::line ? 3 : kind == cell_kind::triangle ? 5 : 10;
}

inline bool fits_32_bits(const volume_label& l)
{
    return std::all_of(l.values.begin(), l.values.end(),
                       [](long long x) {
                           return x >= std::numeric_limits<std::int32_t>::min() &&
                                  x <= std::numeric_limits<std::int32_t>::max();
                       });
}

inline std::string vtk_text(const plain_mesh& m)
{
    text_lines out;
    (out << "# vtk DataFile Version 3.0").end();
    const std::string_view bytes = m.of.bytes;
    const auto title = bytes.find('\n') + 1;
    (out << bytes.substr(title, bytes.find_first_of("\r\n", title) - title)).end();
    (out << "ASCII\nDATASET UNSTRUCTURED_GRID").end();
    (out << "POINTS" << m.points.size() << (m.of.places.single ? "float" : "double")).end();
    for (const vec3& p : m.points) out.point(p, 3).end();
    const std::size_t n = m.cell_count();
    std::size_t corners = 0;
    for (const auto& block : m.cells) corners += block.corners.size();
    (out << "CELLS" << n << n + corners).end();
    for (const auto& block : m.cells)
        for (std::size_t c = 0; c < block.size(); ++c) (out << block.cell(c).size()).corners(block.cell(c), 0).end();
    (out << "CELL_TYPES" << n).end();
    for (const auto& block : m.cells)
        for (std::size_t c = 0; c < block.size(); ++c) (out << vtk_type(block.kind)).end();
    for (const bool of_cells : {true, false})
    {
        const auto arrays = std::count_if(m.labels.begin(), m.labels.end(),
                                          [&](const volume_label& l) { return l.of_cells == of_cells; });
        if (arrays == 0) continue;
        (out << (of_cells ? "CELL_DATA" : "POINT_DATA") << (of_cells ? n : m.points.size())).end();
        (out << "FIELD FieldData" << arrays).end();
        for (const auto& l : m.labels)
        {
            if (l.of_cells != of_cells) continue;
            (out << l.name << 1 << l.values.size() << (fits_32_bits(l) ? "int" : "long")).end();
            for (const long long x : l.values) (out << x).end();
        }
    }
    return out.take();
}

inline std::string vtu_text(const plain_mesh& m)
{
    text_lines out;
    const auto array = [&](std::string_view name, const char* type, int components, const auto& values)
    {
        std::string quoted;
        for (const char c : name) quoted += c == '"' ? "&quot;" : std::string(1, c); // entities stay as they are
        (out << "<DataArray type=\"" + std::string(type) + "\" Name=\"" + quoted + "\" NumberOfComponents=\"" +
                    std::to_string(components) + "\" format=\"ascii\">")
            .end();
        values();
        (out << "</DataArray>").end();
    };
    const std::size_t n = m.cell_count();
    (out << "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>")
        .end();
    (out << "<Piece NumberOfPoints=\"" + std::to_string(m.points.size()) + "\" NumberOfCells=\"" + std::to_string(n) +
                "\">")
        .end();
    (out << "<Points>").end();
    array("Points", m.of.places.single ? "Float32" : "Float64", 3,
          [&]
          {
              for (const vec3& p : m.points) out.point(p, 3).end();
          });
    (out << "</Points>\n<Cells>").end();
    const auto each_cell = [&](const auto& f)
    {
        for (const auto& block : m.cells)
            for (std::size_t c = 0; c < block.size(); ++c) f(block.kind, block.cell(c));
    };
    array("connectivity", "Int64", 1,
          [&] { each_cell([&](cell_kind, std::span<const idx> cell) { out.corners(cell, 0).end(); }); });
    std::size_t ends = 0;
    array("offsets", "Int64", 1,
          [&] { each_cell([&](cell_kind, std::span<const idx> cell) { (out << (ends += cell.size())).end(); }); });
    array("types", "UInt8", 1,
          [&] { each_cell([&](cell_kind kind, std::span<const idx>) { (out << vtk_type(kind)).end(); }); });
    (out << "</Cells>").end();
    for (const bool of_cells : {true, false})
    {
        (out << (of_cells ? "<CellData>" : "<PointData>")).end();
        for (const auto& l : m.labels)
            if (l.of_cells == of_cells)
                array(l.name, "Int64", 1,
                      [&]
                      {
                          for (const long long x : l.values) (out << x).end();
                      });
        (out << (of_cells ? "</CellData>" : "</PointData>")).end();
    }
    (out << "</Piece>\n</UnstructuredGrid>\n</VTKFile>").end();
    return out.take();
}

inline std::string problem_text(const plain_mesh& m)
{
    text_lines out;
    const int d = m.of.places.per_point;
    (out << m.rest.size() << 3).end();
    for (const vec3& p : m.rest) out.point(p, 3).end();
    (out << m.points.size() << d).end();
    for (const vec3& p : m.points) out.point(p, d).end();
    (out << m.cell_count() << d + 1).end();
    for (const auto& block : m.cells)
        for (std::size_t c = 0; c < block.size(); ++c) out.corners(block.cell(c), 0).end();
    for (const auto& g : m.of.groups)
        if (g.name == "fixed")
        {
            (out << g.vertices.size()).end();
            for (const idx v : g.vertices) (out << v).end();
            return out.take();
        }
    (out << 0).end();
    return out.take();
}

/// The formats that meshes are written in anew.
struct text_format
{
    volume_format format;
    std::string (*text)(const plain_mesh&);
};
inline constexpr std::array<text_format, 5> text_formats = {{{volume_format::medit, medit_text},
                                                             {volume_format::gmsh, gmsh_text},
                                                             {volume_format::vtk, vtk_text},
                                                             {volume_format::vtu, vtu_text},
                                                             {volume_format::problem, problem_text}}};

} // namespace taut::io::impl
