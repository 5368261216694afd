// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>
#include <random>

#include <doctest/doctest.h>

#include <support/mips_power.hpp>
#include <support/objective_cases.hpp>
#include <support/shared_context.hpp>
#include <support/symmetric_eigen.hpp>

#include <taut/elements.hpp>
#include <taut/energies.hpp>
#include <taut/impl/core/energy/algebra.hpp>
#include <taut/impl/core/objective/element_hessian.hpp>
#include <taut/impl/core/objective/volume_objective.hpp>
#include <taut/symbolic.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using test::arithmetic;
using matrix = Eigen::MatrixXd;
using vector = Eigen::VectorXd;
using slots = hessian_slots<2>;

/// Stretch along the first axis of the ideal element costs more: S -> S Q is seen.
struct anisotropic
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return (T(3) * glm::dot(e.S[0], e.S[0]) + glm::dot(e.S[1], e.S[1])) * (T(1) + T(1) / (e.det * e.det));
    }
};

/// The isometric energy with |S|^2 spelled by rows, which hides that it is isotropic.
struct spelled
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        const auto St = glm::transpose(e.S);
        return norm2(St) * (T(1) + T(1) / (e.det * e.det));
    }
};

struct hessian_energy
{
    const char* name;
    any_energy energy;
    bool isotropic;
};

std::vector<hessian_energy> hessian_energies()
{
    using namespace taut::energy;
    return {{"isometric", isometric{}, true},
            {"shape", shape{}, true},
            {"area", area{}, true},
            {"a sum", 0.7 * isometric{} + 0.3 * shape{} + 0.1 * test::mips_power{.p = 3}, true},
            {"a product", shape{} * area{}, true},
            {"anisotropic", anisotropic{}, false},
            {"spelled by rows", spelled{}, false},
            {"half isotropic", 0.5 * isometric{} + 0.5 * anisotropic{}, false}};
}

/// Elements that share no vertex, so that each can have any S and any ideal element.
struct elements
{
    std::vector<mat2> S, inverse;
    std::vector<double> weight;

    void add(const mat2& s, const mat2& w, double factor)
    {
        S.push_back(s);
        inverse.push_back(w);
        weight.push_back(factor);
    }
};

double stretch_ratio(const mat2& S)
{
    const double I = norm2(S), d = glm::determinant(S);
    return (I + std::sqrt(std::max(0.0, I * I - 4 * d * d))) / (2 * std::abs(d));
}

mat2 rotation(double a)
{
    return {std::cos(a), std::sin(a), -std::sin(a), std::cos(a)};
}

class generator
{
public:
    double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    mat2 turn() { return rotation(uniform(-std::numbers::pi, std::numbers::pi)); }
    mat2 stretched(double s1, double s2) { return turn() * mat2(s1, 0, 0, s2) * turn(); }
    double decade(double k) { return std::pow(10.0, uniform(-k, k)); }

    mat2 ideal() { return {decade(0.5), 0, uniform(-1, 1), decade(0.5)}; }

    /// In turn: any, rotations and similarities exactly and nearly, slivers.
    elements mixture(std::size_t n, double decades)
    {
        elements e;
        for (std::size_t k = 0; k < n; ++k)
        {
            mat2 S = stretched(decade(0.5), decade(0.5));
            if (k % 4 == 1)
            {
                const double s = k % 8 == 1 ? 1.0 : decade(1);
                S = s * (k % 16 < 8 ? turn() : mat2(1.0));
                if (k % 32 < 16) S[0][0] += uniform(-1, 1) * std::pow(10.0, uniform(-16, -6));
            }
            if (k % 4 == 2) S = stretched(decade(decades), decade(decades));
            e.add(S, ideal(), uniform(0.5, 2));
        }
        return e;
    }

private:
    std::mt19937 random_{7};
};

