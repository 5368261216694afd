// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <charconv>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <taut/files.hpp>
#include <taut/impl/files/file/read_file.hpp>
#include <taut/impl/files/surface/pins.hpp>
#include <taut/surface_file.hpp>
#include <taut/types.hpp>

namespace taut::io
{

template <int D>
std::vector<pin<D>> read_pins(const std::filesystem::path& path, idx vertices, std::optional<double> plane)
{
    return impl::parse_pins<D>(impl::read_file(path), path.string(), vertices, plane);
}

template std::vector<pin<2>> read_pins(const std::filesystem::path& path, idx vertices, std::optional<double> plane);

template std::vector<pin<3>> read_pins(const std::filesystem::path& path, idx vertices, std::optional<double> plane);

template <int D>
void write_pins(const std::filesystem::path& path, std::span<const pin<D>> pins)
{
    std::string text = D == 2 ? "vertex,u,v,weight\n" : "vertex,x,y,z,weight\n";
    const auto append = [&text](double x)
    {
        std::array<char, 32> digits{};
        text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr);
    };
    for (const pin<D>& p : pins)
    {
        text += std::to_string(p.vertex);
        for (int k = 0; k < D; ++k)
        {
            text += ',';
            if ((p.held >> k & 1u) != 0) append(p.target[k]);
        }
        text += ',';
        append(p.weight);
        text += '\n';
    }
    write_file(path, text);
}

template void write_pins(const std::filesystem::path& path, std::span<const pin<2>> pins);

template void write_pins(const std::filesystem::path& path, std::span<const pin<3>> pins);

} // namespace taut::io
