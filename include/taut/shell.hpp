// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_SHELL_HPP
#define TAUT_SHELL_HPP

#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <utility>
#include <vector>

#include <taut/cell_data.hpp>
#include <taut/energies.hpp>
#include <taut/impl/core/energy/eigenvalue_filter.hpp>
#include <taut/impl/core/energy/modes.hpp>
#include <taut/impl/core/mesh/describe.hpp>
#include <taut/impl/core/mesh/facets.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/impl/core/mesh/thin_shell.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>
#include <taut/symbolic.hpp>
#include <taut/types.hpp>

/// Thin shells: surfaces in space that bend.
namespace taut
{

/// Element policy: two triangles of a surface at their common edge, mapped from space to space.
///
///        2
///       / \        the triangles are (0, 1, 2) and (1, 0, 3), oriented alike
///      0---1
///       \ /
///        3
///
/// It has the corners of a tetrahedron, which is flat where the surface is: it has no orientation that a map could
/// invert, and its ideal is no rest shape but a length. The rest shape is given by attributes of cells
/// (thin_shell.hpp).
struct hinge
{
    static constexpr int dimension = 3;
    static constexpr int corners = 4;
    static constexpr bool oriented = false;
    static constexpr double measure_factor = 1.0 / 6.0;
    static constexpr const char *name = "hinge", *names = "hinges";

    static constexpr const char *facet_name = "triangle", *facet_names = "triangles";

    using rest_corners = std::array<vec3, 4>;
    using mapped_corners = std::array<vec3, 4>;

    /// The identity times the length of the common edge: S = A W^-1 has the edges from corner 0 as columns.
    static mat3 ideal(const rest_corners& x) { return mat3(std::sqrt(glm::dot(x[1] - x[0], x[1] - x[0]))); }

    /// Directions mean nothing to it.
    static mat3 frame(const rest_corners&, const vec3&) { return mat3(1.0); }

    static bool is_thick(const rest_corners& x) { return glm::dot(x[1] - x[0], x[1] - x[0]) > 0; }

    /// 1 where there is a common edge.
    static double flatness(const mat3& W) { return W[0][0] > 0 ? 1 : 0; }
};

/// Thin shell: a surface in space that bends and stretches, as its hinges and their rest shapes. Vertices are those of
/// the surface. Sums over hinges are integrals over the surface: the area of a triangle is divided equally among its
/// hinges.
class thin_shell
{
public:
    /// surface: an oriented manifold with any number of components, holes and handles, no triangle of it flat.
    /// Throws mesh_error, also for triangles without a neighbour, which have no hinge.
    explicit thin_shell(mesh<triangle> surface)
        : surface_(checked(std::move(surface))), hinges_(surface_.points(), find_hinges())
    {
        describe_rest();
    }

    const mesh<triangle>& surface() const { return surface_; }
    const mesh<hinge>& hinges() const { return hinges_; }
    const cell_data& rest() const { return rest_; } ///< data of the hinges: shell_attributes
    double mean_edge() const { return mean_edge_; } ///< root of the mean square of the edges with two triangles

private:
    static mesh<triangle> checked(mesh<triangle> m)
    {
        validate(m,
                 {.referenced = false, .connected = false, .open = false, .one_boundary = false, .no_handles = false});
        return m;
    }

    std::vector<mesh<hinge>::cell> find_hinges()
    {
        const auto table = impl::facets(surface_);
        const auto& cells = surface_.cells();
        hinges_of_.assign(cells.size(), 0);
        std::vector<mesh<hinge>::cell> found;
        for (std::size_t side = 0; side < table.twin.size(); ++side)
        {
            if (table.twin[side] < static_cast<idx>(side)) continue; // on the boundary, or seen from the other side
            const auto twin = static_cast<std::size_t>(table.twin[side]);
            const auto edge = impl::side_vertices(surface_, static_cast<idx>(side));
            found.push_back({edge[0], edge[1], cells[side / 3][side % 3], cells[twin / 3][twin % 3]});
            triangles_.push_back({side / 3, twin / 3});
            ++hinges_of_[side / 3];
            ++hinges_of_[twin / 3];
        }
        std::vector<idx> alone;
        for (std::size_t t = 0; t < cells.size(); ++t)
            if (hinges_of_[t] == 0) alone.push_back(static_cast<idx>(t));
        if (!alone.empty())
        {
            const auto text = impl::list_ids("triangle", "triangles", alone);
            throw mesh_error(mesh_error::several_components, std::move(alone),
                             text + " without a neighbour, which cannot bend; remove isolated ones");
        }
        return found;
    }

