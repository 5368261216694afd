// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <taut/impl/compute/buffer.hpp>
#include <taut/impl/symbolic/scalar_type.hpp>

namespace taut::impl
{

/// Real numbers on the host in the type that a real_buffer has on the device; an element reads as double.
class host_reals
{
public:
    host_reals() = default;
    host_reals(scalar_type type, std::size_t n)
    {
        if (type == scalar_type::f64)
            numbers_ = std::vector<double>(n);
        else
            numbers_ = std::vector<float>(n);
    }

    std::size_t size() const noexcept
    {
        return std::visit([](const auto& v) { return v.size(); }, numbers_);
    }
    double operator[](std::size_t i) const
    {
        const auto* const wide = std::get_if<std::vector<double>>(&numbers_);
        return wide ? (*wide)[i] : static_cast<double>(std::get<std::vector<float>>(numbers_)[i]);
    }

    /// Calls body with all of them, a span<const float> or span<const double>.
    template <class Body>
    void visit(const Body& body) const
    {
        std::visit([&](const auto& v) { body(std::span(v)); }, numbers_);
    }

private:
    friend class real_buffer;
    std::variant<std::vector<float>, std::vector<double>> numbers_;
};

/// n real numbers in the memory of a device, as float or as double: the precision is a value, not a type. On the host
/// they are double. Otherwise it is as buffer<T>.
class real_buffer
{
public:
    /// An empty buffer of no queue; assign another to it.
    real_buffer() = default;

    /// type: f32 or f64. Throws parameter_error, and device_error as buffer does.
    real_buffer(queue& q, scalar_type type, std::size_t n)
    {
        require_real(type);
        if (type == scalar_type::f64)
            data_ = buffer<double>(q, n);
        else
            data_ = buffer<float>(q, n);
    }
    real_buffer(queue& q, scalar_type type, std::span<const double> values)
    {
        require_real(type);
        if (type == scalar_type::f64)
            data_ = buffer<double>(q, values);
        else
            data_ = buffer<float>(q, std::vector<float>(values.begin(), values.end()));
    }

    scalar_type type() const noexcept { return data_.index() == 1 ? scalar_type::f64 : scalar_type::f32; }
    std::size_t size() const noexcept
    {
        return std::visit([](const auto& b) { return b.size(); }, data_);
    }
    bool empty() const noexcept { return size() == 0; }
    std::uint64_t bytes() const noexcept
    {
        return std::visit([](const auto& b) { return b.bytes(); }, data_);
    }

    /// Copies values to elements offset, offset + 1, ... and waits.
    void upload(std::span<const double> values, std::size_t offset = 0)
    {
        if (auto* const wide = std::get_if<buffer<double>>(&data_))
            wide->upload(values, offset);
        else
            std::get<buffer<float>>(data_).upload(std::vector<float>(values.begin(), values.end()), offset);
    }

    /// Waits for the commands before it, then copies elements offset, offset + 1, ... into values.
    void download(std::span<double> values, std::size_t offset = 0) const
    {
        if (const auto* const wide = std::get_if<buffer<double>>(&data_)) return wide->download(values, offset);
        std::vector<float> narrow(values.size());
        std::get<buffer<float>>(data_).download(std::span(narrow), offset);
        std::copy(narrow.begin(), narrow.end(), values.begin());
    }
    std::vector<double> download() const
    {
        std::vector<double> values(size());
        download(std::span(values));
        return values;
    }

    /// Elements 0, 1, ... without the wait: as buffer::begin_download. The numbers are of the type of the buffer.
    void begin_download(host_reals& numbers) const
    {
        std::visit(
            [&](const auto& b)
            {
                b.begin_download(std::span(
                    std::get<std::vector<typename std::remove_cvref_t<decltype(b)>::value_type>>(numbers.numbers_)));
            },
            data_);
    }

    /// Sets every element; does not wait.
    void fill(double value)
    {
        if (auto* const wide = std::get_if<buffer<double>>(&data_))
            wide->fill(value);
        else
            std::get<buffer<float>>(data_).fill(static_cast<float>(value));
    }

    /// Copies all elements of other, which has the same type, to elements offset, offset + 1, ...; does not wait.
    void copy_from(const real_buffer& other, std::size_t offset = 0)
    {
        if (other.type() != type()) throw parameter_error("copy to a buffer", "float and double do not mix");
        if (auto* const wide = std::get_if<buffer<double>>(&data_))
            wide->copy_from(std::get<buffer<double>>(other.data_), offset);
        else
            std::get<buffer<float>>(data_).copy_from(std::get<buffer<float>>(other.data_), offset);
    }

    /// Accessors for a command group, in which the elements are sym<double> in the precision of the buffer.
    template <class Handler>
    auto read(Handler& h) const
    {
        return h.reads(*this);
    }
    template <class Handler>
    auto write(Handler& h)
    {
        return h.writes(*this);
    }
    template <class Handler>
    auto read_write(Handler& h)
    {
        return h.updates(*this);
    }

    cl_mem native() const noexcept
    {
        return std::visit([](const auto& b) { return b.native(); }, data_);
    }
    const std::shared_ptr<impl::queue_state>& state() const noexcept
    {
        return std::visit(
            [](const auto& b) -> const auto& { return b.state(); }, data_);
    }

private:
    static void require_real(scalar_type type)
    {
        if (type != scalar_type::f32 && type != scalar_type::f64) throw parameter_error("type", "must be f32 or f64");
    }

    std::variant<buffer<float>, buffer<double>> data_;
};

} // namespace taut::impl