std::vector<matrix> on_device(queue& q, const any_energy& energy, const elements& e, definiteness sign,
                              const real_types& types = {})
{
    const std::size_t n = e.S.size();
    std::vector<taut::idx> corners(3 * n);
    std::vector<double> inverse(3 * n), x(6 * n);
    for (std::size_t c = 0; c < n; ++c)
    {
        const mat2 A = e.S[c] * glm::inverse(e.inverse[c]);
        for (std::size_t k = 0; k < 3; ++k)
        {
            corners[k * n + c] = static_cast<taut::idx>(3 * c + k);
            const vec2 p = k == 0 ? vec2(0.0) : A[static_cast<int>(k) - 1];
            x[3 * c + k] = p.x;
            x[3 * n + 3 * c + k] = p.y;
        }
        inverse[c] = e.inverse[c][0][0];
        inverse[n + c] = e.inverse[c][1][0];
        inverse[2 * n + c] = e.inverse[c][1][1];
    }
    const element_hessian_kernel<triangle> kernel(q, energy, types);
    real_buffer hessian(q, types.vector, slots::count * n);
    kernel.launch({n}, {{"corners", buffer<taut::idx>(q, corners)},
                        {"inverse", real_buffer(q, types.vector, inverse)},
                        {"measure", real_buffer(q, types.vector, std::vector<double>(n, 1.0))},
                        {"weight", real_buffer(q, types.vector, e.weight)},
                        {"x", real_buffer(q, types.position, x)},
                        {"cell_stride", static_cast<taut::idx>(n)},
                        {"vertex_stride", static_cast<taut::idx>(3 * n)},
                        kernel.as_argument(sign),
                        {"hessian", hessian}});
    const auto h = hessian.download();

    std::vector<matrix> result(n, matrix(6, 6));
    for (std::size_t c = 0; c < n; ++c)
        for (int a = 0; a < 6; ++a)
            for (int b = 0; b < 6; ++b)
                result[c](a, b) = h[static_cast<std::size_t>(slots::at(a / 2, a % 2, b / 2, b % 2)) * n + c];
    return result;
}

/// Derivatives of an energy by the entries of S in double on the host.
class host_energy
{
public:
    explicit host_energy(const any_energy& energy)
    {
        const tape_scope scope(tape_);
        for (int k = 0; k < 4; ++k) unknowns_.push_back(S_[k / 2][k % 2] = sym<double>::variable());
        gradient_ = differentiate(energy(element<sym<double>, 2>{S_, glm::determinant(S_), 1.0}), unknowns_);
        for (const auto g : gradient_)
            for (const auto second : differentiate(g, unknowns_)) hessian_.push_back(second);
    }

    vector gradient(const mat2& S) { return Eigen::Map<const vector>(evaluate_at(S, gradient_).data(), 4); }
    matrix hessian(const mat2& S) { return Eigen::Map<const matrix>(evaluate_at(S, hessian_).data(), 4, 4); }

private:
    std::vector<double> evaluate_at(const mat2& S, const std::vector<sym<double>>& f)
    {
        const tape_scope scope(tape_);
        std::vector<binding> values;
        for (int k = 0; k < 4; ++k) values.emplace_back(unknowns_[static_cast<std::size_t>(k)], S[k / 2][k % 2]);
        return evaluate(f, values);
    }

    tape tape_;
    glm::mat<2, 2, sym<double>> S_;
    std::vector<sym<double>> unknowns_, gradient_, hessian_;
};

/// d S / d corners, S by columns.
matrix corner_map(const mat2& inverse)
{
    matrix K = matrix::Zero(4, 6);
    for (int c = 0; c < 2; ++c)
        for (int i = 0; i < 2; ++i)
            for (int k = 0; k < 2; ++k)
            {
                K(2 * c + i, 2 * (k + 1) + i) += inverse[c][k];
                K(2 * c + i, i) -= inverse[c][k];
            }
    return K;
}

/// The worst error of all elements, in units of rounding times the condition of det S, which is that of the problem.
template <class A>
double worst_error(queue& q, const any_energy& energy, const elements& e, definiteness sign)
{
    const auto device = on_device(q, energy, e, sign, A::types());
    host_energy host(energy);
    double worst = 0;
    for (std::size_t c = 0; c < e.S.size(); ++c)
    {
        const matrix H = host.hessian(e.S[c]);
        const auto K = corner_map(e.inverse[c]);
        const auto eigen = test::decompose(H);
        const matrix filtered = sign == definiteness::projected  ? eigen.clamped()
                                : sign == definiteness::absolute ? eigen.absolute()
                                                                 : H;
        const matrix expected = e.weight[c] * (K.transpose() * filtered * K);
        const double unit = A::epsilon * stretch_ratio(e.S[c]) * e.weight[c] * H.norm() * K.squaredNorm();
        const double error = (device[c] - expected).norm() / unit;
        worst = std::isnan(error) ? std::numeric_limits<double>::infinity() : std::max(worst, error);
    }
    return worst;
}

} // namespace

