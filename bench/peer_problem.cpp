// SPDX-License-Identifier: MIT
#include "peer_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <taut/impl/core/mesh/ideal.hpp>

namespace bench::peer
{

namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Edges 01 and 02 of a mapped triangle, or of its direction.
struct edges
{
    double ax, ay, bx, by;

    edges(const std::array<int, 3>& t, const double* x)
        : ax(x[2 * t[1]] - x[2 * t[0]]),
          ay(x[2 * t[1] + 1] - x[2 * t[0] + 1]),
          bx(x[2 * t[2]] - x[2 * t[0]]),
          by(x[2 * t[2] + 1] - x[2 * t[0] + 1])
    {
    }
};

/// The differential of a map on a triangle.
struct jacobian
{
    double a, b, c, d; // rows (a, b), (c, d)

    jacobian(const edges& e, double p, double q, double r)
        : a(e.ax * p), b(e.ax * q + e.bx * r), c(e.ay * p), d(e.ay * q + e.by * r)
    {
    }
    double det() const { return a * d - b * c; }
    double norm2() const { return a * a + b * b + c * c + d * d; }
};

/// J = U diag(s) V^T with rotations U = (cu, -su; su, cu) and V; det J > 0.
struct singular_values
{
    double s1, s2, cu, su, cv, sv;

    explicit singular_values(const jacobian& j)
    {
        // J is a rotation part (e, h) and a mirrored part (f, g); their half-angles give U and V.
        const double e = (j.a + j.d) / 2, f = (j.a - j.d) / 2, g = (j.c + j.b) / 2, h = (j.c - j.b) / 2;
        const double round = std::sqrt(e * e + h * h), flat = std::sqrt(f * f + g * g);
        s1 = round + flat;
        s2 = j.det() / s1;
        const double rc = e / round, rs = h / round; // the nearest rotation, U V^T
        // J^T J has the angle of (f + ig) turned back by the rotation part.
        const double vc = flat > 0 ? (f * rc + g * rs) / flat : 1, vs = flat > 0 ? (g * rc - f * rs) / flat : 0;
        // (vc, vs) = e^(2 i v): halve where it does not cancel.
        if (vc >= 0)
        {
            cv = std::sqrt((1 + vc) / 2);
            sv = vs / (2 * cv);
        }
        else
        {
            sv = std::copysign(std::sqrt((1 - vc) / 2), vs);
            cv = vs / (2 * sv);
        }
        cu = rc * cv - rs * sv;
        su = rs * cv + rc * sv;
    }
};

/// The upper triangle of a symmetric 6 x 6 matrix over corners, as blocks 00, 11, 22, 01, 12, 20 (row-major).
struct element_matrix
{
    std::array<std::array<double, 4>, 6> block{};

    /// Adds w m m^T, m = the change of J under each coordinate: (m1, m2) for corners 1 and 2.
    void add(double w, double m1x, double m1y, double m2x, double m2y)
    {
        const double m[3][2] = {{-(m1x + m2x), -(m1y + m2y)}, {m1x, m1y}, {m2x, m2y}};
        constexpr int from[6] = {0, 1, 2, 0, 1, 2}, to[6] = {0, 1, 2, 1, 2, 0};
        for (std::size_t k = 0; k < 6; ++k)
            for (std::size_t i = 0; i < 2; ++i)
                for (std::size_t j = 0; j < 2; ++j) block[k][2 * i + j] += w * m[from[k]][i] * m[to[k]][j];
    }
};

} // namespace

problem::problem(const taut::mesh<taut::triangle>& m, const std::vector<int>& rank) : vertices_(m.points().size())
{
    double total = 0;
    for (const auto& t : m.cells())
    {
        const auto at = [&](std::size_t k) { return m.points()[static_cast<std::size_t>(t[k])]; };
        const auto e = at(1) - at(0), f = at(2) - at(0);
        const double length = glm::length(e), along = glm::dot(e, f) / length,
                     height = glm::length(glm::cross(e, f)) / length;
        const auto named = [&](std::size_t k) { return rank[static_cast<std::size_t>(t[k])]; };
        corners_.push_back({named(0), named(1), named(2)});
        rest_.push_back({1 / length, -along / (length * height), 1 / height, length * height / 2});
        total += rest_.back().w;
    }
    for (auto& r : rest_) r.w /= total;
}

