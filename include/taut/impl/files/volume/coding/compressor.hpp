// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include <taut/errors.hpp>

// Each is there where its macro is defined, which CMake does where it finds the library.
#ifdef TAUT_WITH_ZLIB
#include <zlib.h>
#endif
#ifdef TAUT_WITH_LZMA
#include <lzma.h>
#endif
#ifdef TAUT_WITH_LZ4
#include <lz4.h>
#endif

namespace taut::io::impl
{

/// Compressors of VTK for blocks of bytes.
enum class compressor
{
    none,
    zlib,
    lzma,
    lz4
};

struct compressor_words
{
    compressor kind;
    std::string_view name; ///< of VTK
    std::string_view library, macro;
    bool built; ///< whether the library is there
};

#ifdef TAUT_WITH_ZLIB
constexpr bool with_zlib = true;
#else
constexpr bool with_zlib = false;
#endif
#ifdef TAUT_WITH_LZMA
constexpr bool with_lzma = true;
#else
constexpr bool with_lzma = false;
#endif
#ifdef TAUT_WITH_LZ4
constexpr bool with_lz4 = true;
#else
constexpr bool with_lz4 = false;
#endif

constexpr std::array<compressor_words, 3> compressors = {
    {{compressor::zlib, "vtkZLibDataCompressor", "zlib", "TAUT_WITH_ZLIB", with_zlib},
     {compressor::lzma, "vtkLZMADataCompressor", "liblzma", "TAUT_WITH_LZMA", with_lzma},
     {compressor::lz4, "vtkLZ4DataCompressor", "LZ4", "TAUT_WITH_LZ4", with_lz4}}};

/// Unpacks and packs blocks, one after the other, in time and memory that are in proportion to them.
class block_compressor
{
public:
    explicit block_compressor(compressor kind) : kind_(kind) {}
    block_compressor(const block_compressor&) = delete;
    block_compressor& operator=(const block_compressor&) = delete;

    ~block_compressor()
    {
#ifdef TAUT_WITH_ZLIB
        if (inflating_) inflateEnd(&in_);
        if (deflating_) deflateEnd(&out_);
#endif
#ifdef TAUT_WITH_LZMA
        lzma_end(&packing_);
#endif
    }

    /// Returns whether `from` is a stream of as many bytes as `to` has, which are then there.
    bool unpack([[maybe_unused]] std::string_view from, [[maybe_unused]] std::span<char> to)
    {
#ifdef TAUT_WITH_ZLIB
        if (kind_ == compressor::zlib) return inflated(from, to);
#endif
#ifdef TAUT_WITH_LZMA
        if (kind_ == compressor::lzma) return unpacked_lzma(from, to);
#endif
#ifdef TAUT_WITH_LZ4
        if (kind_ == compressor::lz4)
            return fits_int(from.size()) && fits_int(to.size()) &&
                   LZ4_decompress_safe(from.data(), to.data(), static_cast<int>(from.size()),
                                       static_cast<int>(to.size())) == static_cast<int>(to.size());
#endif
        return false;
    }

    /// Throws error where a library does not do it, for want of memory.
    std::string pack([[maybe_unused]] std::string_view from)
    {
        std::string to;
        bool done = false;
#ifdef TAUT_WITH_ZLIB
        if (kind_ == compressor::zlib) done = deflated(from, to);
#endif
#ifdef TAUT_WITH_LZMA
        if (kind_ == compressor::lzma) done = packed_lzma(from, to);
#endif
#ifdef TAUT_WITH_LZ4
        if (kind_ == compressor::lz4 && from.size() <= LZ4_MAX_INPUT_SIZE)
        {
            to.resize(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(from.size()))));
            to.resize(static_cast<std::size_t>(LZ4_compress_default(
                from.data(), to.data(), static_cast<int>(from.size()), static_cast<int>(to.size()))));
            done = !to.empty();
        }
#endif
        if (!done) throw error("a block of " + std::to_string(from.size()) + " bytes could not be compressed");
        return to;
    }

private:
    static bool fits_int(std::size_t n)
    {
        return n <= static_cast<std::size_t>(std::numeric_limits<int>::max());
    }

