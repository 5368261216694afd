// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/files/file/byte_order.hpp>
#include <taut/volume_file.hpp>

/// Small volume meshes, and their files in every format as other programs write them.
namespace taut::test
{

/// A cell, its corners in the order of gmsh and MEDIT, and a number that a file keeps for it.
struct volume_cell
{
    io::cell_kind kind;
    std::vector<idx> corners;
    int tag;
};

struct volume_sample
{
    std::vector<vec3> points;
    std::vector<volume_cell> cells;

    /// Corners in VTK's order.
    std::vector<idx> vtk_corners(std::size_t c) const
    {
        auto v = cells[c].corners;
        if (cells[c].kind == io::cell_kind::wedge) v = {v[0], v[2], v[1], v[3], v[5], v[4]};
        return v;
    }
};

/// Two tetrahedra on a common triangle, which is there as a cell, too; a hexahedron, a wedge and a pyramid beside them
/// if wanted.
inline volume_sample small_volume(bool mixed)
{
    using io::cell_kind;
    volume_sample s{{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 0.4, 1e-3}, {0.25, 1. / 3, -1}}, {}};
    s.cells = {{cell_kind::triangle, {0, 2, 1}, 7},
               {cell_kind::tetrahedron, {0, 1, 2, 3}, 1},
               {cell_kind::tetrahedron, {0, 2, 1, 4}, 2}};
    if (!mixed) return s;
    const auto n = static_cast<idx>(s.points.size());
    for (const vec3& p : {vec3(0, 0, 0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(1, 0, 1),
                          vec3(1, 1, 1), vec3(0, 1, 1), vec3(2, 0.5, 0), vec3(2, 0.5, 1), vec3(0.5, 0.5, 2)})
        s.points.push_back(p + vec3(5, 0, 0));
    s.cells.push_back({cell_kind::hexahedron, {n, n + 1, n + 2, n + 3, n + 4, n + 5, n + 6, n + 7}, 1});
    s.cells.push_back({cell_kind::wedge, {n + 1, n + 8, n + 2, n + 5, n + 9, n + 6}, 2});
    s.cells.push_back({cell_kind::pyramid, {n + 4, n + 5, n + 6, n + 7, n + 10}, 2});
    return s;
}

/// A square of four triangles around a vertex, in the plane.
inline volume_sample small_square()
{
    using io::cell_kind;
    volume_sample s{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.375, 0}}, {}};
    s.cells = {{cell_kind::triangle, {0, 1, 4}, 1}, {cell_kind::triangle, {1, 2, 4}, 1},
               {cell_kind::triangle, {2, 3, 4}, 2}, {cell_kind::triangle, {3, 0, 4}, 2},
               {cell_kind::line, {0, 1}, 5},        {cell_kind::line, {1, 2}, 6}};
    return s;
}

/// How a file has its numbers.
struct volume_encoding
{
    bool text = true;
    std::endian order = std::endian::little;
    bool single = false;
};

/// Numbers as text or binary.
class number_text
{
public:
    explicit number_text(volume_encoding encoding, std::string end = "\n") : encoding_(encoding), end_(std::move(end))
    {
    }

    template <class T>
    number_text& put(T x)
    {
        if (encoding_.text)
        {
            std::array<char, 32> digits;
            if (!text.empty() && text.back() != '\n' && text.back() != ' ') text += ' ';
            text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr);
            return *this;
        }
        std::array<char, sizeof(T)> bytes;
        io::impl::store(bytes.data(), x, encoding_.order);
        text.append(bytes.data(), bytes.size());
        return *this;
    }

    number_text& put_i32(std::size_t x) { return put(static_cast<std::int32_t>(x)); }
    number_text& put_i64(std::size_t x) { return put(static_cast<std::int64_t>(x)); }

    number_text& put(const vec3& p, int dimension = 3)
    {
        for (int k = 0; k < dimension; ++k)
            if (encoding_.single)
                put(static_cast<float>(p[k]));
            else
                put(p[k]);
        return *this;
    }

    /// Ends a line of text.
    number_text& row()
    {
        if (encoding_.text) text += end_;
        return *this;
    }

    /// What stands as text in any case.
    number_text& say(const std::string& words)
    {
        text += words;
        return *this;
    }

    std::string text;

private:
    volume_encoding encoding_;
    std::string end_;
};

inline int vtk_number(io::cell_kind kind)
{
    constexpr std::array<int, 8> numbers = {1, 3, 5, 9, 10, 14, 13, 12};
    return numbers[static_cast<std::size_t>(kind)];
}