double problem::value(const std::vector<double>& x) const
{
    double sum = 0, least = infinity;
    for (std::size_t f = 0; f < corners_.size(); ++f)
    {
        const auto& [p, q, r, w] = rest_[f];
        const jacobian j(edges(corners_[f], x.data()), p, q, r);
        const double det = j.det();
        least = std::min(least, det);
        sum += w * j.norm2() * (1 + 1 / (det * det));
    }
    return least > 0 && sum < infinity ? sum : infinity;
}

double problem::gradient(const std::vector<double>& x, std::vector<double>& g) const
{
    g.assign(numbers(), 0);
    double sum = 0, least = infinity;
    for (std::size_t f = 0; f < corners_.size(); ++f)
    {
        const auto& [p, q, r, w] = rest_[f];
        const jacobian j(edges(corners_[f], x.data()), p, q, r);
        const double det = j.det(), n = j.norm2(), inv2 = 1 / (det * det);
        least = std::min(least, det);
        sum += w * n * (1 + inv2);
        const double s = 2 * w * (1 + inv2), c = -2 * w * n * inv2 / det;
        const double da = s * j.a + c * j.d, db = s * j.b - c * j.c, dc = s * j.c - c * j.b, dd = s * j.d + c * j.a;
        const double g1x = da * p + db * q, g1y = dc * p + dd * q, g2x = db * r, g2y = dd * r;
        const auto add = [&](int v, double gx, double gy)
        {
            g[static_cast<std::size_t>(2 * v)] += gx;
            g[static_cast<std::size_t>(2 * v + 1)] += gy;
        };
        add(corners_[f][0], -(g1x + g2x), -(g1y + g2y));
        add(corners_[f][1], g1x, g1y);
        add(corners_[f][2], g2x, g2y);
    }
    return least > 0 && sum < infinity ? sum : infinity;
}

void problem::matrix(const std::vector<double>& x, model kind, block_matrix& h) const
{
    std::fill(h.value.begin(), h.value.end(), 0.0);
    for (std::size_t f = 0; f < corners_.size(); ++f)
    {
        const auto& [p, q, r, w] = rest_[f];
        const singular_values v(jacobian(edges(corners_[f], x.data()), p, q, r));
        const double s1 = v.s1, s2 = v.s2;
        element_matrix e;
        // Adds the direction M = (a, b; c, d) of the differential.
        const auto add = [&](double weight, double a, double b, double c, double d)
        { e.add(weight, a * p + b * q, c * p + d * q, b * r, d * r); };
        if (kind == model::newton)
        {
            // Eigenvectors of an isotropic energy: stretches along the singular directions, flip and twist.
            const double cc = v.cu * v.cv, ss = v.su * v.sv, cs = v.cu * v.sv, sc = v.su * v.cv;
            const double i1 = 1 / (s1 * s1), i2 = 1 / (s2 * s2), cross = s1 * s2, i3 = i1 * i2 / cross;
            const double flip = 2 + 2 * (s1 * s1 + cross + s2 * s2) * i3;
            const double twist = 2 - 2 * (s1 * s1 - cross + s2 * s2) * i3;
            add(w * (2 + 6 * i1 * i1), cc, cs, sc, ss);
            add(w * (2 + 6 * i2 * i2), ss, -sc, -cs, cc);
            add(w * flip / 2, -(cs + sc), cc - ss, cc - ss, sc + cs);
            if (twist > 0) add(w * twist / 2, sc - cs, cc + ss, -(ss + cc), sc - cs);
        }
        else
        {
            const auto weight = [](double s) { return 2 * (1 + (1 + (1 + 1 / s) / s) / s); };
            const double l1 = w * weight(s1), l2 = w * weight(s2);
            add(l1, v.cu, 0, v.su, 0);
            add(l1, 0, v.cu, 0, v.su);
            add(l2, -v.su, 0, v.cu, 0);
            add(l2, 0, -v.su, 0, v.cu);
        }
        const slots& s = slots_[f];
        for (std::size_t k = 0; k < 3; ++k)
        {
            double* left = &h.value[static_cast<std::size_t>(s.left[k])];
            left[0] += e.block[k][0];
            left[1] += e.block[k][2];
            h.value[static_cast<std::size_t>(s.right[k])] += e.block[k][3];
        }
        for (std::size_t k = 3; k < 6; ++k)
        {
            double* left = &h.value[static_cast<std::size_t>(s.left[k])];
            double* right = &h.value[static_cast<std::size_t>(s.right[k])];
            const auto& b = e.block[k];
            const bool t = s.transposed[k - 3];
            left[0] += b[0];
            left[1] += t ? b[1] : b[2];
            right[0] += t ? b[2] : b[1];
            right[1] += b[3];
        }
    }
}