TEST_CASE("element Hessian: an energy is known as isotropic by its recording, without being declared")
{
    for (const hessian_energy& tried : hessian_energies())
    {
        CAPTURE(tried.name);
        CHECK(is_isotropic<2>(tried.energy) == tried.isotropic);
    }
}

TEST_CASE("element Hessian: the slots are a bijection of the pairs of coordinates")
{
    std::vector<int> uses(slots::count, 0);
    for (int a = 0; a < 6; ++a)
        for (int b = a; b < 6; ++b)
        {
            const int slot = slots::at(a / 2, a % 2, b / 2, b % 2);
            REQUIRE(slot >= 0);
            REQUIRE(slot < slots::count);
            ++uses[static_cast<std::size_t>(slot)];
            CHECK(slot == slots::at(b / 2, b % 2, a / 2, a % 2));
        }
    CHECK(slots::count == 21);
    for (const int n : uses) CHECK(n == 1);
}

TEST_CASE("element Hessian: it is the derivative of the gradient, by finite differences on the host")
{
    queue q(test::shared_context());
    const auto e = generator().mixture(64, 0.5);
    for (const hessian_energy& tried : hessian_energies())
    {
        CAPTURE(tried.name);
        const auto device = on_device(q, tried.energy, e, definiteness::indefinite);
        host_energy host(tried.energy);
        double worst = 0;
        for (std::size_t c = 0; c < e.S.size(); ++c)
        {
            const auto K = corner_map(e.inverse[c]);
            // A move of one corner coordinate moves S by a column of K.
            const double h = 1e-4 * std::sqrt(glm::determinant(e.S[c]) / stretch_ratio(e.S[c]));
            matrix expected(6, 6);
            for (int a = 0; a < 6; ++a)
            {
                const vector direction = K.col(a);
                const double length = direction.norm();
                const auto at = [&](double t) -> vector
                {
                    mat2 S = e.S[c];
                    for (int k = 0; k < 4; ++k) S[k / 2][k % 2] += t * direction(k) / length;
                    return host.gradient(S);
                };
                // Fourth order.
                const vector change = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h) * length;
                expected.col(a) = e.weight[c] * (K.transpose() * change);
            }
            worst = std::max(worst, (device[c] - expected).norm() / expected.norm());
        }
        CHECK(worst < 1e-8);
    }
}

TEST_CASE_TEMPLATE("element Hessian: as it is, projected and absolute are those of the host, slivers included", A,
                   arithmetic<precision::fp64>, arithmetic<precision::mixed>)
{
    queue q(test::shared_context());
    // In float a ratio of stretches of 1e6 leaves no digit of det S.
    const double decades = A::types().vector == scalar_type::f64 ? 3 : 1.5;
    const auto e = generator().mixture(512, decades);
    for (const hessian_energy& tried : hessian_energies())
    {
        CAPTURE(tried.name);
        for (const auto sign : {definiteness::indefinite, definiteness::projected, definiteness::absolute})
        {
            CAPTURE(static_cast<int>(sign));
            CHECK(worst_error<A>(q, tried.energy, e, sign) < 30);
        }
    }
}

TEST_CASE_TEMPLATE("element Hessian: projected is positive semi-definite to rounding on any element", A,
                   arithmetic<precision::fp64>, arithmetic<precision::mixed>)
{
    queue q(test::shared_context());
    const auto e = generator().mixture(4096, 3);
    for (const hessian_energy& tried : hessian_energies())
    {
        CAPTURE(tried.name);
        double least = 0;
        bool finite = true;
        for (const auto& H : on_device(q, tried.energy, e, definiteness::projected, A::types()))
        {
            finite = finite && H.allFinite();
            if (!H.allFinite()) continue;
            const auto values = test::decompose(H).values;
            if (values.maxCoeff() > 0) least = std::min(least, values.minCoeff() / values.maxCoeff());
        }
        CHECK(finite);
        CHECK(least > -64 * A::epsilon);
    }
}