inline int gmsh_number(io::cell_kind kind)
{
    constexpr std::array<int, 8> numbers = {15, 1, 2, 3, 4, 7, 6, 5};
    return numbers[static_cast<std::size_t>(kind)];
}

inline std::string medit_text(const volume_sample& s, int dimension = 3, const std::string& end = "\n")
{
    constexpr std::array<const char*, 8> sections = {"",           "Edges",    "Triangles", "Quadrilaterals",
                                                     "Tetrahedra", "Pyramids", "Prisms",    "Hexahedra"};
    number_text out({}, end);
    out.say("MeshVersionFormatted 2" + end + "# a comment" + end + "Dimension" + end).put(dimension).row();
    out.say("Vertices" + end).put(s.points.size()).row();
    for (std::size_t v = 0; v < s.points.size(); ++v) out.put(s.points[v], dimension).put(v % 2).row();
    for (std::size_t kind = 1; kind < sections.size(); ++kind)
    {
        std::size_t n = 0;
        for (const auto& c : s.cells) n += c.kind == static_cast<io::cell_kind>(kind);
        if (n == 0) continue;
        out.say(sections[kind] + end).put(n).row();
        for (const auto& c : s.cells)
        {
            if (c.kind != static_cast<io::cell_kind>(kind)) continue;
            for (const idx v : c.corners) out.put(v + 1);
            out.put(c.tag).row();
        }
    }
    out.say("Corners" + end + "2 1 3" + end + "Normals 1 0 0 1" + end + "End" + end);
    return out.text;
}

/// The number that gmsh files here give a vertex: with gaps, falling.
inline idx gmsh_id(const volume_sample& s, idx v)
{
    return 100 - 3 * v + static_cast<idx>(4 * s.points.size());
}

inline std::string gmsh_head(const char* version, const volume_encoding& e)
{
    number_text out(e);
    out.say(std::string("$MeshFormat\n") + version + (e.text ? " 0 8\n" : " 1 8\n"));
    if (!e.text) out.put(1).say("\n");
    return out.text + "$EndMeshFormat\n$Comments\nmade by hand\n$EndComments\n$PhysicalNames\n2\n2 7 \"the wall\"\n3 1 "
                      "\"body\"\n$EndPhysicalNames\n";
}

inline std::string gmsh2_text(const volume_sample& s, const volume_encoding& e)
{
    number_text out(e);
    out.say(gmsh_head("2.2", e) + "$Nodes\n" + std::to_string(s.points.size()) + "\n");
    for (std::size_t v = 0; v < s.points.size(); ++v) out.put(gmsh_id(s, static_cast<idx>(v))).put(s.points[v]).row();
    out.say(std::string(e.text ? "" : "\n") + "$EndNodes\n$Elements\n" + std::to_string(s.cells.size()) + "\n");
    for (std::size_t c = 0; c < s.cells.size(); ++c)
    {
        if (e.text)
            out.put_i32(c + 1).put(gmsh_number(s.cells[c].kind)).put(2);
        else
            out.put(gmsh_number(s.cells[c].kind)).put(1).put(2).put_i32(c + 1);
        out.put(s.cells[c].tag).put(s.cells[c].tag + 40);
        for (const idx v : s.cells[c].corners) out.put(gmsh_id(s, v));
        out.row();
    }
    out.say(std::string(e.text ? "" : "\n") + "$EndElements\n");
    return out.text;
}

