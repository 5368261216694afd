// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <taut/impl/files/file/byte_order.hpp>
#include <taut/impl/files/surface/ply/header.hpp>

namespace taut::io::impl
{

/// Values of an ASCII body.
class ply_ascii
{
public:
    explicit ply_ascii(scanner& in) : in_(in) {}

    double next(ply_type)
    {
        in_.skip_space();
        begin_ = in_.position();
        return in_.number();
    }
    std::string_view text() const { return in_.since(begin_); }   ///< the last value as it is written
    std::size_t smallest(ply_type) const { return 2; }            ///< bytes of the shortest value: "0\n"
    std::size_t remaining() const { return in_.remaining() + 1; } // the last line end may be missing
    file_place place() const { return in_.line_of(in_.position()); }

private:
    scanner& in_;
    const char* begin_ = nullptr;
};

/// Values of a binary body.
template <std::endian Order>
class ply_binary
{
public:
    explicit ply_binary(scanner& in)
        : path_(in.path()), at_(in.position()), end_(at_ + in.remaining()), begin_(in.start())
    {
    }

    double next(ply_type type)
    {
        switch (type)
        {
        case ply_type::int8:
            return take<std::int8_t>();
        case ply_type::uint8:
            return take<std::uint8_t>();
        case ply_type::int16:
            return take<std::int16_t>();
        case ply_type::uint16:
            return take<std::uint16_t>();
        case ply_type::int32:
            return take<std::int32_t>();
        case ply_type::uint32:
            return take<std::uint32_t>();
        case ply_type::float32:
            return static_cast<double>(take<float>());
        case ply_type::float64:
            return take<double>();
        }
        return 0;
    }
    std::string_view text() const { return {}; }
    std::size_t smallest(ply_type type) const { return size_of(type); }
    std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
    file_place place() const { return {file_place::byte, static_cast<std::size_t>(at_ - begin_)}; }

private:
    template <class T>
    T take()
    {
        if (remaining() < sizeof(T))
            throw io_error(path_, "the file ends too early; correct the counts of its header, or get it whole",
                           place());
        const T x = load<T>(at_, Order);
        at_ += sizeof(T);
        return x;
    }

    const std::string& path_;
    const char *at_, *end_, *begin_;
};

} // namespace taut::io::impl
