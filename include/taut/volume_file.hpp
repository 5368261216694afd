// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_VOLUME_FILE
#endif
#ifndef TAUT_VOLUME_FILE_HPP
#define TAUT_VOLUME_FILE_HPP

#include <bit>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/constraints.hpp>
#include <taut/errors.hpp>
#include <taut/impl/files/volume/coding/array_code.hpp>
#include <taut/impl/files/volume/volume_file.hpp>
#include <taut/mesh.hpp>
#include <taut/surface_file.hpp>
#include <taut/untangle_problem.hpp>

/// Files of volumes: cells of all kinds, groups, and their adjacency.
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

constexpr const cell_shape& shape_of(cell_kind kind)
{
    return cell_shapes[static_cast<std::size_t>(kind)];
}

} // namespace taut::io::impl

namespace taut::io
{

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

/// Error of a group that does not exist, or of a name that several have. what() lists those that exist.
class group_error : public error
{
public:
    group_error(std::string name, const std::string& what) : error(what), name_(std::move(name)) {}
    const std::string& name() const noexcept { return name_; }

private:
    std::string name_;
};

/// Locations and encoding of the coordinates in the bytes of a file.
struct coordinate_places
{
    bool text = true;                             ///< decimal numbers; else IEEE 754
    bool single = false;                          ///< the file declares single precision
    std::endian order = std::endian::native;      ///< byte order of binary coordinates
    int per_point = 3;                            ///< 3, or 2 in a planar file
    std::vector<std::size_t> offsets;             ///< the first byte of each, one point after the other, ascending
    std::optional<impl::coded_coordinates> coded; ///< then there are no offsets

    /// Returns whether coordinates are rounded when they are written. A text holds all digits, which readers may round.
    bool rounds() const { return single && !text; }
};

/// A part of a mesh that has a file of its own beside the main one: TetGen's .ele and .face.
struct companion_file
{
    std::string extension;
    std::string bytes;
};

} // namespace taut::io

namespace taut::io::impl
{

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
    std::vector<cell_block> cells;
    std::vector<idx> turned; ///< cells whose corners the file has in the other order, as for_each_cell() counts
    std::vector<volume_group> groups;
    std::vector<volume_label> labels; ///< labels that groups were made from
    std::vector<std::string> notes;   ///< parts that were not read, in sentences
    std::string bytes;                ///< the whole file
    std::vector<companion_file> companions;
    coordinate_places places;

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
    const volume_group& find_group(std::string_view name) const;

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

    /// Writes the file with new positions of its points; its files appear together or not at all. TetGen's .ele and
    /// .face beside a new .node are somebody else's. Throws io_error, also where these would be replaced;
    /// parameter_error.
    void write(const std::filesystem::path& to, std::span<const vec3> x) const;
};

/// Reads a volume mesh, or a planar mesh, with its groups.
/// Throws io_error with line or byte: unreadable, unknown, malformed, or a kind of mesh whose coordinates cannot be
/// replaced in the file (higher order, polyhedra, partitions, several pieces).
/// zone: number of the zone in a SU2 file of several, as IZONE= has it, from 1; 0: the file has one
volume_file read_volume_file(const std::filesystem::path& path, volume_format format = volume_format::automatic,
                             int zone = 0);

/// Reads the tetrahedra of a volume mesh. Throws mesh_error as volume_file::tetrahedra().
mesh<tetrahedron> read_volume(const std::filesystem::path& path, volume_format format = volume_format::automatic);

/// Writes a mesh that was made in memory, tetrahedra or triangles of the plane (all z equal), as text: MEDIT (.mesh),
/// gmsh (.msh), VTK (.vtk) or VTU (.vtu). A mesh that was read keeps its groups and bytes by volume_file::write.
/// x: one position per vertex; none: those at rest. Throws io_error, also for other names; parameter_error.
template <class Element>
void write_volume(const std::filesystem::path& to, const mesh<Element>& m,
                  std::span<const vec<Element::dimension>> x = {});

} // namespace taut::io

namespace taut
{

/// Makes the untangling problem of a mesh and a map of it, one position per vertex, under the hard pins; springs are
/// ignored. Pinned coordinates of the map are replaced by their targets.
/// Throws constraint_error (wrong_count) unless map and constraints are of this mesh.
template <class Element>
untangle_problem<Element> make_untangle_problem(mesh<Element> rest, std::vector<vec<Element::dimension>> initial,
                                                const constraints<Element>& pins)
{
    pins.impose(initial);
    return {std::move(rest), std::move(initial), pins.held()};
}

/// Makes the problem that a file states: its fixed vertices are pinned where the initial map has them.
/// Throws mesh_error where the cells make no mesh.
template <class Element>
untangle_problem<Element> make_untangle_problem(io::impl::prob_file<Element> file);

} // namespace taut

#include <taut/impl/files/volume/cell_faces.hpp>
#include <taut/impl/files/volume/write_volume.hpp>

#endif
#include <taut/impl/leave.inl>