/// One block a cell, the first two points in a block with parameters.
inline std::string gmsh4_text(const volume_sample& s, const volume_encoding& e)
{
    number_text out(e);
    out.say(gmsh_head("4.1", e) + "$Entities\n");
    std::array<std::vector<int>, 4> tags; // of entities, by dimension
    for (const auto& c : s.cells)
    {
        auto& of = tags[static_cast<std::size_t>(io::impl::shape_of(c.kind).dimension)];
        if (std::find(of.begin(), of.end(), c.tag) == of.end()) of.push_back(c.tag);
    }
    for (const auto& of : tags) out.put_i64(of.size());
    out.row();
    for (const auto& of : tags)
        for (const int tag : of)
            out.put(tag + 40).put(vec3(-1)).put(vec3(1)).put_i64(1).put(tag).put_i64(1).put(-3).row();
    out.say(std::string(e.text ? "" : "\n") + "$EndEntities\n$Nodes\n");
    const std::size_t n = s.points.size(), first = std::min<std::size_t>(n, 2);
    out.put_i64(2).put_i64(n).put_i64(1).put_i64(1000).row();
    for (const auto& [begin, end] : {std::pair(std::size_t(0), first), std::pair(first, n)})
    {
        out.put(begin == 0 ? 2 : 3).put(41).put(begin == 0 ? 1 : 0).put_i64(end - begin).row();
        for (std::size_t v = begin; v < end; ++v)
            out.put_i64(static_cast<std::size_t>(gmsh_id(s, static_cast<idx>(v)))).row();
        for (std::size_t v = begin; v < end; ++v)
        {
            out.put(s.points[v]);
            if (begin == 0) out.put(0.5).put(0.25);
            out.row();
        }
    }
    out.say(std::string(e.text ? "" : "\n") + "$EndNodes\n$Elements\n");
    out.put_i64(s.cells.size()).put_i64(s.cells.size()).put_i64(1).put_i64(s.cells.size()).row();
    for (std::size_t c = 0; c < s.cells.size(); ++c)
    {
        const auto& cell = s.cells[c];
        out.put(io::impl::shape_of(cell.kind).dimension)
            .put(cell.tag + 40)
            .put(gmsh_number(cell.kind))
            .put_i64(1)
            .row();
        out.put_i64(c + 1);
        for (const idx v : cell.corners) out.put_i64(static_cast<std::size_t>(gmsh_id(s, v)));
        out.row();
    }
    out.say(std::string(e.text ? "" : "\n") + "$EndElements\n");
    return out.text;
}

/// version: 3 or 5. Binary files are big-endian, whatever the encoding says.
inline std::string vtk_text(const volume_sample& s, volume_encoding e, int version)
{
    e.order = std::endian::big;
    const std::string row = e.text ? "" : "\n", n = std::to_string(s.cells.size());
    number_text out(e);
    out.say("# vtk DataFile Version " + std::string(version == 5 ? "5.1" : "3.0") + "\na title\n");
    out.say(std::string(e.text ? "ASCII" : "BINARY") + "\nDATASET UNSTRUCTURED_GRID\n");
    out.say("FIELD FieldData 1\ntime 1 1 double\n").put(0.5).say("\n");
    out.say("POINTS " + std::to_string(s.points.size()) + (e.single ? " float\n" : " double\n"));
    for (const vec3& p : s.points) out.put(p).row();
    out.say(row + "METADATA\nINFORMATION 0\n\n");
    std::size_t corners = 0;
    for (const auto& c : s.cells) corners += c.corners.size();
    if (version == 5)
    {
        out.say("CELLS " + std::to_string(s.cells.size() + 1) + ' ' + std::to_string(corners) +
                "\nOFFSETS vtktypeint64\n");
        std::size_t end = 0;
        out.put_i64(0);
        for (const auto& c : s.cells) out.put_i64(end += c.corners.size());
        out.say("\nCONNECTIVITY vtktypeint64\n");
        for (std::size_t c = 0; c < s.cells.size(); ++c)
            for (const idx v : s.vtk_corners(c)) out.put_i64(static_cast<std::size_t>(v));
        out.say("\n");
    }
    else
    {
        out.say("CELLS " + n + ' ' + std::to_string(corners + s.cells.size()) + '\n');
        for (std::size_t c = 0; c < s.cells.size(); ++c)
        {
            out.put_i32(s.cells[c].corners.size());
            for (const idx v : s.vtk_corners(c)) out.put(v);
            out.row();
        }
        out.say(row);
    }
    out.say("CELL_TYPES " + n + "\n");
    for (const auto& c : s.cells) out.put(vtk_number(c.kind)).row();
    out.say(row + "CELL_DATA " + n + "\nSCALARS part int 1\nLOOKUP_TABLE default\n");
    for (const auto& c : s.cells) out.put(c.tag).row();
    out.say(row + "POINT_DATA " + std::to_string(s.points.size()) + "\nVECTORS push float\n");
    for (std::size_t v = 0; v < s.points.size(); ++v) out.put(0.f).put(1.f).put(2.f).row();
    out.say(row + "FIELD FieldData 1\nside 1 " + std::to_string(s.points.size()) + " int\n");
    for (std::size_t v = 0; v < s.points.size(); ++v) out.put_i32(v % 2).row();
    out.say(row);
    return out.text;
}

