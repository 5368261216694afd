// SPDX-License-Identifier: MIT
#include <cmath>

#include <doctest/doctest.h>

#include <taut/recording.hpp>
#include <taut/symbolic.hpp>
#include <taut/traced_vectors.hpp>

#include "numeric.hpp"

using taut::sym;

namespace
{

template <class T, int D>
struct deformed
{
    taut::mat<D, T> S;
    T det;
};

template <class T, int D>
T norm2(const taut::mat<D, T>& S)
{
    T sum{};
    for (int c = 0; c < D; ++c) sum += dot(S[c], S[c]);
    return sum;
}

/// (|S|^2 / (D det(S)^(2/D)))^p, as a user writes it.
struct mips_power
{
    double p = 2;

    template <class T, int D>
    T operator()(const deformed<T, D>& e) const
    {
        return pow(norm2<T, D>(e.S) / (D * pow(e.det, T(2.0 / D))), T(p));
    }
};

template <class T, int D>
struct sample
{
    taut::mat<D, double> S;
    sample()
    {
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r) S[c][r] = (c == r ? 1.5 : 0.0) + 0.4 * std::sin(2.0 * c + 3 * r + 1);
    }
    double host(int entry, double value, double p) const
    {
        taut::mat<D, double> moved = S;
        moved[entry / D][entry % D] = value;
        return mips_power{p}(deformed<double, D>{moved, determinant(moved)});
    }
};

template <class T, int D>
void check_energy(double p)
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const sample<T, D> at;
    deformed<sym<T>, D> e;
    std::vector<sym<T>> x;
    std::vector<taut::binding> values;
    for (int k = 0; k < D * D; ++k)
    {
        x.push_back(e.S[k / D][k % D] = sym<T>::variable());
        values.emplace_back(x.back(), T(at.S[k / D][k % D]));
    }
    e.det = determinant(e.S);
    const sym<T> E = mips_power{p}(e);
    const auto g = differentiate(E, x);

    const double tolerance = std::is_same_v<T, float> ? 2e-5 : 1e-8;
    CHECK(near(taut::evaluate(std::vector{E}, values)[0], T(at.host(0, at.S[0][0], p)), tolerance));
    const auto gradient = taut::evaluate(g, values);
    for (int k = 0; k < D * D; ++k)
        CHECK(near(double(gradient[std::size_t(k)]),
                   difference([&](double s) { return at.host(k, s, p); }, at.S[k / D][k % D]), tolerance));
}

} // namespace

TEST_CASE_TEMPLATE("energy: one template gives the host's value and its gradient, triangles and tetrahedra", T, float,
                   double)
{
    for (const double p : {1.0, 2.0, 1.5, 0.7})
    {
        check_energy<T, 2>(p);
        check_energy<T, 3>(p);
    }
}

TEST_CASE("energy: second derivatives are symmetric and agree with differences of the gradient")
{
    constexpr int D = 3;
    taut::tape t;
    const taut::tape_scope scope(t);
    const sample<double, D> at;
    deformed<sym<double>, D> e;
    std::vector<sym<double>> x;
    for (int k = 0; k < D * D; ++k) x.push_back(e.S[k / D][k % D] = sym<double>::variable());
    e.det = determinant(e.S);
    const auto g = differentiate(mips_power{2}(e), x);
    std::vector<sym<double>> hessian;
    for (const auto& row : g)
        for (const auto& entry : differentiate(row, x)) hessian.push_back(entry);
    CHECK(t.size() < 4000);

    const auto bind = [&](int entry, double offset)
    {
        std::vector<taut::binding> values;
        for (int k = 0; k < D * D; ++k)
            values.emplace_back(x[std::size_t(k)], at.S[k / D][k % D] + (k == entry ? offset : 0));
        return values;
    };
    const auto h = taut::evaluate(hessian, bind(0, 0));
    for (int i = 0; i < D * D; ++i)
        for (int j = 0; j < D * D; ++j)
        {
            const auto column = [&](double offset) { return taut::evaluate(g, bind(j, offset))[std::size_t(i)]; };
            CHECK(near(h[std::size_t(i * D * D + j)], difference(column, 0.0), 1e-7));
            CHECK(near(h[std::size_t(i * D * D + j)], h[std::size_t(j * D * D + i)], 1e-11));
        }
}

TEST_CASE("energy: in two dimensions, integer powers leave no transcendental function in the kernel")
{
    taut::recording r;
    const auto x = r.in<double>("x");
    const auto y = r.out<double>("y");
    const auto n = r.scalar<taut::idx>("n");
    const auto i = r.global_id();
    deformed<sym<double>, 2> e;
    std::vector<sym<double>> entries;
    for (int k = 0; k < 4; ++k) entries.push_back(e.S[k / 2][k % 2] = x[i + k * n]);
    e.det = determinant(e.S);
    const auto E = mips_power{3}(e);
    y[i] = E;
    const auto g = differentiate(E, entries);
    for (int k = 0; k < 4; ++k) y[i + (k + 1) * n] = g[std::size_t(k)];
    const std::string source = r.finish("mips").source;
    CHECK(source.find("pow") == std::string::npos);
    CHECK(source.find("sqrt") == std::string::npos);
    CHECK(std::count(source.begin(), source.end(), '/') == 2); // one for the value, one for the gradient
}
