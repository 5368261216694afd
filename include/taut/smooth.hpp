// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_DEFORM
#endif
#ifndef TAUT_SMOOTH_HPP
#define TAUT_SMOOTH_HPP

#include <vector>

#include <taut/impl/core/constrain/boundary_slides.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/options.hpp>
#include <taut/quality.hpp>
#include <taut/session.hpp>

/// Improves the shapes of the elements of a mesh.
namespace taut
{

/// Treatment of the boundary of a mesh during smoothing.
enum class smooth_boundary
{
    fixed,   ///< nothing
    sliding, ///< move in its own flat parts and along the straight creases between them; what is curved stays
    free     ///< all; the shape changes
};

/// Parameters of smooth(). Every field has a sensible default.
template <class Element>
struct smooth_params
{
    smooth_boundary boundary = smooth_boundary::sliding;

    /// Shape whose elements are the target shapes, one position per vertex; empty: regular elements are.
    std::vector<vec3> rest = {};

    /// Target shapes of single elements, and their owners, as in deform_params: those of corner_simplices::regular
    /// where they are corners of regular cells.
    std::vector<mat<Element::dimension>> targets = {};
    std::vector<idx> owners = {};

    /// Power of the energy, which is shape distortion: larger ones improve the worst elements first, 1 the mean. Range
    /// 1 to 8.
    int worst_exponent = 2;

    /// Vertices that are fixed, whatever smooth_params::boundary says.
    std::vector<idx> fixed = {};

    /// Facets, inside or on the boundary, of surfaces that keep their shape whatever the boundary does: interfaces
    /// between materials, named pieces of the boundary (io::volume_file::kept_facets() finds them). Flat pieces slide
    /// in their planes, straight lines where pieces meet or end along themselves; curved parts are fixed.
    std::vector<impl::kept_facet> kept = {};

    taut::precision precision = precision::automatic;
    solve::params solve = {.gradient_tolerance = 1e-4};

    /// Throws parameter_error that names the field; deform_params says the rest.
    void validate() const
    {
        if (worst_exponent < 1 || worst_exponent > 8) throw parameter_error("worst_exponent", "must be 1 to 8");
    }
};

/// Result of smooth(): positions, a report, and the qualities of the elements before and after; `auto [x, report,
/// before, after] = smooth(...)`.
template <class Element>
struct smooth_result
{
    std::vector<vec<Element::dimension>> x; ///< one per vertex, in the user's order and lengths
    session_report report;
    shape_quality before, after; ///< after: only with coordinates

    /// True if the mesh is certified: no element is inverted.
    explicit operator bool() const { return report.outcome == outcome::valid; }
};

/// Moves the vertices of a volume, or a mesh of the plane (z = 0), to improve the shapes of its elements, without
/// inverting one; inverted elements are untangled first. Connectivity is kept.
/// Throws mesh_error, parameter_error, constraint_error for wrong ids, device_error.
template <class Element>
smooth_result<Element> smooth(queue& q, const mesh<Element>& given, const smooth_params<Element>& params = {},
                              const run_limits& limits = {});

} // namespace taut

#endif
#include <taut/impl/leave.inl>
