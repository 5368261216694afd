// SPDX-License-Identifier: MIT
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <taut/impl/files/surface/stl.hpp>

#include "budget.hpp"
#include "mutator.hpp"
#include "surface_promises.hpp"

namespace
{

using namespace taut;
using fuzz::dice;

/// Corners on a small grid, so that many are one.
std::string generate_text(dice& random)
{
    const std::string end(random.pick({"\n", "\n", "\r\n", "\r"}));
    std::string text = std::string(random.pick({"solid", "solid a b", " SOLID", "solid facet"})) + end;
    for (std::size_t n = random.between(1, 9); n > 0; --n)
    {
        text += std::string(random.pick({"facet normal 0 0 1", "  facet normal nan 0 0", "facet"})) + end +
                "outer loop" + end;
        for (std::size_t k = random.one_in(30) ? random.between(0, 5) : 3; k > 0; --k)
            text += "vertex " + random.number() + ' ' + random.number() + ' ' + random.number() + end;
        text += random.one_in(60) ? "" : "endloop" + end;
        text += "endfacet" + end;
        if (random.one_in(9)) text += "endsolid" + end + "solid b" + end;
    }
    return text + "endsolid" + std::string(random.pick({"", " a", "\n"}));
}

std::string generate_binary(dice& random)
{
    std::string bytes(random.pick({"solid", "part", ""}));
    bytes.resize(80, ' ');
    const auto add = [&](auto x)
    {
        char to[sizeof x];
        io::impl::store(to, x, std::endian::little);
        bytes.append(to, sizeof x);
    };
    const std::size_t n = random.between(1, 12);
    add(static_cast<std::uint32_t>(random.one_in(20) ? random.between(0, 99) : n));
    for (std::size_t k = 0; k < n; ++k)
    {
        for (int i = 0; i < 12; ++i) add(0.25f * static_cast<float>(random.below(4)));
        add(static_cast<std::uint16_t>(random.below(9)));
    }
    return bytes + std::string(random.one_in(9) ? random.below(60) : 0, 'x');
}

std::string generate(dice& random)
{
    return random.one_in(2) ? generate_text(random) : generate_binary(random);
}

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed)
{
    return taut::fuzz::mutate(data, size, most, seed, generate);
}

/// Whatever the bytes, they are a surface that keeps the promises, or an error of the library.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const taut::fuzz::budget limit(size);
    try
    {
        fuzz::require_promises(io::impl::parse_stl(std::string_view(reinterpret_cast<const char*>(data), size)));
    }
    catch (const error&)
    {
    }
    return 0;
}
