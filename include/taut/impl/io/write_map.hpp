// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <filesystem>
#include <iterator>
#include <span>
#include <string>

#include <taut/impl/core/types.hpp>
#include <taut/impl/io/atomic_file.hpp>

namespace taut::io
{

/// Writes a map as text: one line per vertex, its coordinates with 17 significant digits, which read back bit for bit.
/// Throws io_error.
template <int D>
void write_map(atomic_file& file, std::span<const vec<D>> x)
{
    std::string text;
    for (const vec<D>& p : x)
    {
        for (int k = 0; k < D; ++k)
        {
            char digits[32];
            const auto end = std::to_chars(digits, std::end(digits), p[k], std::chars_format::general, 17).ptr;
            if (k > 0) text += ' ';
            text.append(digits, end);
        }
        text += '\n';
        if (text.size() < 1 << 16) continue;
        file.write(text);
        text.clear();
    }
    file.write(text);
}

/// The same to a file that appears complete or not at all.
template <int D>
void write_map(const std::filesystem::path& path, std::span<const vec<D>> x)
{
    atomic_file file(path);
    write_map<D>(file, x);
    file.commit();
}

} // namespace taut::io