    void describe_rest()
    {
        double area = 0, squares = 0;
        const std::size_t count = hinges_.cells().size();
        for (std::size_t c = 0; c < count; ++c)
        {
            const auto x = hinges_.rest(static_cast<idx>(c));
            for (std::size_t k = 0; k < 2; ++k) area += share(c, k);
            squares += glm::dot(x[1] - x[0], x[1] - x[0]);
        }
        const double mean_area = area / static_cast<double>(count), mean_square = squares / static_cast<double>(count);
        mean_edge_ = std::sqrt(mean_square);
        rest_.attribute_count = impl::shell_attributes::count;
        for (std::size_t c = 0; c < count; ++c)
        {
            const auto x = hinges_.rest(static_cast<idx>(c));
            const double length = glm::length(x[1] - x[0]);
            for (const std::size_t opposite : {2U, 3U})
            {
                const mat2 inverse = impl::invert_upper(triangle::ideal({x[0], x[1], x[opposite]})) * length;
                add({inverse[0][0], inverse[1][0], inverse[1][1]});
            }
            add({share(c, 0) / mean_area, share(c, 1) / mean_area});
            const vec3 e = x[1] - x[0], a = glm::cross(e, x[2] - x[0]), b = glm::cross(x[3] - x[0], e);
            const double first = glm::length(a), second = glm::length(b); // twice the areas
            add({2 * length * length / (first + second) * mean_square / mean_area});
            add({glm::dot(a, b) / (first * second), length * glm::dot(a, x[3] - x[0]) / (first * second)});
        }
    }

    void add(std::initializer_list<double> numbers)
    {
        rest_.attributes.insert(rest_.attributes.end(), numbers.begin(), numbers.end());
    }

    /// Share of a hinge in the area of its triangle k.
    double share(std::size_t c, std::size_t k) const
    {
        const auto x = surface_.rest(static_cast<idx>(triangles_[c][k]));
        return glm::length(glm::cross(x[1] - x[0], x[2] - x[0])) / 2 / hinges_of_[triangles_[c][k]];
    }

    mesh<triangle> surface_;
    std::vector<std::array<std::size_t, 2>> triangles_; ///< triangles of each hinge
    std::vector<int> hinges_of_;                        ///< number of hinges of each triangle
    mesh<hinge> hinges_;
    cell_data rest_;
    double mean_edge_ = 0;
};

} // namespace taut

namespace taut::energy
{

/// Thin shell energy, summed over the hinges of a surface (mesh/hinge.hpp); 0 at rest and at its rigid motions.
///
///     sum over both triangles of share (tr G (1 + 1/det G) - 4) + h^2 / 3 |e|^2 / (A + A') (2 tan(d/2))^2
///
/// G = J'J of the 3 x 2 Jacobian J of a triangle: the symmetric Dirichlet energy of its singular values, +infinity
/// where it has no area. d: by how much the angle at the hinge differs from that at rest; 2 tan(d/2), which is d where
/// it is small, is smooth and forbids that a hinge closes. The bending energy is that of discrete shells (Grinspun,
/// Hirani, Desbrun, Schroeder 2003) with the factor of a plate of thickness h: bent with curvature k, its strain at
/// height z is zk, and the stretching energy near rest is 4 strain^2, so 4 k^2 h^2 / 12 in the mean; the sum of |e|^2 /
/// (A + A') d^2 is the integral of k^2 on regular triangles (Seung, Nelson 1988).
///
/// Attributes: shell_attributes. Parameter 0: h in units of thin_shell::mean_edge().
struct shell
{
    static constexpr bool barrier = false; // of det S, which has no meaning

    template <class T>
    T operator()(const element<T, 3>& e) const
    {
        const T t = half_tangent(e), h = e.parameter(0);
        return e.attribute(taut::impl::shell_attributes::shares) * stretching(membrane<T>(e, 0)) +
               e.attribute(taut::impl::shell_attributes::shares + 1) * stretching(membrane<T>(e, 1)) +
               h * h * e.attribute(taut::impl::shell_attributes::bending) * (T(4.0 / 3) * t * t);
    }

    /// Second derivatives by the entries of S, by columns. Filtered, the stretching energy of each triangle has its own
    /// eigenvalues filtered, and bending has what Gauss and Newton's method has, which is positive.
    template <class T>
    taut::impl::symmetric_matrix<T, 9> hessian(const element<T, 3>& e, const taut::impl::eigenvalue_filter<T>& filter,
                                               scalar_type type) const
    {
        taut::impl::symmetric_matrix<T, 9> H;
        for (int j = 0; j < 9; ++j)
            for (int i = 0; i <= j; ++i) H(i, j) = T(0.0);
        for (const std::size_t side : {0U, 1U})
            add_stretching(membrane<T>(e, side), e.attribute(taut::impl::shell_attributes::shares + side), filter, type,
                           H);

        const T h = e.parameter(0), t = half_tangent(e);
        const T twice = T(8.0 / 3) * h * h * e.attribute(taut::impl::shell_attributes::bending);
        std::vector<T> entries;
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) entries.push_back(e.S[c][r]);
        const auto slope = differentiate(t, entries);
        const T rest = select(filter.projected, T(0.0), twice * t);
        for (std::size_t j = 0; j < 9; ++j)
        {
            const std::vector<T> upper(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(j) + 1);
            const auto row = differentiate(slope[j], upper);
            for (std::size_t i = 0; i <= j; ++i)
            {
                T& entry = H(static_cast<int>(i), static_cast<int>(j));
                entry = entry + (twice * slope[i] * slope[j] + rest * row[i]);
            }
        }
        return H;
    }

private:
    template <class T>
    using vec3_of = glm::vec<3, T>;

