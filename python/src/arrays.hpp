// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <taut/mesh.hpp>

namespace taut::python
{

namespace nb = nanobind;

/// An array of the user's where it lies: any type of numbers, any strides. It is read once, while the lock of the
/// interpreter is held.
using array = nb::ndarray<nb::ro, nb::device::cpu>;

/// Rows of numbers as points of D coordinates. Throws parameter_error for another number of columns.
template <int D>
std::vector<vec<D>> points_of(const array& rows, const char* name);

/// Rows of two or three numbers as points in space; of two: z = 0.
std::vector<vec3> places_of(const array& rows, const char* name);

/// Rows of K vertex numbers. What 32 bits do not hold becomes a number that no mesh has.
template <std::size_t K>
std::vector<std::array<idx, K>> cells_of(const array& rows, const char* name);

/// Numbers of an array of any shape, row by row.
std::vector<idx> ids_of(const array& numbers);
std::vector<double> numbers_of(const array& numbers);
std::vector<char> flags_of(const array& numbers);

/// The mesh of two arrays.
template <class Element>
mesh<Element> mesh_of(const array& points, const array& cells)
{
    return mesh<Element>(places_of(points, "V"), cells_of<Element::corners>(cells, "C"));
}

/// A new array of the interpreter's, in C order, that owns the memory of the vector: nothing is copied.
template <int D>
nb::object array_of(std::vector<vec<D>> points);
nb::object array_of(std::vector<double> numbers);
nb::object array_of(std::vector<double> numbers, std::size_t columns);

/// New arrays of 64-bit integers.
nb::object array_of(const std::vector<idx>& ids);
template <std::size_t K>
nb::object array_of(const std::vector<std::array<idx, K>>& rows);

} // namespace taut::python
