// SPDX-License-Identifier: MIT
#include <span>
#include <string>
#include <string_view>

#include <taut/certify.hpp>
#include <taut/impl/files/surface/prob_bodies.hpp>
#include <taut/untangle.hpp>
#include <taut/volume_file.hpp>

#include "budget.hpp"
#include "mutator.hpp"
#include "require.hpp"

namespace
{

using namespace taut;
using fuzz::dice;

std::string generate(dice& random)
{
    const std::size_t d = random.between(2, 3), rest = random.between(d, 3), n = random.between(d + 1, 9);
    const std::string end(random.pick({"\n", "\n", "\r\n", "\n\n"}));
    const auto block = [&](std::size_t rows, std::size_t columns)
    { return std::to_string(random.one_in(60) ? rows + 1 : rows) + ' ' + std::to_string(columns) + end; };
    std::string text;
    for (const std::size_t columns : {rest, d})
    {
        text += block(n, columns);
        for (std::size_t v = 0; v < n; ++v)
            for (std::size_t k = 0; k < columns; ++k) text += random.number() + (k + 1 < columns ? " " : end);
    }
    const std::size_t cells = random.between(1, 9);
    text += block(cells, d + 1);
    for (std::size_t c = 0; c < cells; ++c)
    {
        const std::size_t first = random.below(n), step = random.between(1, 2);
        for (std::size_t k = 0; k <= d; ++k)
            text +=
                (random.one_in(60) ? random.count(n) : std::to_string((first + k * step) % n)) + (k < d ? " " : end);
    }
    const std::size_t fixed = random.below(n + 1);
    text += std::to_string(fixed) + end;
    for (std::size_t k = 0; k < fixed; ++k) text += random.count(n) + end;
    return text;
}

/// Whatever a file states, indices are in range, the scan for proofs copes with it, and pins of a map without inverted
/// elements are feasible.
template <class Element>
void examine(std::string_view bytes)
{
    try
    {
        constexpr int D = Element::dimension;
        auto file = io::impl::parse_prob<Element>(bytes);
        const auto n = static_cast<idx>(file.rest.size());
        fuzz::require(file.initial.size() == file.rest.size(), "one position a vertex");
        for (const auto& cell : file.cells)
            for (const idx v : cell) fuzz::require(v >= 0 && v < n, "vertices in range");
        for (const idx v : file.fixed) fuzz::require(v >= 0 && v < n, "fixed vertices in range");
        const auto problem = make_untangle_problem(std::move(file));
        const auto found = find_infeasibility(problem);
        const auto flips = certify<D>(problem.rest.cells(), std::span<const vec<D>>(problem.initial));
        fuzz::require(!found || flips.flipped > 0, "no proof against a map without inverted elements");
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
    examine<triangle>(bytes);
    examine<tetrahedron>(bytes);
    return 0;
}
