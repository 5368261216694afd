// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/core/error.hpp>
#include <taut/impl/io/coding/array_code.hpp>
#include <taut/impl/mesh/mesh.hpp>

namespace taut::impl
{

struct kept_facet;

} // namespace taut::impl

namespace taut::io
{

/// File formats of volumes. automatic: by the extension, in either case.
enum class volume_format
{
    automatic,
    medit,  ///< .mesh, text
    gmsh,   ///< .msh 2.x and 4.1, text and binary
    vtk,    ///< .vtk, legacy, text and binary, unstructured grids
    vtu,    ///< .vtu, text, base64 and appended, compressed or not
    tetgen, ///< .node and .ele, and .face if there is one; given by either name
    su2,    ///< .su2
    problem ///< .prob: the points are those of the initial map
};

/// Kinds of cells. Corners are in VTK's order, whatever a file has:
/// quad: around. tetrahedron: corner 3 sees 0, 1, 2 turn counter-clockwise. pyramid: so does corner 4 the base 0..3.
/// wedge: triangles 0, 1, 2 and 3, 4, 5, the normal of 0, 1, 2 pointing away from 3, 4, 5 (gmsh and MEDIT files have
/// it the other way round). hexahedron: quads 0..3 and 4..7, the normal of 0..3 pointing to 4..7.
enum class cell_kind
{
    vertex,
    line,
    triangle,
    quad,
    tetrahedron,
    pyramid,
    wedge,
    hexahedron
};

} // namespace taut::io

namespace taut::io::impl
{

struct cell_shape
{
    int dimension;
    int corners;
    const char *name, *names;
};

/// By cell_kind.
inline constexpr std::array<cell_shape, 8> cell_shapes = {{{0, 1, "vertex", "vertices"},
                                                           {1, 2, "line", "lines"},
                                                           {2, 3, "triangle", "triangles"},
                                                           {2, 4, "quad", "quads"},
                                                           {3, 4, "tetrahedron", "tetrahedra"},
                                                           {3, 5, "pyramid", "pyramids"},
                                                           {3, 6, "wedge", "wedges"},
                                                           {3, 8, "hexahedron", "hexahedra"}}};

constexpr const cell_shape& shape_of(cell_kind kind)
{
    return cell_shapes[static_cast<std::size_t>(kind)];
}

/// Puts the corners of a cell in the other order: it is mirrored. Twice is nothing.
inline void turn_cell(cell_kind kind, std::span<idx> corners)
{
    switch (kind)
    {
    case cell_kind::triangle:
    case cell_kind::tetrahedron:
        return std::swap(corners[1], corners[2]);
    case cell_kind::wedge:
        std::swap(corners[4], corners[5]);
        return std::swap(corners[1], corners[2]);
    case cell_kind::hexahedron:
        std::swap(corners[5], corners[7]);
        return std::swap(corners[1], corners[3]);
    case cell_kind::quad:
    case cell_kind::pyramid:
        return std::swap(corners[1], corners[3]);
    case cell_kind::vertex:
    case cell_kind::line:
        return;
    }
}

/// Cells of one kind that follow each other in a file.
struct cell_block
{
    cell_kind kind;
    std::vector<idx> corners; ///< shape_of(kind).corners per cell: positions in the points, never numbers of the file

    std::size_t size() const { return corners.size() / static_cast<std::size_t>(impl::shape_of(kind).corners); }

    std::span<const idx> cell(std::size_t c) const
    {
        const auto n = static_cast<std::size_t>(impl::shape_of(kind).corners);
        return std::span<const idx>(corners).subspan(n * c, n);
    }
};

/// Named group of vertices in a volume file.
struct volume_group
{
    std::string name;
    int dimension;             ///< dimension of its entities: 0 vertices, 1 lines, 2 faces, 3 volumes
    std::vector<idx> vertices; ///< ascending, each once
};

/// Integer labels of the points of a file, or of its cells of all kinds in their order: references of MEDIT, tags of
/// gmsh, arrays of VTK, attributes and markers of TetGen, markers of SU2.
struct volume_label
{
    std::string name;
    bool of_cells;
    std::vector<long long> values;
};

} // namespace taut::io::impl

namespace taut::io
{

/// Error of a group that does not exist, or of a name that several have. what() lists those that exist.
class group_error : public error
{
public:
    group_error(std::string name, const std::string& what) : error(what), name_(std::move(name)) {}
    const std::string& name() const noexcept { return name_; }

private:
    std::string name_;
};

} // namespace taut::io

namespace taut::io::impl
{

/// Coordinates that a file has in base64, compressed, or both (VTU): they are written anew together.
struct coded_coordinates
{
    /// An offset of an array that follows them, as the text has it.
    struct later
    {
        std::size_t begin, end; ///< range of its digits
        std::size_t offset;
    };
    impl::array_code code;
    std::size_t begin, end;         ///< range of the code in the file
    std::vector<later> followed_by; ///< ascending by `begin`
};

/// Locations and encoding of the coordinates in the bytes of a file.
struct coordinate_places
{
    bool text = true;                        ///< decimal numbers; else IEEE 754
    bool single = false;                     ///< the file declares single precision
    std::endian order = std::endian::native; ///< byte order of binary coordinates
    int per_point = 3;                       ///< 3, or 2 in a planar file
    std::vector<std::size_t> offsets;        ///< the first byte of each, one point after the other, ascending
    std::optional<coded_coordinates> coded;  ///< then there are no offsets

