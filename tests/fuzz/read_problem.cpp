// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include <taut/map/certify.hpp>
#include <taut/map/untangle/infeasible.hpp>
#include <taut/map/untangle/make_untangle_problem.hpp>

namespace
{

/// Whatever a file states, the scan for proofs copes with it, and pins of a map without inverted elements are feasible.
template <class Element>
void examine(std::string_view bytes)
{
    try
    {
        constexpr int D = Element::dimension;
        const auto problem = taut::make_untangle_problem(taut::io::parse_prob<Element>(bytes));
        const auto found = taut::find_infeasibility(problem);
        const auto flips = taut::certify<D>(problem.rest.cells(), std::span<const taut::vec<D>>(problem.initial));
        if (found && flips.flipped == 0) std::abort();
    }
    catch (const taut::error&)
    {
    }
}

template <class Element>
void pin(std::string_view bytes)
{
    try
    {
        const auto pins = taut::io::parse_pins<Element::dimension>(bytes, "pins", 4);
        const taut::mesh<taut::tetrahedron> volume({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
        const taut::mesh<taut::triangle> surface({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}});
        const auto& m = [&]() -> const auto&
        {
            if constexpr (Element::dimension == 2)
                return surface;
            else
                return volume;
        }
        ();
        taut::constraints<Element> c(m);
        taut::add_pins(c, pins); // a file that is read has no contradictions but springs on pinned vertices
    }
    catch (const taut::error&)
    {
    }
}

} // namespace

/// libFuzzer: the bytes are read as each kind of problem and of pins.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    examine<taut::triangle>(bytes);
    examine<taut::tetrahedron>(bytes);
    pin<taut::triangle>(bytes);
    pin<taut::tetrahedron>(bytes);
    return 0;
}
