// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include <taut/impl/files/file/byte_order.hpp>
#include <taut/impl/files/file/scanner.hpp>
#include <taut/volume_file.hpp>

namespace taut::io::impl
{

/// The bytes that the file has for the coordinate at an offset.
inline std::size_t length_at(const volume_file& file, std::size_t offset)
{
    if (!file.places.text) return file.places.single ? sizeof(float) : sizeof(double);
    const auto end = file.bytes.find_first_not_of("+-.0123456789eEdD", offset);
    return std::min(end, file.bytes.size()) - offset;
}

enum class number_type
{
    int8,
    uint8,
    int16,
    uint16,
    int32,
    uint32,
    int64,
    uint64,
    float32,
    float64
};

constexpr std::size_t size_of(number_type t)
{
    constexpr std::array<std::size_t, 10> sizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return sizes[static_cast<std::size_t>(t)];
}

constexpr bool is_real(number_type t)
{
    return t == number_type::float32 || t == number_type::float64;
}

/// Encoding of the numbers of a file.
struct number_encoding
{
    bool text = true;
    std::endian order = std::endian::native; ///< of binary numbers
    char comment = '\0';                     ///< of text: what starts a comment
};

/// Origin of numbers decoded from an encoded part of a file.
struct number_origin
{
    const scanner* file;
    const char* position; ///< in the file
    std::string name;
};

/// Numbers of a file, one after the other, from where the scanner is. All members throw io_error.
class number_source
{
public:
    /// origin: of numbers that were decoded; errors name it.
    number_source(scanner& in, number_encoding encoding, const number_origin* origin = nullptr)
        : in_(&in), encoding_(encoding), origin_(origin)
    {
    }

    /// Goes to the next number of a text, past line ends and comments.
    void skip()
    {
        if (!encoding_.text) return;
        in_->skip_space();
        while (encoding_.comment != '\0' && in_->at(encoding_.comment))
        {
            in_->next_line();
            in_->skip_space();
        }
    }

    long long integer(number_type type, const char* what)
    {
        if (encoding_.text)
        {
            skip();
            require_more(what);
            const long long x = in_->integer(what);
            if (size_of(type) <= 4 &&
                (x < std::numeric_limits<std::int32_t>::min() || x > std::numeric_limits<std::uint32_t>::max()))
                fail(std::string(what) + " is " + std::to_string(x) + "; it must fit 32 bits");
            return x;
        }
        switch (type)
        {
        case number_type::int8:
            return take<std::int8_t>();
        case number_type::uint8:
            return take<std::uint8_t>();
        case number_type::int16:
            return take<std::int16_t>();
        case number_type::uint16:
            return take<std::uint16_t>();
        case number_type::int32:
            return take<std::int32_t>();
        case number_type::uint32:
            return take<std::uint32_t>();
        case number_type::int64:
            return take<std::int64_t>();
        case number_type::uint64:
            if (const auto x = take<std::uint64_t>(); x <= std::numeric_limits<std::int64_t>::max())
                return static_cast<long long>(x);
            break;
        case number_type::float32:
        case number_type::float64:
            break;
        }
        fail(std::string("expected ") + what + ", an integer");
    }

    double real(number_type type)
    {
        if (encoding_.text)
        {
            skip();
            require_more("a number");
            return in_->number();
        }
        if (type == number_type::float32) return static_cast<double>(take<float>());
        if (type == number_type::float64) return take<double>();
        return static_cast<double>(integer(type, "a number"));
    }

    /// A count of things that take some bytes each: no more than fit into what is left of the file.
    std::size_t count(number_type type, const char* what, std::size_t bytes_each = 1)
    {
        return fitting(integer(type, what), what, bytes_each);
    }

    std::size_t fitting(long long n, const char* what, std::size_t bytes_each = 1) const
    {
        if (n < 0 || n > std::numeric_limits<idx>::max())
            fail(std::string(what) + " is " + std::to_string(n) + "; it must not be negative and fit 32 bits");
        if (static_cast<std::size_t>(n) > (in_->remaining() + 1) / bytes_each)
            fail(std::string(what) + " is " + std::to_string(n) +
                 ", more than the rest of the file can hold; correct it, or get the file whole");
        return static_cast<std::size_t>(n);
    }

    bool text() const { return encoding_.text; }
    scanner& in() const { return *in_; }

    /// Fails where the source is, in lines of a text, else in bytes.
    [[noreturn]] void fail(const std::string& what) const
    {
        if (origin_ != nullptr)
            throw io_error(in_->path(), origin_->name + ": " + what, origin_->file->line_of(origin_->position));
        const char* const at = in_->position();
        throw io_error(in_->path(), what, encoding_.text ? in_->line_of(at) : in_->byte_of(at));
    }

private:
    void require_more(const char* what)
    {
        if (in_->done())
            in_->fail(std::string("the file ends before ") + what + "; correct the counts, or add the rest");
    }

    template <class T>
    T take()
    {
        return load<T>(in_->bytes(sizeof(T)).data(), encoding_.order);
    }

    scanner* in_;
    number_encoding encoding_;
    const number_origin* origin_;
};

} // namespace taut::io::impl