    /// Returns whether coordinates are rounded when they are written. A text holds all digits, which readers may round.
    bool rounds() const { return single && !text; }
};

/// A part of a mesh that has a file of its own beside the main one: TetGen's .ele and .face.
struct companion_file
{
    std::string extension;
    std::string bytes;
};

/// The cells of a file as simplices: tetrahedra, or triangles of a planar file, for themselves; others as the simplices
/// at their corners, which overlap.
template <class Element>
struct corner_simplices
{
    mesh<Element> simplices;                      ///< at rest
    std::vector<idx> cells;                       ///< the cell of each, as for_each_cell() counts
    bool overlapping = false;                     ///< there are cells of other kinds
    std::vector<mat<Element::dimension>> regular; ///< edge matrix of each where its cell has equal edges of length 1
    std::vector<double> weights; ///< weight of each, so that a cell counts once; exact for parallelepipeds
};

struct cell_faces;

} // namespace taut::io::impl

namespace taut::io
{

/// Content and bytes of a file of a volume mesh, or of a planar triangle mesh. Points and cells are in the order of the
/// file, unreferenced points included.
struct volume_file
{
    std::string path;   ///< as it was given
    std::string format; ///< "MEDIT", "gmsh", "VTK", "VTU", "TetGen", "SU2" or "problem"
    int zone = 0;       ///< SU2: the requested zone, from 1; 0: none
    int dimension = 3;  ///< 2: two coordinates per point, or no volume cell and all z equal
    std::vector<vec3> points;
    std::vector<vec3> rest; ///< problems: the rest shape, of which the points are a map; else empty: points at rest
    std::vector<impl::cell_block> cells;
    std::vector<idx> turned; ///< cells whose corners the file has in the other order, as for_each_cell() counts
    std::vector<impl::volume_group> groups;
    std::vector<impl::volume_label> labels; ///< labels that groups were made from
    std::vector<std::string> notes;         ///< parts that were not read, in sentences
    std::string bytes;                      ///< the whole file
    std::vector<impl::companion_file> companions;
    impl::coordinate_places places;

    /// The shape that its cells have at rest.
    const std::vector<vec3>& at_rest() const { return rest.empty() ? points : rest; }

    /// Tetrahedral mesh of the file at rest, cells in the order of the file. Some may be inverted: which, validate()
    /// tells. Throws io_error if there are volume cells of other kinds; mesh_error if there are none (empty).
    mesh<tetrahedron> tetrahedra() const;

    /// Triangle mesh of a planar file at rest, z as it is. Throws io_error if there are quads, mesh_error (empty) if
    /// there are no triangles, or the file is of dimension 3.
    mesh<triangle> triangles() const;

    /// Corner simplices of cells: one per corner with `dimension` edges, spanned by these edges: 4 per quad, 4 per
    /// pyramid (at the corners of its base), 6 per wedge, 8 per hexahedron; cells of lower dimension have none. That
    /// all are positive is necessary for a wedge, pyramid or hexahedron to be valid, not sufficient
    /// (exact/cell_validity.hpp decides it); for a quad it is both. Throws mesh_error (empty) as tetrahedra() does;
    /// triangles: also where the file has dimension 3.
    ///
    /// edged: wedges and hexahedra, ascending, that have the tetrahedra at their edges, too, after those at the
    /// corners, 6 and 24 (exact/cell_tetrahedra.hpp). Where all are positive a wedge is valid; of a hexahedron that is
    /// not proved, but no other was found in 700,000 at random.
    template <class Element = tetrahedron>
    impl::corner_simplices<Element> corner_simplices(std::span<const idx> edged = {}) const;

    /// The group of a name. A number alone finds the one group whose name ends in ":" and it. Throws group_error.
    const impl::volume_group& find_group(std::string_view name) const;

    /// Faces of all cells and their adjacency. Time O(n log(largest valence)).
    impl::cell_faces faces() const;

    /// Facets that smoothing preserves, for smooth_params::kept: sides between cells of different labels, references or
    /// regions, inner ones with a labelled face of the file (in the plane a line), and, if `boundary`, the sides of the
    /// boundary. A piece has the same labels on both sides and on its faces.
    std::vector<taut::impl::kept_facet> kept_facets(bool boundary) const;

    /// Points as the file holds them, or as readers may: rounded to single where it declares that, else as they are.
    /// Text itself holds every digit in any case.
    /// x: one per point of the file.
    std::vector<vec3> rounded(std::span<const vec3> x) const;

    /// Writes the file with new positions of its points; its files appear together or not at all. Throws io_error,
    /// parameter_error.
    void write(const std::filesystem::path& to, std::span<const vec3> x) const;
};

} // namespace taut::io

namespace taut::io::impl
{

/// Calls f(kind, number, corners) for each cell of the file of this dimension, in the order of the file; number:
/// counted over them, all kinds together, from 0.
template <class F>
void for_each_cell(const volume_file& file, int dimension, const F& f)
{
    idx number = 0;
    for (const auto& block : file.cells)
        if (shape_of(block.kind).dimension == dimension)
            for (std::size_t c = 0; c < block.size(); ++c) f(block.kind, number++, block.cell(c));
}

/// Puts the corners of cells of the file's dimension, ascending, in the other order, and says so in `turned`.
void turn_cells(volume_file& file, std::span<const idx> cells);

/// "12 cells (3, 5, ...) have their corners in the other order than ...": of `turned`; empty: there are none.
std::string describe_turned(const volume_file& file);

} // namespace taut::io::impl

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/io/volume/volume_file.ipp>
#endif
