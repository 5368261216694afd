// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>

#include <taut/impl/compute/real_buffer.hpp>

namespace taut::impl
{

host_reals::host_reals(scalar_type type, std::size_t n)
{
    if (type == scalar_type::f64)
        numbers_ = std::vector<double>(n);
    else
        numbers_ = std::vector<float>(n);
}

double host_reals::operator[](std::size_t i) const
{
    const auto* const wide = std::get_if<std::vector<double>>(&numbers_);
    return wide ? (*wide)[i] : static_cast<double>(std::get<std::vector<float>>(numbers_)[i]);
}

real_buffer::real_buffer(queue& q, scalar_type type, std::size_t n)
{
    require_real(type);
    if (type == scalar_type::f64)
        data_ = buffer<double>(q, n);
    else
        data_ = buffer<float>(q, n);
}

real_buffer::real_buffer(queue& q, scalar_type type, std::span<const double> values)
{
    require_real(type);
    if (type == scalar_type::f64)
        data_ = buffer<double>(q, values);
    else
        data_ = buffer<float>(q, std::vector<float>(values.begin(), values.end()));
}

void real_buffer::upload(std::span<const double> values, std::size_t offset)
{
    if (auto* const wide = std::get_if<buffer<double>>(&data_))
        wide->upload(values, offset);
    else
        std::get<buffer<float>>(data_).upload(std::vector<float>(values.begin(), values.end()), offset);
}

void real_buffer::download(std::span<double> values, std::size_t offset) const
{
    if (const auto* const wide = std::get_if<buffer<double>>(&data_)) return wide->download(values, offset);
    std::vector<float> narrow(values.size());
    std::get<buffer<float>>(data_).download(std::span(narrow), offset);
    std::copy(narrow.begin(), narrow.end(), values.begin());
}

std::vector<double> real_buffer::download() const
{
    std::vector<double> values(size());
    download(std::span(values));
    return values;
}

void real_buffer::begin_download(host_reals& numbers) const
{
    std::visit(
        [&](const auto& b)
        {
            b.begin_download(std::span(
                std::get<std::vector<typename std::remove_cvref_t<decltype(b)>::value_type>>(numbers.numbers_)));
        },
        data_);
}

void real_buffer::fill(double value)
{
    if (auto* const wide = std::get_if<buffer<double>>(&data_))
        wide->fill(value);
    else
        std::get<buffer<float>>(data_).fill(static_cast<float>(value));
}

void real_buffer::copy_from(const real_buffer& other, std::size_t offset)
{
    if (other.type() != type()) throw parameter_error("copy to a buffer", "float and double do not mix");
    if (auto* const wide = std::get_if<buffer<double>>(&data_))
        wide->copy_from(std::get<buffer<double>>(other.data_), offset);
    else
        std::get<buffer<float>>(data_).copy_from(std::get<buffer<float>>(other.data_), offset);
}

const std::shared_ptr<impl::queue_state>& real_buffer::state() const noexcept
{
    return std::visit(
        [](const auto& b) -> const auto& { return b.state(); }, data_);
}

} // namespace taut::impl