block_matrix problem::make_matrix()
{
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    std::vector<std::vector<int>> below(vertices_); // neighbours of higher number
    for (const auto& t : corners_)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
            below[at(low)].push_back(high);
        }
    block_matrix h;
    h.column.push_back(0);
    for (std::size_t v = 0; v < vertices_; ++v)
    {
        auto& rows = below[v];
        std::sort(rows.begin(), rows.end());
        rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
        const int first = static_cast<int>(2 * v);
        for (const int skip : {0, 1})
        {
            for (int i = skip; i < 2; ++i) h.row.push_back(first + i);
            for (const int n : rows) h.row.insert(h.row.end(), {2 * n, 2 * n + 1});
            h.column.push_back(static_cast<int>(h.row.size()));
        }
    }
    h.value.resize(h.row.size());

    slots_.resize(corners_.size());
    for (std::size_t f = 0; f < corners_.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const int from = corners_[f][k], to = corners_[f][(k + 1) % 3];
            slots& s = slots_[f];
            s.left[k] = h.column[at(2 * from)];
            s.right[k] = h.column[at(2 * from + 1)];
            const auto [low, high] = std::minmax(from, to);
            const auto& rows = below[at(low)];
            const int place = static_cast<int>(std::lower_bound(rows.begin(), rows.end(), high) - rows.begin());
            s.left[3 + k] = h.column[at(2 * low)] + 2 + 2 * place;
            s.right[3 + k] = h.column[at(2 * low + 1)] + 1 + 2 * place;
            s.transposed[k] = from < to; // the rows of the lower triangle are those of the higher vertex
        }
    return h;
}

double problem::longest_step(const std::vector<double>& x, const std::vector<double>& d) const
{
    double longest = infinity;
    for (const auto& t : corners_)
    {
        const edges e(t, x.data()), u(t, d.data());
        // det(t) = c + b t + a t^2
        const double c = e.ax * e.by - e.ay * e.bx;
        const double b = e.ax * u.by + u.ax * e.by - e.ay * u.bx - u.ay * e.bx;
        const double a = u.ax * u.by - u.ay * u.bx;
        const double discriminant = b * b - 4 * a * c;
        if (discriminant < 0) continue;
        const double root = 2 * c / (std::sqrt(discriminant) - b); // the smallest positive one, if it is positive
        if (root > 0) longest = std::min(longest, root);
    }
    return longest;
}

double problem::best_scale(const std::vector<double>& x) const
{
    double forward = 0, backward = 0; // |S|^2 and |S^-1|^2
    for (std::size_t f = 0; f < corners_.size(); ++f)
    {
        const auto& [p, q, r, w] = rest_[f];
        const jacobian j(edges(corners_[f], x.data()), p, q, r);
        const double n = w * j.norm2(), det = j.det();
        forward += n;
        backward += n / (det * det);
    }
    return std::pow(backward / forward, 0.25);
}

} // namespace bench::peer
