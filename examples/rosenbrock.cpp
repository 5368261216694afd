// SPDX-License-Identifier: MIT
// The solvers on a function of one's own: no mesh, no device. The chained Rosenbrock function of 100 variables, first
// from its gradient alone, then with its Hessian.
#include <cstddef>
#include <iostream>
#include <span>
#include <vector>

#include <taut/solve.hpp>

// [function]
/// sum of 100 (x[i+1] - x[i]^2)^2 + (1 - x[i])^2: fills all of g and returns the value.
double valley(std::span<const double> x, std::span<double> g)
{
    double sum = 0;
    g.back() = 0;
    for (std::size_t i = 0; i + 1 < x.size(); ++i)
    {
        const double a = x[i + 1] - x[i] * x[i], b = 1 - x[i];
        sum += 100 * a * a + b * b;
        g[i] = (i == 0 ? 0 : g[i]) - 400 * a * x[i] - 2 * b;
        g[i + 1] = 200 * a;
    }
    return sum;
}
// [function]

// [hessian]
/// The same with what Newton's method asks for. The Hessian is tridiagonal.
class valley_with_hessian : public taut::solve::host_objective<double (*)(std::span<const double>, std::span<double>)>
{
public:
    explicit valley_with_hessian(std::size_t n) : host_objective(n, valley), diagonal_(n), beside_(n) {}

    /// All that follows is at x. Where `exact` is false, a positive semi-definite approximation is needed: here that of
    /// Gauss and Newton, without the curvature of the terms.
    void linearize(const std::vector<double>& x, bool exact)
    {
        const std::size_t n = x.size();
        for (std::size_t i = 0; i < n; ++i)
        {
            const double curvature = exact && i + 1 < n ? -400 * (x[i + 1] - x[i] * x[i]) : 0;
            diagonal_[i] = (i + 1 < n ? 800 * x[i] * x[i] + 2 : 0) + (i > 0 ? 200 : 0) + curvature;
            beside_[i] = i + 1 < n ? -400 * x[i] : 0;
        }
    }

    /// out = A v
    void hessian_product(const std::vector<double>& v, std::vector<double>& out) const
    {
        const std::size_t n = v.size();
        for (std::size_t i = 0; i < n; ++i)
            out[i] =
                diagonal_[i] * v[i] + (i + 1 < n ? beside_[i] * v[i + 1] : 0) + (i > 0 ? beside_[i - 1] * v[i - 1] : 0);
    }

    /// out = M v, with M a positive definite guess of the inverse: here of the diagonal.
    void precondition(const std::vector<double>& v, std::vector<double>& out) const
    {
        for (std::size_t i = 0; i < v.size(); ++i) out[i] = v[i] / (diagonal_[i] > 1 ? diagonal_[i] : 1);
    }

private:
    std::vector<double> diagonal_, beside_;
};
// [hessian]

int main()
{
    namespace solve = taut::solve;
    std::vector<double> start(100, 1.0);
    for (std::size_t i = 0; i < start.size(); i += 2) start[i] = -1.2;

    // [gradient]
    solve::host_objective f(100, valley); // a lambda will do as well
    std::vector<double> x = start;
    const auto report = solve::minimize(f, x, {.gradient_tolerance = 1e-10});
    std::cout << report << ", x[0] = " << x[0] << '\n';
    // [gradient]

    // [newton]
    valley_with_hessian g(100);
    std::vector<double> y = start;
    const auto second = solve::minimize(g, y, {.method = solve::method::newton, .gradient_tolerance = 1e-10});
    std::cout << second << ", x[0] = " << y[0] << '\n';
    // [newton]
}
