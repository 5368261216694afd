// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>
#include <string_view>

#include <taut/constraints.hpp>
#include <taut/impl/files/surface/pins.hpp>
#include <taut/volume_file.hpp>

#include "budget.hpp"
#include "mutator.hpp"
#include "require.hpp"

namespace
{

using namespace taut;
using fuzz::dice;

constexpr idx vertices = 4;

std::string generate(dice& random)
{
    const std::size_t d = random.between(2, 3);
    const std::string end(random.pick({"\n", "\n", "\r\n", "\r"}));
    std::string text(random.pick({"", "", "\xef\xbb\xbf", "# c"}));
    if (text.starts_with('#')) text += end;
    if (random.one_in(2))
        text += (d == 2 ? "vertex,u,v" : "vertex,x,y,z") + std::string(random.pick({"", ",weight"})) + end;
    for (std::size_t n = random.between(1, 6); n > 0; --n)
    {
        const std::string blank(random.pick({"", "", " ", "\t"}));
        text += blank + random.count(vertices);
        for (std::size_t k = 0; k < d; ++k) text += ',' + blank + (random.one_in(6) ? "" : random.number());
        if (random.one_in(2)) text += ',' + std::string(random.pick({"", "inf", "1", "0", "2.5", "-1", "nan"}));
        text += std::string(random.pick({"", "", " # c", ","})).substr(0, random.one_in(3) ? 4 : 0) + end;
    }
    return text;
}

/// Whatever the bytes, they are pins of vertices that there are, with finite coordinates, or an error of the library.
template <class Element>
void examine(std::string_view bytes, const mesh<Element>& m)
{
    try
    {
        const auto pins = io::impl::parse_pins<Element::dimension>(bytes, "pins", vertices);
        for (const auto& p : pins)
        {
            fuzz::require(p.vertex >= 0 && p.vertex < vertices, "vertices in range");
            for (int k = 0; k < Element::dimension; ++k)
                fuzz::require(std::isfinite(p.target[k]), "finite coordinates");
            fuzz::require(p.weight >= 0 && p.held != 0, "a pin holds something");
        }
        constraints<Element> c(m);
        c.add(pins); // a file that is read has no contradictions but springs on pinned vertices
    }
    catch (const error&)
    {
    }
}

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed)
{
    return taut::fuzz::mutate(data, size, most, seed, generate);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const taut::fuzz::budget limit(size);
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    examine(bytes, mesh<triangle>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}));
    examine(bytes, mesh<tetrahedron>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}));
    return 0;
}
