// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string_view>

#include <taut/impl/core/compute/device_memory.hpp>

namespace taut::impl
{

/// Argument of a kernel in one launch: memory or a number, with the OpenCL C name of its type.
class kernel_value
{
public:
    explicit kernel_value(const device_memory& m)
        : memory_(m.handle()), is_memory_(true), elements_(m.size()), type_(m.type()), owner_(m.owner())
    {
    }
    kernel_value(std::string_view type, const void* number, std::size_t bytes) : type_(type), size_(bytes)
    {
        std::memcpy(bytes_.data(), number, bytes);
    }

    bool is_memory() const noexcept { return is_memory_; }
    memory_handle memory() const noexcept { return memory_; }
    std::size_t elements() const noexcept { return elements_; }
    std::string_view type() const noexcept { return type_; }

    /// Makes a double a float where that is the type; nothing else.
    void narrow_to(std::string_view type)
    {
        if (is_memory_ || type_ != "double" || type != "float") return;
        double number = 0;
        std::memcpy(&number, bytes_.data(), sizeof number);
        const auto narrow = static_cast<float>(number);
        *this = kernel_value("float", &narrow, sizeof narrow);
    }

    /// The queue of the memory; null of numbers.
    const queue_state* owner() const noexcept { return owner_; }

    /// What a kernel takes: the number, or the handle of the memory.
    const void* value() const noexcept { return is_memory_ ? static_cast<const void*>(&memory_) : bytes_.data(); }
    std::size_t value_bytes() const noexcept { return is_memory_ ? sizeof memory_ : size_; }

private:
    memory_handle memory_ = nullptr;
    bool is_memory_ = false; // an empty buffer has no memory, but is no number
    std::size_t elements_ = std::numeric_limits<std::size_t>::max();
    std::string_view type_;
    const queue_state* owner_ = nullptr;
    std::size_t size_ = 0;
    std::array<std::byte, 8> bytes_{};
};

} // namespace taut::impl
