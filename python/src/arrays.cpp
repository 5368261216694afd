// SPDX-License-Identifier: MIT
#include "arrays.hpp"

#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>

namespace taut::python
{

namespace
{

/// Calls f(std::type_identity<T>{}) with the type of the numbers of an array.
template <class F>
void with_type_of(const array& a, const F& f)
{
    const auto type = a.dtype();
    const auto is = [&]<class T>(std::type_identity<T> t)
    {
        if (type != nb::dtype<T>()) return false;
        f(t);
        return true;
    };
    const bool known = is(std::type_identity<double>{}) || is(std::type_identity<float>{}) ||
                       is(std::type_identity<std::int64_t>{}) || is(std::type_identity<std::int32_t>{}) ||
                       is(std::type_identity<std::uint32_t>{}) || is(std::type_identity<std::uint64_t>{}) ||
                       is(std::type_identity<std::int16_t>{}) || is(std::type_identity<std::uint16_t>{}) ||
                       is(std::type_identity<std::int8_t>{}) || is(std::type_identity<std::uint8_t>{}) ||
                       is(std::type_identity<bool>{});
    if (!known) throw parameter_error("array", "has numbers of a type that is not read; convert it to float64");
}

template <class To, class From>
To converted(From value)
{
    if constexpr (std::is_same_v<To, idx> && std::is_integral_v<From> && !std::is_same_v<From, bool>)
        return std::in_range<idx>(value) ? static_cast<idx>(value) : std::numeric_limits<idx>::max();
    else
        return static_cast<To>(value);
}

/// Calls put(row, column, number) with all numbers of an array of one or two dimensions; one: a row each.
template <class To, class Put>
void for_each_number(const array& a, const Put& put)
{
    const std::size_t rows = a.ndim() == 0 ? 0 : a.shape(0), columns = a.ndim() < 2 ? 1 : a.shape(1);
    if (rows == 0 || columns == 0) return;
    const auto down = a.stride(0), across = a.ndim() < 2 ? 0 : a.stride(1);
    with_type_of(a,
                 [&]<class T>(std::type_identity<T>)
                 {
                     const auto* first = static_cast<const char*>(a.data());
                     for (std::size_t r = 0; r < rows; ++r)
                         for (std::size_t c = 0; c < columns; ++c)
                         {
                             T value;
                             const auto at =
                                 static_cast<std::int64_t>(r) * down + static_cast<std::int64_t>(c) * across;
                             std::memcpy(&value, first + at * static_cast<std::int64_t>(sizeof(T)), sizeof(T));
                             put(r, c, converted<To>(value));
                         }
                 });
}

std::size_t rows_of(const array& a)
{
    return a.ndim() == 0 ? 0 : a.shape(0);
}

void require_columns(const array& a, std::size_t least, std::size_t most, const char* name)
{
    if (a.ndim() == 2 && a.shape(1) >= least && a.shape(1) <= most) return;
    throw parameter_error(name, "must have rows of " + std::to_string(least) +
                                    (most > least ? " or " + std::to_string(most) : "") + " numbers");
}

/// An array over memory that a vector keeps, which the array keeps.
template <class T, class Vector>
nb::object keeping(Vector values, std::initializer_list<std::size_t> shape)
{
    auto kept = std::make_unique<Vector>(std::move(values));
    auto* data = reinterpret_cast<T*>(kept->data());
    nb::capsule owner(kept.get(), [](void* p) noexcept { delete static_cast<Vector*>(p); });
    kept.release();
    return nb::cast(nb::ndarray<nb::numpy, T>(data, shape, owner));
}

} // namespace

template <int D>
std::vector<vec<D>> points_of(const array& rows, const char* name)
{
    require_columns(rows, D, D, name);
    std::vector<vec<D>> points(rows_of(rows));
    for_each_number<double>(rows, [&](std::size_t r, std::size_t c, double x) { points[r][static_cast<int>(c)] = x; });
    return points;
}
template std::vector<vec2> points_of<2>(const array&, const char*);
template std::vector<vec3> points_of<3>(const array&, const char*);

std::vector<vec3> places_of(const array& rows, const char* name)
{
    require_columns(rows, 2, 3, name);
    std::vector<vec3> points(rows_of(rows), vec3(0.0));
    for_each_number<double>(rows, [&](std::size_t r, std::size_t c, double x) { points[r][static_cast<int>(c)] = x; });
    return points;
}

template <std::size_t K>
std::vector<std::array<idx, K>> cells_of(const array& rows, const char* name)
{
    require_columns(rows, K, K, name);
    std::vector<std::array<idx, K>> cells(rows_of(rows));
    for_each_number<idx>(rows, [&](std::size_t r, std::size_t c, idx v) { cells[r][c] = v; });
    return cells;
}
template std::vector<std::array<idx, 2>> cells_of<2>(const array&, const char*);
template std::vector<std::array<idx, 3>> cells_of<3>(const array&, const char*);
template std::vector<std::array<idx, 4>> cells_of<4>(const array&, const char*);

std::vector<idx> ids_of(const array& numbers)
{
    std::vector<idx> ids;
    ids.reserve(numbers.size());
    for_each_number<idx>(numbers, [&](std::size_t, std::size_t, idx v) { ids.push_back(v); });
    return ids;
}

std::vector<double> numbers_of(const array& numbers)
{
    std::vector<double> values;
    values.reserve(numbers.size());
    for_each_number<double>(numbers, [&](std::size_t, std::size_t, double x) { values.push_back(x); });
    return values;
}

std::vector<char> flags_of(const array& numbers)
{
    std::vector<char> flags;
    flags.reserve(numbers.size());
    for_each_number<double>(numbers, [&](std::size_t, std::size_t, double x) { flags.push_back(x != 0); });
    return flags;
}

template <int D>
nb::object array_of(std::vector<vec<D>> points)
{
    static_assert(sizeof(vec<D>) == D * sizeof(double));
    const std::size_t n = points.size();
    return keeping<double>(std::move(points), {n, static_cast<std::size_t>(D)});
}
template nb::object array_of<2>(std::vector<vec2>);
template nb::object array_of<3>(std::vector<vec3>);

nb::object array_of(std::vector<double> numbers)
{
    const std::size_t n = numbers.size();
    return keeping<double>(std::move(numbers), {n});
}

nb::object array_of(std::vector<double> numbers, std::size_t columns)
{
    const std::size_t rows = columns == 0 ? 0 : numbers.size() / columns;
    return keeping<double>(std::move(numbers), {rows, columns});
}

nb::object array_of(const std::vector<idx>& ids)
{
    return keeping<std::int64_t>(std::vector<std::int64_t>(ids.begin(), ids.end()), {ids.size()});
}

template <std::size_t K>
nb::object array_of(const std::vector<std::array<idx, K>>& rows)
{
    std::vector<std::int64_t> numbers;
    numbers.reserve(K * rows.size());
    for (const auto& row : rows) numbers.insert(numbers.end(), row.begin(), row.end());
    return keeping<std::int64_t>(std::move(numbers), {rows.size(), K});
}
template nb::object array_of<2>(const std::vector<std::array<idx, 2>>&);
template nb::object array_of<3>(const std::vector<std::array<idx, 3>>&);
template nb::object array_of<4>(const std::vector<std::array<idx, 4>>&);

} // namespace taut::python