    /// J of one of the triangles as columns, J = [S0, S_edge] B, with B upper triangular.
    template <class T>
    struct jacobian
    {
        int edge;
        T b00, b01, b11;
        vec3_of<T> x, y;
        vec3_of<T> normal; ///< x cross y
        T square;          ///< det G
    };

    template <class T>
    static jacobian<T> membrane(const element<T, 3>& e, std::size_t side)
    {
        const std::size_t at = side == 0 ? taut::impl::shell_attributes::first : taut::impl::shell_attributes::second;
        jacobian<T> j{side == 0 ? 1 : 2, e.attribute(at), e.attribute(at + 1), e.attribute(at + 2), {}, {}, {}, {}};
        j.x = e.S[0] * j.b00;
        j.y = e.S[0] * j.b01 + e.S[j.edge] * j.b11;
        j.normal = glm::cross(j.x, j.y);
        j.square = glm::dot(j.normal, j.normal);
        return j;
    }

    template <class T>
    static T stretching(const jacobian<T>& j)
    {
        const T trace = glm::dot(j.x, j.x) + glm::dot(j.y, j.y);
        const T some = select(j.square > T(0.0), j.square, T(1.0));
        return select(j.square > T(0.0), trace * (T(1.0) + T(1.0) / some) - T(4.0),
                      T(std::numeric_limits<double>::infinity()));
    }

    /// tan(d / 2) from cosines and sines: sin d / (1 + cos d).
    template <class T>
    static T half_tangent(const element<T, 3>& e)
    {
        using std::sqrt;
        const auto a = glm::cross(e.S[0], e.S[1]), b = glm::cross(e.S[2], e.S[0]);
        const T areas = sqrt(glm::dot(a, a) * glm::dot(b, b));
        const T c = glm::dot(a, b) / areas, s = sqrt(glm::dot(e.S[0], e.S[0])) * glm::dot(a, e.S[2]) / areas;
        const T c0 = e.attribute(taut::impl::shell_attributes::cosine),
                s0 = e.attribute(taut::impl::shell_attributes::sine);
        return (s * c0 - c * s0) / (T(1.0) + (c * c0 + s * s0));
    }

    /// In a frame (u, v) of the image J = (u, v) R with R of 2 x 2, along which plane_modes has the Hessian; across it
    /// that is 2 dE/dG = 2 psi_I + psi_d / d adj G, for each coordinate of the domain.
    template <class T>
    static void add_stretching(const jacobian<T>& j, const T& weight, const taut::impl::eigenvalue_filter<T>& filter,
                               scalar_type type, taut::impl::symmetric_matrix<T, 9>& H)
    {
        using std::sqrt;
        const T xx = glm::dot(j.x, j.x), xy = glm::dot(j.x, j.y), yy = glm::dot(j.y, j.y);
        const T length = sqrt(xx), d = sqrt(j.square), zero = T(0.0);
        const vec3_of<T> u = j.x * (T(1.0) / length), n = j.normal * (T(1.0) / d), v = glm::cross(n, u);
        const glm::mat<2, 2, T> R(length, zero, xy / length, d / length);
        const auto psi = isometric::derivatives(xx + yy, d);
        const auto along = taut::impl::plane_modes<T>(R, psi, filter).hessian(weight);
        taut::impl::symmetric_matrix<T, 2> across;
        const T shear = psi.by_d / d;
        across(0, 0) = T(2.0) * psi.by_I + shear * yy;
        across(0, 1) = -(shear * xy);
        across(1, 1) = T(2.0) * psi.by_I + shear * xx;
        across = taut::impl::filtered_matrix<T, 2>::of(across, type, filter);

        // Over the entries of J, number 3 c + r, then over those of S.
        const auto of_jacobian = [&](int c, int r, int k, int s)
        {
            return u[r] * (along(2 * c, 2 * k) * u[s] + along(2 * c, 2 * k + 1) * v[s]) +
                   v[r] * (along(2 * c + 1, 2 * k) * u[s] + along(2 * c + 1, 2 * k + 1) * v[s]) +
                   weight * across(c, k) * n[r] * n[s];
        };
        for (int r = 0; r < 3; ++r)
            for (int s = 0; s < 3; ++s)
            {
                const T h00 = of_jacobian(0, r, 0, s), h01 = of_jacobian(0, r, 1, s), h11 = of_jacobian(1, r, 1, s),
                        h10 = of_jacobian(1, r, 0, s);
                // x and y of J by S0 and the other edge: (b00, 0) and (b01, b11).
                if (r <= s)
                {
                    H(r, s) = H(r, s) + (j.b00 * (j.b00 * h00 + j.b01 * (h01 + h10)) + j.b01 * j.b01 * h11);
                    T& far = H(3 * j.edge + r, 3 * j.edge + s);
                    far = far + j.b11 * j.b11 * h11;
                }
                T& mixed = H(r, 3 * j.edge + s);
                mixed = mixed + j.b11 * (j.b00 * h01 + j.b01 * h11);
            }
    }
};

} // namespace taut::energy

#endif
#include <taut/impl/leave.inl>
