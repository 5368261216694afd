// SPDX-License-Identifier: MIT
#include <cmath>

#include <doctest/doctest.h>

#include <taut/symbolic.hpp>
#include <taut/traced_vectors.hpp>

#include "numeric.hpp"

using taut::evaluate;
using taut::sym;

namespace
{

template <int D>
using dimension = std::integral_constant<int, D>;

/// A traced matrix and the variables in it, with values that make it regular.
template <class T, int D>
struct traced_matrix
{
    taut::mat<D, sym<T>> traced;
    taut::mat<D, double> host;
    std::vector<sym<T>> entries;
    std::vector<taut::binding> values;

    traced_matrix()
    {
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r)
            {
                const T value = T(0.3 + 0.7 * std::sin(1.0 + 3 * c + 5 * r * r) + (c == r ? 2 : 0));
                entries.push_back(traced[c][r] = sym<T>::variable());
                values.emplace_back(entries.back(), value);
                host[c][r] = value;
            }
    }

    double value(sym<T> s) const { return double(evaluate(std::vector{s}, values).front()); }
};

template <class T>
constexpr double tolerance = std::is_same_v<T, float> ? 1e-5 : 1e-13;

template <class T, int D>
void check_functions()
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const traced_matrix<T, D> m;
    CHECK(near(m.value(determinant(m.traced)), determinant(m.host), tolerance<T>));
    CHECK(near(m.value(dot(m.traced[0], m.traced[1])), dot(m.host[0], m.host[1]), tolerance<T>));
    CHECK(near(m.value(length(m.traced[0])), length(m.host[0]), tolerance<T>));

    const auto check_matrix = [&](const taut::mat<D, sym<T>>& a, const taut::mat<D, double>& b)
    {
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r) CHECK(near(m.value(a[c][r]), b[c][r], 10 * tolerance<T>));
    };
    check_matrix(inverse(m.traced), inverse(m.host));
    check_matrix(transpose(m.traced), transpose(m.host));
    check_matrix(m.traced * m.traced, m.host * m.host);
    check_matrix(m.traced * transpose(m.traced) - m.traced, m.host * transpose(m.host) - m.host);
    check_matrix(2 * m.traced * 0.25 + m.traced / 3, 2.0 * m.host * 0.25 + m.host / 3.0);
    check_matrix(taut::mat<D, sym<T>>(m.host) * m.traced, m.host * m.host);
    check_matrix(outerProduct(m.traced[0], m.traced[1]), outerProduct(m.host[0], m.host[1]));

    const auto check_vector = [&](const taut::vec<D, sym<T>>& a, const taut::vec<D, double>& b)
    {
        for (int r = 0; r < D; ++r) CHECK(near(m.value(a[r]), b[r], 10 * tolerance<T>));
    };
    const auto u = m.traced[0];
    const auto v = m.traced[1];
    const auto hu = m.host[0];
    const auto hv = m.host[1];
    check_vector(m.traced * u, m.host * hu);
    check_vector(u * m.traced, hu * m.host);
    check_vector(-u + 3 * v - u / 2.0, -hu + 3.0 * hv - hu / 2.0);
    check_vector(u * v / (u + v), hu * hv / (hu + hv));
    check_vector(normalize(u), normalize(hu));
    check_vector(min(u, v), glm::min(hu, hv));
    check_vector(max(u, v), glm::max(hu, hv));
    check_vector(sqrt(abs(v)), glm::sqrt(glm::abs(hv)));
}

} // namespace

TEST_CASE_TEMPLATE("glm: unmodified types and functions agree with the host's in two dimensions", T, float, double)
{
    check_functions<T, 2>();
}

TEST_CASE_TEMPLATE("glm: unmodified types and functions agree with the host's in three dimensions", T, float, double)
{
    check_functions<T, 3>();
    taut::tape t;
    const taut::tape_scope scope(t);
    const traced_matrix<T, 3> m;
    const auto normal = cross(m.traced[0], m.traced[1]);
    const auto expected = cross(m.host[0], m.host[1]);
    for (int r = 0; r < 3; ++r) CHECK(near(m.value(normal[r]), expected[r], tolerance<T>));
    CHECK(near(m.value(dot(normal, m.traced[2])), determinant(m.host), 10 * tolerance<T>));
}

TEST_CASE_TEMPLATE("glm: the derivative of a determinant is the cofactor matrix", Dim, dimension<2>, dimension<3>,
                   dimension<4>)
{
    constexpr int D = Dim::value;
    taut::tape t;
    const taut::tape_scope scope(t);
    const traced_matrix<double, D> m;
    const auto g = differentiate(determinant(m.traced), m.entries);
    const auto cofactors = determinant(m.host) * transpose(inverse(m.host));
    for (int c = 0; c < D; ++c)
        for (int r = 0; r < D; ++r) CHECK(near(m.value(g[std::size_t(c * D + r)]), cofactors[c][r], 1e-12));
}

TEST_CASE("glm: vectors and matrices change their precision component by component")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const traced_matrix<double, 2> m;
    const taut::mat<2, sym<float>> narrow = taut::cast<float>(m.traced);
    const sym<float> f = dot(narrow[0], narrow[1]);
    CHECK(evaluate(std::vector{f}, m.values).front() == glm::dot(glm::vec2(m.host[0]), glm::vec2(m.host[1])));
    const auto wide = taut::cast<double>(narrow[0]);
    CHECK(m.value(wide[0]) == double(float(m.host[0][0])));
}

TEST_CASE_TEMPLATE("limits: the traits are the host type's, the values are constants", T, float, double)
{
    taut::tape t;
    const taut::tape_scope scope(t);
    using limits = std::numeric_limits<sym<T>>;
    static_assert(limits::is_specialized && limits::is_iec559 && limits::digits == std::numeric_limits<T>::digits);
    CHECK(evaluate(limits::epsilon()) == std::numeric_limits<T>::epsilon());
    CHECK(evaluate(limits::max()) == std::numeric_limits<T>::max());
    CHECK(evaluate(limits::lowest()) == std::numeric_limits<T>::lowest());
    CHECK(evaluate(limits::infinity()) == std::numeric_limits<T>::infinity());
}
