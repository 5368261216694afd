// SPDX-License-Identifier: MIT
// Traced values and energies.
#include <memory>
#include <sstream>
#include <string>

#include <nanobind/operators.h>

#include <taut/energy.hpp>

#include "bindings.hpp"
#include "reports.hpp"

namespace taut::python
{

namespace
{

using real = sym<double>;

constexpr const char* no_truth =
    "a comparison of traced values is known only when the kernel runs, so it cannot steer `if`, `while`, `and`, `or` "
    "or `not`; use taut.where(condition, a, b), and & | ~ between conditions";

template <class Class, class F>
void add_binary(Class& c, const char* name, const char* reflected, const F& f)
{
    c.def(
        name, [f](real a, real b) { return f(a, b); }, nb::is_operator());
    c.def(
        name, [f](real a, double b) { return f(a, real(b)); }, nb::is_operator());
    if (reflected)
        c.def(
            reflected, [f](real a, double b) { return f(real(b), a); }, nb::is_operator());
}

void add_sym(nb::module_& m)
{
    nb::class_<sym_bool>(m, "SymBool", "A comparison of traced values.")
        .def("__and__", [](sym_bool a, sym_bool b) { return a && b; })
        .def("__or__", [](sym_bool a, sym_bool b) { return a || b; })
        .def("__invert__", [](sym_bool a) { return !a; })
        .def("__bool__", [](sym_bool) -> bool { throw tape_error(no_truth); });

    nb::class_<real> c(m, "Sym", "A traced scalar.");
    add_binary(c, "__add__", "__radd__", [](real a, real b) { return a + b; });
    add_binary(c, "__sub__", "__rsub__", [](real a, real b) { return a - b; });
    add_binary(c, "__mul__", "__rmul__", [](real a, real b) { return a * b; });
    add_binary(c, "__truediv__", "__rtruediv__", [](real a, real b) { return a / b; });
    add_binary(c, "__pow__", "__rpow__", [](real a, real b) { return pow(a, b); });
    add_binary(c, "__lt__", nullptr, [](real a, real b) { return a < b; });
    add_binary(c, "__le__", nullptr, [](real a, real b) { return a <= b; });
    add_binary(c, "__gt__", nullptr, [](real a, real b) { return a > b; });
    add_binary(c, "__ge__", nullptr, [](real a, real b) { return a >= b; });
    add_binary(c, "__eq__", nullptr, [](real a, real b) { return a == b; });
    add_binary(c, "__ne__", nullptr, [](real a, real b) { return a != b; });
    add_binary(c, "minimum", nullptr, [](real a, real b) { return min(a, b); });
    add_binary(c, "maximum", nullptr, [](real a, real b) { return max(a, b); });
    c.def("__neg__", [](real a) { return -a; });
    c.def("__pos__", [](real a) { return a; });
    c.def("__abs__", [](real a) { return abs(a); });
    c.def("__bool__", [](real) -> bool { throw tape_error(no_truth); });
    c.def("__float__",
          [](real) -> double
          {
              throw tape_error("a traced value has no number while it is being recorded; use the functions of numpy or "
                               "of taut, not those of math");
          });
    c.def("sqrt", [](real a) { return sqrt(a); });
    c.def("cbrt", [](real a) { return cbrt(a); });
    c.def("exp", [](real a) { return exp(a); });
    c.def("log", [](real a) { return log(a); });
    c.def("sin", [](real a) { return sin(a); });
    c.def("cos", [](real a) { return cos(a); });
    c.def("tan", [](real a) { return tan(a); });
    c.def("arctan", [](real a) { return atan(a); });
    c.def("floor", [](real a) { return floor(a); });
    m.def("constant", [](double x) { return real(x); });
    m.def("select", [](sym_bool condition, real a, real b) { return select(condition, a, b); });
}

template <int D>
using matrix = glm::mat<D, D, real>;

/// Rows of a matrix, as Python has them; glm has columns.
template <int D>
nb::list rows_of(const matrix<D>& S)
{
    nb::list rows;
    for (int r = 0; r < D; ++r)
    {
        nb::list row;
        for (int c = 0; c < D; ++c) row.append(nb::cast(S[c][r]));
        rows.append(row);
    }
    return rows;
}

template <int D>
matrix<D> matrix_of(const nb::list& rows)
{
    matrix<D> S;
    for (int r = 0; r < D; ++r)
        for (int c = 0; c < D; ++c)
        {
            const nb::object entry = rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
            S[c][r] = nb::isinstance<real>(entry) ? nb::cast<real>(entry) : real(nb::cast<double>(entry));
        }
    return S;
}

template <int D>
void add_recording(nb::module_& m, const char* name, const std::string& dimension)
{
    using recording = energy_recording<D>;
    nb::class_<std::shared_ptr<recording>>(m, name, "An energy that is being recorded.")
        .def("__init__", [](std::shared_ptr<recording>* self)
             { new (self) std::shared_ptr<recording>(std::make_shared<recording>()); })
        .def("S", [](const std::shared_ptr<recording>& r) { return rows_of<D>(r->S()); })
        .def("det", [](const std::shared_ptr<recording>& r) { return r->det(); })
        .def("measure", [](const std::shared_ptr<recording>& r) { return r->measure(); })
        .def("attribute", [](const std::shared_ptr<recording>& r, std::size_t k) { return r->attribute(k); })
        .def("parameter", [](const std::shared_ptr<recording>& r, std::size_t k) { return r->parameter(k); })
        .def("attributes", [](const std::shared_ptr<recording>& r) { return r->attributes(); })
        .def("parameters", [](const std::shared_ptr<recording>& r) { return r->parameters(); })
        .def("record",
             [](const std::shared_ptr<recording>& r, const nb::callable& function)
             {
                 const tape_scope scope(r->recorded());
                 const nb::object value = function();
                 r->finish(nb::isinstance<real>(value) ? nb::cast<real>(value) : real(nb::cast<double>(value)));
             })
        .def("trace",
             [](const std::shared_ptr<recording>& r, const any_energy& e)
             {
                 const std::vector<real> attributes = [&]
                 {
                     std::vector<real> all;
                     for (std::size_t k = 0; k < r->attributes(); ++k) all.push_back(r->attribute(k));
                     return all;
                 }();
                 std::vector<real> parameters;
                 for (std::size_t k = 0; k < r->parameters(); ++k) parameters.push_back(r->parameter(k));
                 return e(element<real, D>{r->S(), r->det(), r->measure(), attributes, parameters});
             });
    m.def(("norm2_" + dimension).c_str(), [](const nb::list& rows) { return norm2(matrix_of<D>(rows)); });
    m.def(("determinant_" + dimension).c_str(),
          [](const nb::list& rows) { return glm::determinant(matrix_of<D>(rows)); });
    m.def(("inverse_" + dimension).c_str(),
          [](const nb::list& rows) { return rows_of<D>(glm::inverse(matrix_of<D>(rows))); });
    m.def(("value_" + dimension).c_str(),
          [](const any_energy& e, const array& S, double measure, const array& attributes, const array& parameters)
          {
              const auto rows = points_of<D>(S, "S");
              if (rows.size() != D) throw parameter_error("S", "must be a square matrix");
              mat<D> m;
              for (int r = 0; r < D; ++r)
                  for (int c = 0; c < D; ++c) m[c][r] = rows[static_cast<std::size_t>(r)][c];
              const auto a = numbers_of(attributes), p = numbers_of(parameters);
              return e(element<double, D>{m, glm::determinant(m), measure, a, p});
          });
    m.def(("check_gradient_" + dimension).c_str(),
          [](const any_energy& e, const array& attributes, bool directions, const array& parameters, int trials)
          {
              const auto found = check_gradient<D>(
                  e.with_data(numbers_of(attributes), directions).with_parameters(numbers_of(parameters)), trials);
              nb::list faults;
              if (!found) faults.append(text((std::ostringstream() << found).str()));
              return faults;
          });
}

any_energy builtin(const std::string& name, double number)
{
    if (name == "isometric") return energy::isometric{};
    if (name == "shape") return energy::shape{};
    if (name == "area") return energy::area{};
    if (name == "shape_power") return energy::shape_power{static_cast<int>(number)};
    if (name == "neo_hookean") return energy::neo_hookean{number};
    throw parameter_error("energy",
                          "\"" + name + "\" is not known; isometric, shape, area, shape_power and neo_hookean are");
}

} // namespace

void add_energies(nb::module_& m)
{
    add_sym(m);
    nb::class_<any_energy>(m, "AnyEnergy", "An energy of the library.")
        .def_prop_ro("barrier", [](const any_energy& e) { return e.barrier(); })
        .def("keeping_curvature",
             [](const any_energy& e) { return e.with_eigenvalues(impl::negative_eigenvalues::absolute); });
    m.def("builtin_energy", &builtin);
    add_recording<2>(m, "Recording2", "2");
    add_recording<3>(m, "Recording3", "3");
    m.def(
        "recorded_energy",
        [](const std::shared_ptr<energy_recording<2>>* plane, const std::shared_ptr<energy_recording<3>>* space,
           bool barrier)
        { return any_energy(recorded_energy(plane ? *plane : nullptr, space ? *space : nullptr, barrier)); },
        nb::arg("plane").none(), nb::arg("space").none(), nb::arg("barrier"));
}

} // namespace taut::python
