// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_SURFACE_FILE
#endif
#ifndef TAUT_SURFACE_FILE_HPP
#define TAUT_SURFACE_FILE_HPP

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <taut/files.hpp>
#include <taut/impl/files/surface/prob.hpp>
#include <taut/impl/files/surface/surface_file.hpp>
#include <taut/mesh.hpp>
#include <taut/types.hpp>

/// Files of surfaces: OBJ, OFF, PLY and STL in; OBJ, pins and problems in and out.
namespace taut::io
{

/// Surface cut open along the seams of its texture coordinates, so that each vertex has one: the vertices of the file
/// in their order, then a further one for each further sheet of a vertex on a seam. Triangles keep their order.
struct cut_surface
{
    mesh<triangle> surface;
    std::vector<vec2> uv;          ///< of the file, one per vertex; 0 for a vertex without a triangle
    std::vector<idx> origins;      ///< the vertex of the file, one per vertex
    std::vector<idx> corners;      ///< the vertex of each corner of file_faces
    std::size_t seam_vertices = 0; ///< vertices of the file that lie on a seam
};

/// Error of a vertex whose corners carry no texture coordinate, or several: the file defines no map of the surface.
class texcoord_error : public error
{
public:
    texcoord_error(idx vertex, const std::string& what) : error(what), vertex_(vertex) {}
    idx vertex() const noexcept { return vertex_; }

private:
    idx vertex_;
};

class atomic_file;

/// Content of a surface file. Vertices and faces are in the order of the file, unreferenced vertices included.
struct surface_file
{
    mesh<triangle> surface;
    std::vector<vec2> texcoords;                    ///< as in the file; empty if it has none
    std::vector<std::array<idx, 3>> texcoord_cells; ///< one triple per triangle, into texcoords; -1: none
    std::vector<std::string> notes = {};            ///< changes in reading, in sentences
    impl::file_faces faces = {};                    ///< faces that the triangles were made from
    impl::file_vertices vertices = {};              ///< OFF and PLY
    impl::obj_text obj = {};                        ///< OBJ; else empty
    std::string texcoord_fault = {}; ///< fault of the texture coordinates of the file, which then are none
                                     ///< here: one is no finite number, or is named and not there; place and fault

    /// The texture coordinate of corner k of triangle c.
    /// Throws texcoord_error if it has none, or one that is not there.
    vec2 texcoord(std::size_t c, std::size_t k) const
    {
        const idx t = texcoord_cells.empty() ? -1 : texcoord_cells[c][k];
        if (t >= 0 && static_cast<std::size_t>(t) < texcoords.size()) return texcoords[static_cast<std::size_t>(t)];
        const idx v = surface.cells()[c][k];
        throw texcoord_error(
            v, "triangle " + std::to_string(c) + " has " +
                   (t < 0 ? "no texture coordinate"
                          : "texture coordinate " + std::to_string(t) + " of " + std::to_string(texcoords.size())) +
                   " at vertex " + std::to_string(v));
    }

    /// The texture coordinate of each vertex; 0 for a vertex without a triangle.
    /// Throws texcoord_error if a corner has none, or if a vertex lies on a seam: corners with different ones.
    std::vector<vec2> vertex_texcoords() const
    {
        const auto n = static_cast<std::size_t>(surface.vertex_count());
        std::vector<vec2> result(n, vec2(0.0));
        std::vector<char> known(n, 0);
        for (std::size_t c = 0; c < surface.cells().size(); ++c)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const idx vertex = surface.cells()[c][k];
                const auto v = static_cast<std::size_t>(vertex);
                const vec2 x = texcoord(c, k);
                if (known[v] && result[v] != x)
                    throw texcoord_error(vertex, "vertex " + std::to_string(vertex) +
                                                     " has several texture coordinates: it lies on a seam");
                known[v] = 1;
                result[v] = x;
            }
        return result;
    }

    /// Writes the file with new positions of its vertices, which read back bit for bit. Of OBJ every byte stays but the
    /// coordinates of v lines, also the normals, which are those at rest; OFF and PLY become OBJ with their vertices,
    /// colours and polygons.
    /// points: one per vertex. Throws io_error; parameter_error if there are more or fewer.
    void write(atomic_file& out, std::span<const vec3> points) const;
    void write(const std::filesystem::path& path, std::span<const vec3> points) const;

    /// Cuts the surface open along the edges where the texture coordinates of neighbours disagree in value; many
    /// programs write one vt per corner. Nothing if every vertex has one texture coordinate.
    /// Throws texcoord_error if a corner has none.
    std::optional<cut_surface> cut_seams() const;
};

/// Content of a surface file without validation: triangles may name vertices that do not exist, or one twice,
/// coordinates may be non-finite, and there may be no triangle. repair_surface() makes a surface of it.
struct surface_soup
{
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> triangles;      ///< of faces; polygons with a vertex that cannot be used as fans
                                                    ///< around its corner
    std::vector<vec2> texcoords;                    ///< as in surface_file
    std::vector<std::array<idx, 3>> texcoord_cells; ///< as in surface_file
    std::vector<vec3> normals;                      ///< as in the file; empty if it has none
    std::vector<std::array<idx, 3>> normal_cells;   ///< one triple per triangle, into normals, -1: none; empty: the
                                                    ///< normal of a corner has the number of its vertex
    std::vector<std::string> notes;                 ///< as in surface_file, and the rest, too
    impl::file_faces faces;
    impl::file_vertices vertices;
    impl::obj_text obj;
    std::optional<mesh_error> fault; ///< the first index, coordinate or face that cannot be used, and its place
    std::string texcoord_fault;      ///< as in surface_file
};