#ifdef TAUT_WITH_ZLIB
    static bool fits_zlib(std::size_t n)
    {
        return n <= std::numeric_limits<uInt>::max();
    }

    static Bytef* bytes_of(const char* text)
    {
        return reinterpret_cast<Bytef*>(const_cast<char*>(text));
    }

    static void give(z_stream& stream, std::string_view from, std::span<char> to)
    {
        stream.next_in = bytes_of(from.data());
        stream.avail_in = static_cast<uInt>(from.size());
        stream.next_out = bytes_of(to.data());
        stream.avail_out = static_cast<uInt>(to.size());
    }

    bool inflated(std::string_view from, std::span<char> to)
    {
        if (!fits_zlib(from.size()) || !fits_zlib(to.size())) return false;
        const int begun = inflating_ ? inflateReset(&in_) : inflateInit(&in_);
        inflating_ = inflating_ || begun == Z_OK;
        if (begun != Z_OK) return false;
        give(in_, from, to);
        return inflate(&in_, Z_FINISH) == Z_STREAM_END && in_.avail_out == 0;
    }

    bool deflated(std::string_view from, std::string& to)
    {
        if (!fits_zlib(from.size() + from.size() / 64 + 1024)) return false;
        const int begun = deflating_ ? deflateReset(&out_) : deflateInit(&out_, Z_DEFAULT_COMPRESSION);
        deflating_ = deflating_ || begun == Z_OK;
        if (begun != Z_OK) return false;
        to.resize(deflateBound(&out_, static_cast<uLong>(from.size())));
        give(out_, from, to);
        if (deflate(&out_, Z_FINISH) != Z_STREAM_END) return false;
        to.resize(to.size() - out_.avail_out);
        return true;
    }

    z_stream in_{}, out_{};
    bool inflating_ = false, deflating_ = false;
#endif

#ifdef TAUT_WITH_LZMA
    /// Memory limit of decompression: the greatest dictionary that VTK uses, and a little more.
    static constexpr std::uint64_t most_lzma = std::uint64_t{80} << 20;

    static const std::uint8_t* octets(const char* text)
    {
        return reinterpret_cast<const std::uint8_t*>(text);
    }
    static std::uint8_t* octets(char* text)
    {
        return reinterpret_cast<std::uint8_t*>(text);
    }

    static bool unpacked_lzma(std::string_view from, std::span<char> to)
    {
        std::uint64_t limit = most_lzma;
        std::size_t read = 0, written = 0;
        return lzma_stream_buffer_decode(&limit, 0, nullptr, octets(from.data()), &read, from.size(), octets(to.data()),
                                         &written, to.size()) == LZMA_OK &&
               written == to.size();
    }

    bool packed_lzma(std::string_view from, std::string& to)
    {
        lzma_options_lzma options;
        if (lzma_lzma_preset(&options, LZMA_PRESET_DEFAULT) != 0) return false;
        // Tables are made for the dictionary, so that one beyond the block would cost much for nothing.
        const auto wanted = static_cast<std::uint32_t>(std::min<std::size_t>(from.size(), options.dict_size));
        options.dict_size = std::max<std::uint32_t>(wanted, LZMA_DICT_SIZE_MIN);
        std::array<lzma_filter, 2> filters = {{{LZMA_FILTER_LZMA2, &options}, {LZMA_VLI_UNKNOWN, nullptr}}};
        // As a stream, which keeps its memory from block to block: a coder takes more than a megabyte.
        if (lzma_stream_encoder(&packing_, filters.data(), LZMA_CHECK_CRC32) != LZMA_OK) return false;
        to.resize(lzma_stream_buffer_bound(from.size()));
        packing_.next_in = octets(from.data());
        packing_.avail_in = from.size();
        packing_.next_out = octets(to.data());
        packing_.avail_out = to.size();
        const bool done = lzma_code(&packing_, LZMA_FINISH) == LZMA_STREAM_END;
        to.resize(to.size() - packing_.avail_out);
        return done;
    }

    lzma_stream packing_ = LZMA_STREAM_INIT;
#endif

    [[maybe_unused]] compressor kind_;
};

} // namespace taut::io::impl
