// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/files/file/byte_order.hpp>
#include <taut/impl/files/volume/coding/base64.hpp>
#include <taut/impl/files/volume/coding/compressor.hpp>

namespace taut::io::impl
{

/// Encoding of the bytes of an array in a VTU file: raw or in base64, after a header. That says how many bytes follow;
/// of a compressed array, whose bytes are cut into blocks, how many blocks there are, how many bytes each stands for,
/// how many the last one does (0: as many), and how many bytes each takes.
struct array_code
{
    bool base64 = false;
    compressor packed = compressor::none;
    std::endian order = std::endian::little; ///< of the header
    std::size_t word = 4;                    ///< bytes of a number of the header
    bool apart = false;                      ///< an uncompressed array: its header is base64 by itself
    std::uint64_t blocks = 0, block = 0, last = 0;

    bool plain() const { return !base64 && packed == compressor::none; }

    std::size_t bytes_of_block(std::uint64_t k) const
    {
        return static_cast<std::size_t>(k + 1 < blocks || last == 0 ? block : last);
    }
};

/// Error of a malformed encoding.
struct bad_code
{
    std::string what;
};

/// An array in its code. All members throw bad_code.
class coded_array
{
public:
    /// text: from the header on, as far as the array could go; stays alive. most: bytes that an array may stand for.
    coded_array(std::string_view text, array_code code, std::size_t most) : text_(text), code_(code)
    {
        if (code_.packed == compressor::none)
            read_size();
        else
            read_blocks(most);
    }

    const array_code& code() const { return code_; }
    std::size_t size() const { return size_; }     ///< of the bytes that it stands for
    std::size_t length() const { return length_; } ///< of the code

    std::string bytes() const
    {
        const std::string_view rest = text_.substr(begin_, length_ - begin_);
        std::string data;
        if (code_.base64)
            data = decoded(rest);
        else if (code_.packed == compressor::none)
            data = rest;
        if (code_.packed == compressor::none)
        {
            const std::size_t before = code_.base64 && !code_.apart ? code_.word : 0;
            if (data.size() != before + size_) fail_at_length(data.size());
            return data.substr(before);
        }
        const std::string_view packed = code_.base64 ? std::string_view(data) : rest;
        if (packed.size() != packed_) fail_at_length(packed.size());
        return unpacked(packed);
    }

private:
    [[noreturn]] static void fail(std::string what) { throw bad_code{std::move(what)}; }

    [[noreturn]] void fail_at_length(std::size_t found) const
    {
        fail("its header says " + std::to_string(code_.packed == compressor::none ? size_ : packed_) + " bytes" +
             (code_.packed == compressor::none ? "" : " of compressed blocks") + ", and " + std::to_string(found) +
             " are there; the array is damaged");
    }

    static std::string decoded(std::string_view text)
    {
        const auto bytes = from_base64(text);
        if (!bytes) fail("text that is no base64; the array is damaged");
        return *bytes;
    }

    /// The first bytes of the code.
    std::string head(std::size_t n) const
    {
        const std::size_t length = code_.base64 ? base64_length(n) : n;
        if (length > text_.size()) fail("it ends within its header; the array is damaged");
        std::string bytes = code_.base64 ? decoded(text_.substr(0, length)) : std::string(text_.substr(0, n));
        if (bytes.size() < n) fail("it ends within its header; the array is damaged");
        return bytes;
    }

    std::uint64_t number(const std::string& header, std::size_t k) const
    {
        const char* const at = header.data() + k * code_.word;
        return code_.word == 8 ? load<std::uint64_t>(at, code_.order) : load<std::uint32_t>(at, code_.order);
    }

    /// Sets the length for n bytes of code from begin_ on; the = at the end of a base64 may be missing.
    void set_length(std::uint64_t n)
    {
        const std::size_t left = text_.size() - begin_;
        const auto bytes_left = code_.base64 ? left / 4 * 3 + left % 4 * 3 / 4 : left;
        const std::size_t before = code_.packed == compressor::none && code_.base64 && !code_.apart ? code_.word : 0;
        if (n > bytes_left || n + before > bytes_left) fail_at_length(bytes_left - std::min(bytes_left, before));
        const auto all = static_cast<std::size_t>(n) + before;
        length_ = begin_ + (code_.base64 ? std::min(base64_length(all), left) : all);
    }