/// File formats of surfaces. automatic: by the extension, in either case; by the first bytes for standard input and
/// pipes, which have none.
enum class surface_format
{
    automatic,
    obj,
    off,
    ply,
    stl
};

/// Reads a surface with its texture coordinates and notes.
/// Throws io_error (unreadable, unknown or malformed, with line or byte), mesh_error (empty, NaN, ...).
surface_file read_surface_file(const std::filesystem::path& path, surface_format format = surface_format::automatic);

/// Reads the triangles of a file without validation, for repair_surface(). Throws io_error.
surface_soup read_surface_soup(const std::filesystem::path& path, surface_format format = surface_format::automatic);

/// Reads a surface without its texture coordinates and notes.
mesh<triangle> read_surface(const std::filesystem::path& path, surface_format format = surface_format::automatic);

/// Writes a surface and a map of it to the plane as OBJ: the vertices in their order with values that read back bit
/// for bit, one vt per vertex, faces v/vt.
/// uv: one per vertex. Throws io_error; parameter_error if uv has another size.
void write_obj(atomic_file& out, const mesh<triangle>& surface, std::span<const vec2> uv);

/// Writes the file that a surface was read from with other texture coordinates. Of OBJ every byte stays, but for vt
/// lines and the numbers of texture coordinates in faces; OFF and PLY become OBJ with their vertices, colours, normals,
/// polygons and comments.
/// uv: one per vertex. Throws io_error; parameter_error if uv has another size.
void write_obj(atomic_file& out, const surface_file& file, std::span<const vec2> uv);

/// The same for a map of the surface cut open, which `cut` was made by file.cut_seams().
/// uv: one per vertex of cut.surface.
void write_obj(atomic_file& out, const surface_file& file, const cut_surface& cut, std::span<const vec2> uv);

/// The same for a file as it is, whose corners have texture coordinates of their own, or none. A face gets them at all
/// corners or at none: a corner of a polygon that has none gets what lies between those before and after it.
/// texcoords: one per corner of file.faces, an index into uv; -1: none. Throws io_error; parameter_error if there are
/// more or fewer, or one names what is not there.
void write_obj(atomic_file& out, const surface_soup& file, std::span<const idx> texcoords, std::span<const vec2> uv);

/// Any of these to a file of its own, which appears complete or not at all.
template <class... Content>
void write_obj(const std::filesystem::path& path, const Content&... content)
{
    atomic_file out(path);
    write_obj(out, content...);
    out.commit();
}

/// Writes a map as text: one line per vertex, its coordinates with 17 significant digits, which read back bit for bit.
/// Throws io_error.
template <int D>
void write_map(atomic_file& file, std::span<const vec<D>> x)
{
    std::string text;
    for (const vec<D>& p : x)
    {
        for (int k = 0; k < D; ++k)
        {
            char digits[32];
            const auto end = std::to_chars(digits, std::end(digits), p[k], std::chars_format::general, 17).ptr;
            if (k > 0) text += ' ';
            text.append(digits, end);
        }
        text += '\n';
        if (text.size() < 1 << 16) continue;
        file.write(text);
        text.clear();
    }
    file.write(text);
}

/// The same to a file that appears complete or not at all.
template <int D>
void write_map(const std::filesystem::path& path, std::span<const vec<D>> x)
{
    atomic_file file(path);
    write_map<D>(file, x);
    file.commit();
}

/// One line of a file of pins. An infinite weight makes it hard: the coordinates in `held` (bit k: coordinate k) hold
/// exactly. A finite one makes it a spring to `target`, of which all coordinates are given.
template <int D>
struct pin
{
    idx vertex = 0;
    std::uint8_t held = 0;
    vec<D> target{0.0};
    double weight = std::numeric_limits<double>::infinity();

    bool hard() const { return std::isinf(weight); }
};

/// Reads a file of pins and springs. vertices: their number in the mesh. plane: the z of a planar mesh in space, which
/// pins may have behind x and y: four columns without a header are vertex,x,y,z then. Throws io_error with the line:
/// unreadable, malformed, a vertex out of range, a z elsewhere, a weight of 0.
template <int D>
std::vector<pin<D>> read_pins(const std::filesystem::path& path, idx vertices = std::numeric_limits<idx>::max(),
                              std::optional<double> plane = {});

/// Writes pins as read_pins reads them, with the digits that give every number back bit for bit. Throws io_error.
template <int D>
void write_pins(const std::filesystem::path& path, std::span<const pin<D>> pins);

/// Reads an untangling problem, of triangles or of tetrahedra, whichever the file holds. Throws io_error with the line:
/// unreadable or malformed.
std::variant<impl::prob_file<triangle>, impl::prob_file<tetrahedron>> read_prob(const std::filesystem::path& path);

} // namespace taut::io

#endif
#include <taut/impl/leave.inl>
