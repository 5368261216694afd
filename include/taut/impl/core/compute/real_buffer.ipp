// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/core/compute/queue_state.hpp>
#include <taut/queue.hpp>

namespace taut::impl
{

/// Throws parameter_error for a type that is not real.
inline number_type real_number_type(scalar_type type)
{
    if (type != scalar_type::f32 && type != scalar_type::f64) throw parameter_error("type", "must be f32 or f64");
    return type == scalar_type::f64 ? number_type_of<double> : number_type_of<float>;
}

inline device_memory memory_for(queue& q, scalar_type type, std::span<const double> values)
{
    const number_type of = real_number_type(type);
    if (type == scalar_type::f64) return {q, of, values.size(), values.data()};
    const std::vector<float> narrow(values.begin(), values.end());
    return {q, of, narrow.size(), narrow.data()};
}

} // namespace taut::impl

namespace taut
{

real_buffer::numbers::numbers(scalar_type type, std::size_t n)
{
    if (type == scalar_type::f64)
        numbers_ = std::vector<double>(n);
    else
        numbers_ = std::vector<float>(n);
}

std::size_t real_buffer::numbers::size() const noexcept
{
    return std::visit([](const auto& v) { return v.size(); }, numbers_);
}

double real_buffer::numbers::operator[](std::size_t i) const
{
    const auto* const wide = std::get_if<std::vector<double>>(&numbers_);
    return wide ? (*wide)[i] : static_cast<double>(std::get<std::vector<float>>(numbers_)[i]);
}

real_buffer::real_buffer(queue& q, scalar_type type, std::size_t n)
    : memory_(q, impl::real_number_type(type), n, nullptr)
{
}

real_buffer::real_buffer(queue& q, scalar_type type, std::span<const double> values)
    : memory_(impl::memory_for(q, type, values))
{
}

void real_buffer::upload(std::span<const double> values, std::size_t offset)
{
    if (type() == scalar_type::f64) return memory_.write(values.data(), values.size(), offset);
    const std::vector<float> narrow(values.begin(), values.end());
    memory_.write(narrow.data(), narrow.size(), offset);
}

void real_buffer::download(std::span<double> values, std::size_t offset) const
{
    if (type() == scalar_type::f64) return memory_.read(values.data(), values.size(), offset);
    std::vector<float> narrow(values.size());
    memory_.read(narrow.data(), narrow.size(), offset);
    std::copy(narrow.begin(), narrow.end(), values.begin());
}

std::vector<double> real_buffer::download() const
{
    std::vector<double> values(size());
    download(std::span(values));
    return values;
}

void real_buffer::begin_download(numbers& values) const
{
    if (type() == scalar_type::f64)
    {
        auto& wide = std::get<std::vector<double>>(values.numbers_);
        memory_.begin_read(wide.data(), wide.size());
    }
    else
    {
        auto& narrow = std::get<std::vector<float>>(values.numbers_);
        memory_.begin_read(narrow.data(), narrow.size());
    }
}

void real_buffer::fill(double value)
{
    const auto narrow = static_cast<float>(value);
    memory_.fill(type() == scalar_type::f64 ? static_cast<const void*>(&value) : &narrow);
}

void real_buffer::copy_from(const real_buffer& other, std::size_t offset)
{
    if (other.type() != type()) throw parameter_error("copy to a buffer", "float and double do not mix");
    memory_.copy_from(other.memory_, offset);
}

} // namespace taut
