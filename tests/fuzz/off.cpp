// SPDX-License-Identifier: MIT
#include <taut/impl/files/surface/off.hpp>

#include "budget.hpp"
#include "mutator.hpp"
#include "surface_promises.hpp"

namespace
{

using namespace taut;
using fuzz::dice;

std::string generate(dice& random)
{
    const std::string kind(random.pick({"", "", "ST", "C", "N", "CN", "STCN", "STN"}));
    const std::string end(random.pick({"\n", "\n", "\r\n", " # c\n", "\n\n# c\r\n"}));
    const std::size_t vertices = random.between(3, 9), faces = random.between(1, 8);
    std::string text =
        random.one_in(10) && kind.empty() ? "" : kind + "OFF" + std::string(random.pick({" ", "\n", "\n# by hand\n"}));
    text += (random.one_in(20) ? random.number() : std::to_string(vertices)) + ' ' +
            (random.one_in(20) ? random.number() : std::to_string(faces)) + std::string(random.pick({"", " 0"})) + end;
    std::size_t numbers = 3 + (kind.starts_with("ST") ? 2 : 0) + (kind.ends_with('N') ? 3 : 0);
    if (kind.find('C') != kind.npos) numbers += random.between(3, 4);
    for (std::size_t v = 0; v < vertices; ++v)
    {
        for (std::size_t k = random.one_in(60) ? 1 : 0; k < numbers; ++k)
            text += random.number() + std::string(random.pick({" ", " ", "\t", " \\\n"}));
        text += end;
    }
    for (std::size_t f = 0; f < faces; ++f)
    {
        const std::size_t size = random.one_in(40) ? random.below(8) : random.between(3, 5),
                          first = random.below(vertices);
        text += std::to_string(size);
        for (std::size_t k = 0; k < size; ++k)
            text += ' ' + (random.one_in(30) ? random.count(vertices) : std::to_string((first + k) % vertices));
        text += std::string(random.pick({"", "", " 255 0 0", " 0.5 0.5 0.5 1"})) + end;
    }
    return text;
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
        fuzz::require_promises(io::impl::parse_off(std::string_view(reinterpret_cast<const char*>(data), size)));
    }
    catch (const error&)
    {
    }
    try
    {
        fuzz::require_repairable(io::impl::parse_off_soup(std::string_view(reinterpret_cast<const char*>(data), size)));
    }
    catch (const error&)
    {
    }
    return 0;
}