/// Text, or appended raw.
inline std::string vtu_text(const volume_sample& s, const volume_encoding& e, bool long_header = false)
{
    number_text points(e), corners(e), ends(e), types(e), parts(e), sides(e);
    std::size_t end = 0;
    for (const vec3& p : s.points) points.put(p).row();
    for (std::size_t v = 0; v < s.points.size(); ++v) sides.put_i32(v % 2);
    for (std::size_t c = 0; c < s.cells.size(); ++c)
    {
        for (const idx v : s.vtk_corners(c)) corners.put_i64(static_cast<std::size_t>(v));
        ends.put_i32(end += s.cells[c].corners.size());
        types.put(static_cast<std::uint8_t>(vtk_number(s.cells[c].kind)));
        parts.put(s.cells[c].tag);
    }
    number_text appended(e);
    const auto array = [&](const std::string& type, const std::string& name, const number_text& values)
    {
        std::string tag = "<DataArray type='" + type + "' Name=\"" + name + "\" ";
        if (name == "Points") tag += "NumberOfComponents=\"3\" ";
        if (e.text) return tag + "format=\"ascii\">" + values.text + "</DataArray>\n";
        tag += "format=\"appended\" offset=\"" + std::to_string(appended.text.size()) + "\"/>\n";
        if (long_header)
            appended.put_i64(values.text.size());
        else
            appended.put_i32(values.text.size());
        appended.say(values.text);
        return tag;
    };
    std::string text = "<?xml version=\"1.0\"?>\n<!-- a > comment -->\n<VTKFile type=\"UnstructuredGrid\" "
                       "version=\"1.0\" byte_order=\"" +
                       std::string(e.order == std::endian::big ? "BigEndian" : "LittleEndian") + "\" header_type=\"" +
                       (long_header ? "UInt64" : "UInt32") + "\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
                       std::to_string(s.points.size()) + "\" NumberOfCells=\"" + std::to_string(s.cells.size()) +
                       "\">\n";
    text += "<PointData>" + array("Int32", "side", sides) + "</PointData>\n<CellData>" + array("Int32", "part", parts);
    text += "</CellData>\n<Points>" + array(e.single ? "Float32" : "Float64", "Points", points) + "</Points>\n<Cells>";
    text += array("Int64", "connectivity", corners) + array("Int32", "offsets", ends) + array("UInt8", "types", types);
    text += "</Cells>\n</Piece>\n</UnstructuredGrid>\n";
    if (!e.text) text += "<AppendedData encoding=\"raw\">\n_" + appended.text + "\n</AppendedData>\n";
    return text + "</VTKFile>\n";
}

/// Cells of dimension 3 (or 2, in the plane) are elements, those below are markers by their tag.
inline std::string su2_text(const volume_sample& s, int dimension = 3, const std::string& end = "\n")
{
    number_text out({}, end), below({}, end);
    std::size_t elements = 0, markers = 0;
    for (const auto& c : s.cells)
        if (io::impl::shape_of(c.kind).dimension == dimension)
            ++elements;
        else
            ++markers;
    out.say("% a comment" + end + "NDIME= ").put(dimension).row().say("NELEM=").put(elements).row();
    std::size_t e = 0;
    for (std::size_t i = 0; i < s.cells.size(); ++i)
    {
        const auto& c = s.cells[i];
        const bool marker = io::impl::shape_of(c.kind).dimension != dimension;
        if (marker) below.say("MARKER_TAG= side" + std::to_string(c.tag) + end + "MARKER_ELEMS= 1" + end);
        (marker ? below : out).put(vtk_number(c.kind));
        for (const idx v : s.vtk_corners(i)) (marker ? below : out).put(v);
        if (marker)
            below.row();
        else
            out.put(e++).row();
    }
    out.say("NPOIN= ").put(s.points.size()).row();
    for (std::size_t v = 0; v < s.points.size(); ++v) out.put(s.points[v], dimension).put(v).row();
    out.say("NMARK= ").put(markers).row().say(below.text);
    return out.text;
}

/// The .node file, points counted from `first`.
inline std::string tetgen_nodes(const volume_sample& s, int first = 1, int dimension = 3)
{
    number_text out({});
    out.say("# a comment\n").put(s.points.size()).put(dimension).put(1).put(1).say(" # behind a line\n");
    for (std::size_t v = 0; v < s.points.size(); ++v)
        out.put(static_cast<int>(v) + first).put(s.points[v], dimension).put(0.75).put(v % 2).row();
    return out.text;
}

inline std::string tetgen_cells(const volume_sample& s, io::cell_kind kind, int first = 1)
{
    std::size_t n = 0;
    number_text out({});
    for (const auto& c : s.cells) n += c.kind == kind;
    out.put(n);
    if (kind != io::cell_kind::triangle) out.put(4);
    out.put(1).row();
    n = 0;
    for (const auto& c : s.cells)
    {
        if (c.kind != kind) continue;
        out.put(static_cast<int>(n++) + first);
        for (const idx v : c.corners) out.put(v + first);
        out.put(c.tag).row();
    }
    return out.text;
}

} // namespace taut::test