    void read_size()
    {
        const auto size = number(head(code_.word), 0);
        const std::size_t alone = base64_length(code_.word);
        code_.apart = code_.base64 && text_[alone - 1] == '=';
        begin_ = code_.apart ? alone : code_.base64 ? 0 : code_.word;
        size_ = static_cast<std::size_t>(std::min<std::uint64_t>(size, std::numeric_limits<std::size_t>::max()));
        set_length(size);
    }

    void read_blocks(std::size_t most)
    {
        code_.blocks = number(head(code_.word), 0);
        if (code_.blocks > text_.size() / code_.word)
            fail("its header says " + std::to_string(code_.blocks) +
                 " compressed blocks, more than the file can hold; the array is damaged");
        const auto n = static_cast<std::size_t>(code_.blocks);
        const std::size_t length = (3 + n) * code_.word;
        const std::string header = head(length);
        code_.block = number(header, 1);
        code_.last = number(header, 2);
        if (n > 0 && (code_.block == 0 || code_.last > code_.block))
            fail("its header says blocks of " + std::to_string(code_.block) + " bytes, the last one of " +
                 std::to_string(code_.last) + "; the array is damaged");
        if (n > 0 && (code_.block > most / n))
            fail(std::to_string(n) + " blocks of " + std::to_string(code_.block) + " bytes, far more than a file of " +
                 "this size holds; save the mesh uncompressed if that is meant");
        if (n > 0) size_ = (n - 1) * static_cast<std::size_t>(code_.block) + code_.bytes_of_block(n - 1);
        begin_ = code_.base64 ? base64_length(length) : length;
        for (std::size_t k = 0; k < n; ++k)
        {
            const auto bytes = number(header, 3 + k);
            if (bytes > text_.size() - packed_)
                fail("its header says " + std::to_string(bytes) + " bytes for block " + std::to_string(k) + " of " +
                     std::to_string(n) + ", more than the file has; the array is damaged");
            sizes_.push_back(static_cast<std::size_t>(bytes));
            packed_ += sizes_.back();
        }
        set_length(packed_);
    }

    std::string unpacked(std::string_view packed) const
    {
        std::string data(size_, '\0');
        block_compressor with(code_.packed);
        std::size_t from = 0, to = 0;
        for (std::size_t k = 0; k < sizes_.size(); ++k)
        {
            const std::size_t n = code_.bytes_of_block(k);
            if (!with.unpack(packed.substr(from, sizes_[k]), std::span(data).subspan(to, n)))
                fail("block " + std::to_string(k) + " of " + std::to_string(sizes_.size()) + " does not unpack to " +
                     std::to_string(n) + " bytes; the array is damaged");
            from += sizes_[k];
            to += n;
        }
        return data;
    }

    std::string_view text_;
    array_code code_;
    std::size_t size_ = 0, begin_ = 0, length_ = 0, packed_ = 0; // begin_: of the data
    std::vector<std::size_t> sizes_;                             // of the blocks, in the file
};

/// The bytes of an array in a code: as many as that was read from.
inline std::string coded(std::string_view bytes, const array_code& code)
{
    std::string header, data;
    const auto say = [&](std::uint64_t x)
    {
        std::array<char, 8> number;
        if (code.word == 8)
            store(number.data(), x, code.order);
        else if (x > std::numeric_limits<std::uint32_t>::max())
            throw error("an array of " + std::to_string(x) + " bytes does not fit headers of 32 bits");
        else
            store(number.data(), static_cast<std::uint32_t>(x), code.order);
        header.append(number.data(), code.word);
    };
    if (code.packed == compressor::none)
    {
        say(bytes.size());
        if (!code.base64) return header.append(bytes);
        if (code.apart) return to_base64(header) + to_base64(bytes);
        return to_base64(header.append(bytes));
    }
    for (const auto x : {code.blocks, code.block, code.last}) say(x);
    block_compressor with(code.packed);
    for (std::uint64_t k = 0; k < code.blocks; ++k)
    {
        const std::string block = with.pack(bytes.substr(0, code.bytes_of_block(k)));
        bytes.remove_prefix(code.bytes_of_block(k));
        say(block.size());
        data += block;
    }
    return code.base64 ? to_base64(header) + to_base64(data) : header + data;
}

} // namespace taut::io::impl
