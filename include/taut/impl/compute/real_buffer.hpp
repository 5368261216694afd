// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
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
    host_reals(scalar_type type, std::size_t n);

    std::size_t size() const noexcept
    {
        return std::visit([](const auto& v) { return v.size(); }, numbers_);
    }
    double operator[](std::size_t i) const;

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
    real_buffer(queue& q, scalar_type type, std::size_t n);
    real_buffer(queue& q, scalar_type type, std::span<const double> values);

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
    void upload(std::span<const double> values, std::size_t offset = 0);

    /// Waits for the commands before it, then copies elements offset, offset + 1, ... into values.
    void download(std::span<double> values, std::size_t offset = 0) const;
    std::vector<double> download() const;

    /// Elements 0, 1, ... without the wait: as buffer::begin_download. The numbers are of the type of the buffer.
    void begin_download(host_reals& numbers) const;

    /// Sets every element; does not wait.
    void fill(double value);

    /// Copies all elements of other, which has the same type, to elements offset, offset + 1, ...; does not wait.
    void copy_from(const real_buffer& other, std::size_t offset = 0);

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
    const std::shared_ptr<impl::queue_state>& state() const noexcept;

private:
    static void require_real(scalar_type type)
    {
        if (type != scalar_type::f32 && type != scalar_type::f64) throw parameter_error("type", "must be f32 or f64");
    }

    std::variant<buffer<float>, buffer<double>> data_;
};

} // namespace taut::impl

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/compute/real_buffer.ipp>
#endif
