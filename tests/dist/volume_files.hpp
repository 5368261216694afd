// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <unistd.h>

#include <dist/pieces.hpp>

namespace taut::test
{

/// Text of a number that reads back the same.
inline std::string digits(double x)
{
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", x);
    return text;
}

/// Lines of vertices and cells, with what stands before and behind.
struct lines_of
{
    const mesh<tetrahedron>& m;
    std::string points(const std::string& after, int first_number = -1, int gap = 1) const
    {
        std::string text;
        for (std::size_t v = 0; v < m.points().size(); ++v)
        {
            const vec3 p = m.points()[v];
            if (first_number >= 0) text += std::to_string(first_number + gap * static_cast<int>(v)) + ' ';
            text += digits(p.x) + ' ' + digits(p.y) + "  " + digits(p.z) + after + '\n';
        }
        return text;
    }
    std::string numbers(int first, int gap = 1) const
    {
        std::string text;
        for (std::size_t v = 0; v < m.points().size(); ++v)
            text += std::to_string(first + gap * static_cast<int>(v)) + '\n';
        return text;
    }
    std::string cells(const std::string& before, const std::string& after, int first, int gap = 1,
                      bool numbered = false) const
    {
        std::string text;
        for (std::size_t c = 0; c < m.cells().size(); ++c)
        {
            if (numbered) text += std::to_string(c + 1) + ' ';
            text += before;
            for (const idx v : m.cells()[c]) text += std::to_string(first + gap * v) + ' ';
            text += after + '\n';
        }
        return text;
    }
    /// Triangles between the vertices of the side z = 0 of a bar of n cubes.
    std::vector<std::array<idx, 3>> floor() const
    {
        std::vector<std::array<idx, 3>> found;
        for (const auto& c : m.cells())
        {
            std::vector<idx> down;
            for (const idx v : c)
                if (m.points()[static_cast<std::size_t>(v)].z == 0) down.push_back(v);
            if (down.size() == 3) found.push_back({down[0], down[1], down[2]});
        }
        return found;
    }
};

inline std::string su2_of(const mesh<tetrahedron>& m)
{
    const lines_of l{m};
    std::string text = "% a bar\nNDIME= 3\nNELEM= " + std::to_string(m.cells().size()) + "\n" + l.cells("10 ", "", 0) +
                       "NPOIN= " + std::to_string(m.points().size()) + " % of them\n" + l.points(" 0") +
                       "NMARK= 1\nMARKER_TAG= floor\nMARKER_ELEMS= " + std::to_string(l.floor().size()) + "\n";
    for (const auto& f : l.floor())
        text += "5 " + std::to_string(f[0]) + ' ' + std::to_string(f[1]) + ' ' + std::to_string(f[2]) + '\n';
    return text;
}

inline std::string medit_of(const mesh<tetrahedron>& m)
{
    const lines_of l{m};
    std::string text = "MeshVersionFormatted 2\n\nDimension\n3\nVertices\n" + std::to_string(m.points().size()) + "\n" +
                       l.points(" 0") + "\n# cells\nTetrahedra " + std::to_string(m.cells().size()) + "\n" +
                       l.cells("", "4", 1) + "Triangles\n" + std::to_string(l.floor().size()) + "\n";
    for (const auto& f : l.floor())
        text += std::to_string(f[0] + 1) + ' ' + std::to_string(f[1] + 1) + ' ' + std::to_string(f[2] + 1) + " 7\n";
    return text + "End\n";
}

/// gap: of the numbers of the nodes.
inline std::string gmsh2_of(const mesh<tetrahedron>& m, int gap = 1)
{
    const lines_of l{m};
    const auto floor = l.floor();
    std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 9 \"floor\"\n$EndPhysicalNames\n"
                       "$Nodes\n" +
                       std::to_string(m.points().size()) + "\n" + l.points("", 1, gap) + "$EndNodes\n$Elements\n" +
                       std::to_string(m.cells().size() + floor.size()) + "\n" + l.cells("4 2 3 1 ", "", 1, gap, true);
    for (std::size_t k = 0; k < floor.size(); ++k)
        text += std::to_string(m.cells().size() + k + 1) + " 2 2 9 5 " + std::to_string(1 + gap * floor[k][0]) + ' ' +
                std::to_string(1 + gap * floor[k][1]) + ' ' + std::to_string(1 + gap * floor[k][2]) + '\n';
    return text + "$EndElements\n";
}

inline std::string gmsh4_of(const mesh<tetrahedron>& m)
{
    const lines_of l{m};
    const auto floor = l.floor();
    const auto n = std::to_string(m.points().size()), c = std::to_string(m.cells().size()),
               f = std::to_string(floor.size());
    std::string text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 9 \"floor\"\n$EndPhysicalNames\n"
                       "$Entities\n0 0 1 1\n5 0 0 0 1 1 0 1 9 0\n1 0 0 0 1 1 4 0 1 5\n$EndEntities\n"
                       "$Nodes\n2 " +
                       n + " 1 " + n + "\n2 5 0 0\n3 1 0 " + n + "\n" + l.numbers(1) + l.points("") +
                       "$EndNodes\n$Elements\n2 " + std::to_string(m.cells().size() + floor.size()) + " 1 9\n2 5 2 " +
                       f + "\n";
    for (std::size_t k = 0; k < floor.size(); ++k)
        text += std::to_string(k + 1) + ' ' + std::to_string(floor[k][0] + 1) + ' ' + std::to_string(floor[k][1] + 1) +
                ' ' + std::to_string(floor[k][2] + 1) + '\n';
    return text + "3 1 4 " + c + "\n" + l.cells("", "", 1, 1, true) + "$EndElements\n";
}

/// Arrays appended raw.
inline std::string vtu_of(const mesh<tetrahedron>& m)
{
    std::string data;
    std::vector<std::size_t> offsets;
    const auto append = [&](const void* bytes, std::size_t size)
    {
        offsets.push_back(data.size());
        const auto header = static_cast<std::uint32_t>(size);
        data.append(reinterpret_cast<const char*>(&header), sizeof header);
        data.append(static_cast<const char*>(bytes), size);
    };
    std::vector<std::int32_t> corners, ends, floor;
    std::vector<std::uint8_t> types(m.cells().size(), 10);
    for (const auto& c : m.cells())
    {
        corners.insert(corners.end(), c.begin(), c.end());
        ends.push_back(static_cast<std::int32_t>(corners.size()));
    }
    for (const vec3& p : m.points()) floor.push_back(p.z == 0 ? 1 : 0);
    append(m.points().data(), 24 * m.points().size());
    append(corners.data(), 4 * corners.size());
    append(ends.data(), 4 * ends.size());
    append(types.data(), types.size());
    append(floor.data(), 4 * floor.size());
    const auto array = [&](const std::string& type, const std::string& name, std::size_t k, const char* components)
    {
        return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" + components +
               "\" format=\"appended\" offset=\"" + std::to_string(offsets[k]) + "\"/>\n";
    };
    return "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n"
           "<UnstructuredGrid><Piece NumberOfPoints=\"" +
           std::to_string(m.points().size()) + "\" NumberOfCells=\"" + std::to_string(m.cells().size()) +
           "\">\n<PointData>" + array("Int32", "floor", 4, "1") + "</PointData><Points>" +
           array("Float64", "Points", 0, "3") + "</Points><Cells>" + array("Int32", "connectivity", 1, "1") +
           array("Int32", "offsets", 2, "1") + array("UInt8", "types", 3, "1") +
           "</Cells></Piece></UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_" + data +
           "\n</AppendedData></VTKFile>\n";
}

/// A folder that all processes see, removed at the end.
class common_folder
{
public:
    common_folder()
    {
        std::string name =
            (std::filesystem::temp_directory_path() / ("taut-dist-" + std::to_string(::getpid()))).string();
        name.resize(200);
        MPI_Bcast(name.data(), 200, MPI_CHAR, 0, MPI_COMM_WORLD);
        path_ = name.c_str();
        if (rank_of() == 0) std::filesystem::create_directories(path_);
        MPI_Barrier(MPI_COMM_WORLD);
    }
    ~common_folder()
    {
        MPI_Barrier(MPI_COMM_WORLD);
        std::error_code ignored;
        if (rank_of() == 0) std::filesystem::remove_all(path_, ignored);
    }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }

    /// Process 0 writes a file.
    std::filesystem::path put(const std::string& name, const std::string& text) const
    {
        if (rank_of() == 0) std::ofstream(path_ / name, std::ios::binary) << text;
        MPI_Barrier(MPI_COMM_WORLD);
        return path_ / name;
    }

private:
    std::filesystem::path path_;
};

inline std::string bytes_of(const std::filesystem::path& path)
{
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace taut::test
