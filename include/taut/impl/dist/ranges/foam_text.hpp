// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/files/file/byte_order.hpp>
#include <taut/impl/files/file/read_file.hpp>

namespace taut::dist::impl
{

/// A file of OpenFOAM: a header that says how lists are written, then these, as text or as bytes.
class foam_text
{
public:
    /// Throws io_error, also where the file is compressed.
    explicit foam_text(const std::filesystem::path& path) : path_(path.string())
    {
        std::error_code unknown;
        const std::filesystem::path packed = path_ + ".gz";
        if (!std::filesystem::exists(path, unknown) && std::filesystem::exists(packed, unknown))
            throw io::io_error(packed.string(), "is compressed; unpack it by gunzip");
        bytes_ = io::impl::read_file(path);
        repeated_ = bytes_.size() * 64 + (std::size_t{1} << 16U);
        read_head();
        if (class_ == "decomposedBlockData")
            fail("holds all pieces in one (collated), which is not read; decompose the mesh with -fileHandler "
                 "uncollated");
    }

    const std::string& path() const { return path_; }
    const std::string& bytes() const { return bytes_; }
    const std::string& type() const { return class_; } ///< `class` of the header
    bool binary() const { return binary_; }
    bool single() const { return scalar_ == 4; } ///< of numbers that are bytes
    std::endian order() const { return order_; }
    std::size_t position() const { return at_; }

    [[noreturn]] void fail(const std::string& what) const
    {
        std::size_t line = 1;
        for (std::size_t k = 0; k < at_ && k < bytes_.size(); ++k) line += bytes_[k] == '\n';
        if (binary_) throw io::io_error(path_, what, io::file_place{io::file_place::byte, at_});
        throw io::io_error(path_, what, io::file_place{io::file_place::line, line});
    }

    /// Goes past blanks, line ends and comments.
    void skip()
    {
        for (;;)
        {
            at_ = std::min(bytes_.find_first_not_of(" \t\r\n\v\f", at_), bytes_.size());
            const std::string_view rest = std::string_view(bytes_).substr(at_, 2);
            if (rest == "//")
                at_ = std::min(bytes_.find('\n', at_), bytes_.size());
            else if (rest == "/*")
                at_ = std::min(bytes_.find("*/", at_ + 2), bytes_.size() - 2) + 2;
            else
                return;
        }
    }

    bool done()
    {
        skip();
        return at_ >= bytes_.size();
    }
    bool at(char c)
    {
        skip();
        return at_ < bytes_.size() && bytes_[at_] == c;
    }
    bool take(char c)
    {
        if (!at(c)) return false;
        ++at_;
        return true;
    }
    void expect(char c)
    {
        if (!take(c)) fail(std::string("expected '") + c + "'; the file is cut off or damaged, get or save it again");
    }

    /// A word: a mark of its own, what is in quotes, or what stands between marks and blanks.
    std::string word()
    {
        skip();
        if (at_ >= bytes_.size()) fail("the file ends too early; it is cut off, get it whole");
        const std::size_t begin = at_;
        const auto mark = [](char c) { return c == '(' || c == ')' || c == '{' || c == '}' || c == ';'; };
        if (bytes_[at_] == '"')
        {
            const auto end = bytes_.find('"', at_ + 1);
            if (end == bytes_.npos) fail("a word in quotes has no end");
            at_ = end + 1;
            return bytes_.substr(begin + 1, end - begin - 1);
        }
        if (mark(bytes_[at_])) return std::string(1, bytes_[at_++]);
        at_ = std::min(bytes_.find_first_of(" \t\r\n(){};\"", at_), bytes_.size());
        return bytes_.substr(begin, at_ - begin);
    }

    template <class Number>
    Number number(const char* what)
    {
        skip();
        Number x{};
        const auto [end, failure] = std::from_chars(bytes_.data() + at_, bytes_.data() + bytes_.size(), x);
        if (failure != std::errc{}) fail(std::string("expected ") + what + "; correct the file, or save it again");
        at_ = static_cast<std::size_t>(end - bytes_.data());
        return x;
    }

    /// The number of items of a list, each of so many bytes or characters at least.
    std::size_t count(std::size_t each)
    {
        const auto n = number<std::int64_t>("the length of a list");
        if (n < 0 || static_cast<std::size_t>(n) > (bytes_.size() - at_) / each + 1)
            fail(std::to_string(n) + " items, more than the rest of the file can hold; get it whole");
        return static_cast<std::size_t>(n);
    }

    /// The first byte of the n items of a list in binary, behind its parenthesis.
    std::size_t raw(std::size_t n, std::size_t each)
    {
        if (n == 0)
        {
            if (take('(')) expect(')');
            return at_;
        }
        expect('(');
        if (n * each >= bytes_.size() - at_) fail("the file ends too early; it is cut off, get it whole");
        const std::size_t begin = at_;
        at_ += n * each;
        expect(')');
        return begin;
    }

    /// A list of integers. Those of one value, as 5{0}, may have so many items in a file as its bytes warrant.
    std::vector<std::int64_t> labels()
    {
        std::vector<std::int64_t> all;
        const std::size_t begin = at_;
        if (!binary_)
        {
            const auto n = number<std::int64_t>("the length of a list");
            if (take('{'))
            {
                if (n < 0 || static_cast<std::size_t>(n) > repeated_) fail("a list of one value is too long");
                repeated_ -= static_cast<std::size_t>(n);
                all.assign(static_cast<std::size_t>(n), number<std::int64_t>("an integer"));
                expect('}');
                return all;
            }
            at_ = begin;
        }
        const std::size_t n = count(binary_ ? label_ : 1);
        if (binary_)
        {
            const char* from = bytes_.data() + raw(n, label_);
            for (std::size_t k = 0; k < n; ++k, from += label_)
                all.push_back(label_ == 8 ? io::impl::load<std::int64_t>(from, order_)
                                          : io::impl::load<std::int32_t>(from, order_));
            return all;
        }
        expect('(');
        for (std::size_t k = 0; k < n; ++k) all.push_back(number<std::int64_t>("an integer"));
        expect(')');
        return all;
    }

    /// An entry `List<label> ...;` of a dictionary.
    std::vector<std::int64_t> list_of_labels()
    {
        if (at('L')) word();
        std::vector<std::int64_t> all = labels();
        expect(';');
        return all;
    }

    /// Goes past an entry `List<bool> ...;`, whose items are a byte each in binary.
    void skip_flags()
    {
        if (at('L')) word();
        if (binary_)
            raw(count(1), 1);
        else
            while (!at(';')) word();
        expect(';');
    }

    std::size_t scalar_bytes() const { return scalar_; }

private:
    void read_head()
    {
        if (word() != "FoamFile") fail("not a file of OpenFOAM: it does not begin with FoamFile");
        expect('{');
        while (!take('}'))
        {
            const std::string key = word();
            std::string value = key == ";" ? std::string() : word();
            while (key != ";" && !take(';')) value += ' ' + word();
            if (key == "format") binary_ = value == "binary";
            if (key == "class") class_ = value;
            if (key != "arch") continue;
            order_ = value.find("MSB") != value.npos ? std::endian::big : std::endian::little;
            if (value.find("label=64") != value.npos) label_ = 8;
            if (value.find("scalar=32") != value.npos) scalar_ = 4;
        }
    }

    std::string path_, bytes_, class_;
    std::size_t at_ = 0, label_ = 4, scalar_ = 8;
    std::size_t repeated_ = 0; ///< items of lists of one value that may still come
    bool binary_ = false;
    std::endian order_ = std::endian::little;
};

} // namespace taut::dist::impl