TEST_CASE("element Hessian: the twist mode of the isometric energy has its closed form")
{
    queue q(test::shared_context());
    generator random;
    elements e;
    std::vector<vec2> stretches;
    std::vector<vector> twists;
    for (int k = 0; k < 256; ++k)
    {
        const vec2 s = k == 0 ? vec2(1.0) : vec2(random.decade(0.5), random.decade(0.5));
        const mat2 U = random.turn(), V = random.turn();
        e.add(U * mat2(s.x, 0, 0, s.y) * V, mat2(1.0), 1.0);
        const mat2 twist = U * mat2(0, 1, -1, 0) * V / std::numbers::sqrt2;
        stretches.push_back(s);
        twists.push_back(Eigen::Map<const vector>(&twist[0][0], 4));
    }
    const auto plain = on_device(q, energy::isometric{}, e, definiteness::indefinite);
    const auto projected = on_device(q, energy::isometric{}, e, definiteness::projected);
    int negative = 0;
    for (std::size_t c = 0; c < e.S.size(); ++c)
    {
        const double product = stretches[c].x * stretches[c].y;
        const double expected = 2 - 2 * (glm::dot(stretches[c], stretches[c]) - product) / std::pow(product, 3);
        negative += expected < 0;
        // With W = 1 corners 1 and 2 are the columns of S.
        const auto along = [&](const matrix& H) { return twists[c].dot(H.bottomRightCorner(4, 4) * twists[c]); };
        const double rounding = 1e-13 * plain[c].norm();
        CHECK(std::abs(along(plain[c]) - expected) < rounding);
        CHECK(std::abs(along(projected[c]) - std::max(expected, 0.0)) < rounding);
    }
    CHECK(negative > 50);
    CHECK(negative < 200);
}

TEST_CASE_TEMPLATE("element Hessian: eigenvalues clamped or absolute are those of Eigen, in the plane and in space",
                   Size, std::integral_constant<int, 4>, std::integral_constant<int, 9>)
{
    constexpr int N = Size::value;
    tape recorded;
    const tape_scope scope(recorded);
    symmetric_matrix<sym<double>, N> H;
    std::vector<sym<double>> unknowns, outputs;
    for (int j = 0; j < N; ++j)
        for (int i = 0; i <= j; ++i) unknowns.push_back(H(i, j) = sym<double>::variable());
    for (const bool absolute : {false, true})
    {
        const auto traced = filtered_matrix<sym<double>, N>::of(H, scalar_type::f64, {.absolute = absolute});
        for (int j = 0; j < N; ++j)
            for (int i = 0; i <= j; ++i) outputs.push_back(traced(i, j));
    }

    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 80; ++trial)
    {
        // In turn: random, of low rank and so with repeated eigenvalues, graded over 12 decades, and 0.
        matrix M = matrix::NullaryExpr(N, N, [&] { return normal(random); });
        M = (M + M.transpose()).eval();
        const vector u = M.col(0).normalized();
        if (trial % 4 == 1) M = matrix::Identity(N, N) - 3 * u * u.transpose();
        if (trial % 4 == 2)
            for (int j = 0; j < N; ++j)
                for (int i = 0; i < N; ++i) M(i, j) *= std::pow(10.0, -6.0 * (i + j) / (N - 1));
        if (trial == 3) M.setZero();

        std::vector<binding> values;
        std::size_t next = 0;
        for (int j = 0; j < N; ++j)
            for (int i = 0; i <= j; ++i) values.emplace_back(unknowns[next++], M(i, j));
        const auto result = evaluate(outputs, values);

        const auto eigen = test::decompose(M);
        double worst = 0;
        next = 0;
        for (const matrix& expected : {matrix(eigen.clamped()), matrix(eigen.absolute())})
            for (int j = 0; j < N; ++j)
                for (int i = 0; i <= j; ++i) worst = std::max(worst, std::abs(result[next++] - expected(i, j)));
        CAPTURE(trial);
        CHECK(worst <= 1e-13 * M.norm());
    }
}

TEST_CASE("element Hessian: in space its kernel writes each entry of the matrix once")
{
    using E = element_hessian_kernel<tetrahedron>;
    const auto text = E::record(energy::isometric{}, real_types{}, kernel_form::guarded);
    std::size_t stores = 0;
    for (std::size_t at = 0; (at = text.source.find("hessian[", at)) != std::string::npos; ++at) ++stores;
    CHECK(stores == static_cast<std::size_t>(E::slots::count));
    CHECK(E::slots::count == 78);
}
