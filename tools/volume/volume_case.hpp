// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/measure/shape_quality.hpp>
#include <taut/impl/core/measure/singular_values.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/impl/files/volume/write_volume.hpp>
#include <taut/quality.hpp>
#include <taut/surface_file.hpp>

namespace taut::tools
{

/// Returns whether a name is that of a volume file, problems aside.
bool names_volume(const std::string& path);

/// Throws usage_error for "-": a mesh is one file or two.
void require_file(const std::string& output);

/// Throws usage_error for a name that says another format than that of the input, or would overwrite it.
void require_name(const std::string& output, const io::volume_file& file, const std::string& option = "-o");

/// Reads a volume file. rest: the file of the shape at rest, or empty; its points become the `rest` of the result.
/// zone: of SU2 files of several, 0: none. Throws io_error, and unsuitable_input where the two are not of the same
/// vertices and cells.
io::volume_file read_volume_at_rest(const std::string& path, const std::string& rest, int zone);

/// "32 tetrahedra", "12 hexahedra, 3 wedges": the cells of a dimension by kind.
std::string count_cells(const io::volume_file& file, int dimension);

/// Faults of cells, and their shapes; ids as io::impl::for_each_cell() counts.
struct volume_state
{
    certificate simplices;                       ///< of the corners of all cells, or of these themselves
    std::vector<idx> inverted;                   ///< cells with a corner that is not positive
    std::vector<idx> negative_inside, undecided; ///< cells with positive corners that Bezier bounds do not find valid
    shape_quality shapes;
};

/// Fills in negative_inside and undecided, by validity_of_cell(). x: one per point.
void judge_insides(const io::volume_file& file, std::span<const vec3> x, volume_state& state);

/// The cells of a volume file, or of a planar one, as simplices.
template <class Element>
class volume_case
{
public:
    static constexpr int D = Element::dimension;
    using map = std::vector<vec<D>>;

    /// The file is referred to. edged: as io::volume_file::corner_simplices() has it. Throws mesh_error, io_error.
    explicit volume_case(const io::volume_file& file, std::span<const idx> edged = {})
        : file_(file), parts_(file.corner_simplices<Element>(edged))
    {
    }

    const io::volume_file& file() const { return file_; }
    const mesh<Element>& simplices() const { return parts_.simplices; } ///< at rest
    const io::impl::corner_simplices<Element>& parts() const { return parts_; }
    std::size_t cells() const { return static_cast<std::size_t>(parts_.cells.back()) + 1; }
    const char* element() const { return parts_.overlapping ? "mixed" : Element::name; } ///< a word for programs

    /// As untangle_problem and others want them.
    std::vector<idx> owners() const { return parts_.overlapping ? parts_.cells : std::vector<idx>(); }

    /// Pins and springs of its vertices in a file, as io::read_pins() has them. Throws io_error.
    std::vector<io::pin<D>> read_pins(const std::string& path) const
    {
        return io::read_pins<D>(path, simplices().vertex_count(), file_.points.front().z);
    }

    /// Positions of the vertices in the file.
    map points() const { return {file_.points.begin(), file_.points.end()}; }

    /// All coordinates of the file with those of a map.
    std::vector<vec3> in_file(std::span<const vec<D>> x) const
    {
        auto points = file_.points;
        for (std::size_t v = 0; v < x.size(); ++v)
            for (int k = 0; k < D; ++k) points[v][k] = x[v][k];
        return points;
    }

    /// The map that readers of the file will have.
    map as_written(std::span<const vec<D>> x) const
    {
        const auto kept = file_.rounded(in_file(x));
        return {kept.begin(), kept.end()};
    }

    /// State of a map for readers that take its digits as doubles, or as the single precision that the file declares:
    /// of the two, the one with defects.
    volume_state look_as_read(std::span<const vec<D>> x) const
    {
        auto state = look(x);
        if (!state.simplices || !file_.places.single || file_.places.rounds()) return state;
        auto in_single = look(as_written(x));
        return in_single.simplices ? state : in_single;
    }

    volume_state look(std::span<const vec<D>> x) const
    {
        const auto& cells = simplices().cells();
        volume_state state{certify<D>(cells, x, {}, cells.size(), owners()),
                           {},
                           {},
                           {},
                           parts_.overlapping ? measure_shapes<Element>(cells, x, parts_.cells, parts_.regular)
                                              : measure_shapes<Element>(cells, x)};
        for (const idx s : state.simplices.ids) state.inverted.push_back(parts_.cells[static_cast<std::size_t>(s)]);
        state.inverted.erase(std::unique(state.inverted.begin(), state.inverted.end()), state.inverted.end());
        if constexpr (D == 3)
            if (parts_.overlapping) judge_insides(file_, x, state);
        return state;
    }

    /// Distortion of each cell: the largest max(s1, 1 / sD) of its corners, s the singular values of the map from rest;
    /// infinite where one is flat, NaN where it was at rest.
    std::vector<double> distortion(std::span<const vec<D>> x) const
    {
        const double unit = impl::unit_scale(simplices());
        return worst_of_cells(
            [&](std::size_t c)
            {
                const mat<D> W = impl::ideal_of(simplices(), static_cast<idx>(c), unit);
                if (!(Element::flatness(W) > impl::flattest)) return std::numeric_limits<double>::quiet_NaN();
                const auto s = impl::singular_values<D>(
                    impl::shape_matrix<D>(simplices().cells()[c], x, unit * impl::invert_upper(W)));
                return std::max(s.front(), 1 / s.back());
            });
    }

    /// Shape distortion of each cell: the largest 1 / mean ratio of its corners; infinite where one is not positive.
    std::vector<double> shape_distortion(std::span<const vec<D>> x) const
    {
        return worst_of_cells(
            [&](std::size_t c)
            {
                typename Element::mapped_corners corners;
                for (std::size_t k = 0; k < corners.size(); ++k)
                    corners[k] = x[static_cast<std::size_t>(simplices().cells()[c][k])];
                const double ratio = impl::corner_shape(corners, parts_.regular[c]).mean_ratio;
                return ratio > 0 ? 1 / ratio : std::numeric_limits<double>::infinity();
            });
    }

private:
    template <class F>
    std::vector<double> worst_of_cells(const F& of_simplex) const
    {
        std::vector<double> worst(cells(), 0.0);
        for (std::size_t c = 0; c < parts_.cells.size(); ++c)
        {
            double& cell = worst[static_cast<std::size_t>(parts_.cells[c])];
            const double here = of_simplex(c);
            cell = here > cell || here != here ? here : cell;
        }
        return worst;
    }

    const io::volume_file& file_;
    io::impl::corner_simplices<Element> parts_;
};

/// Throws mesh_error for cells that cannot all be positive and not overlap, by how they meet: io::impl::check_sides().
void require_mesh(const io::volume_file& file);

/// On cells that were turned while the file was read, of which there are some.
std::string turned_note(const io::volume_file& file);

/// Calls f(volume_case) for the cells that the file has: of the plane or of space.
template <class F>
auto with_case(const io::volume_file& file, const F& f)
{
    return file.dimension == 2 ? f(volume_case<triangle>(file)) : f(volume_case<tetrahedron>(file));
}

} // namespace taut::tools
