// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <variant>

#include "../../tools/view/messages.cpp"
#include "budget.hpp"
#include "mutator.hpp"
#include "require.hpp"

namespace
{

using namespace taut;
using fuzz::dice;

void append(std::string& to, std::uint32_t x)
{
    for (int k = 0; k < 4; ++k) to += static_cast<char>(x >> (8 * k));
}

std::string generate(dice& random)
{
    std::string m(1, static_cast<char>(random.between(1, 13)));
    append(m, 7);
    switch (m[0])
    {
    case 1:
    {
        const auto n = random.between(0, 3);
        append(m, static_cast<std::uint32_t>(n));
        for (std::size_t k = 0; k < 29 * n; ++k) m += static_cast<char>(random.one_in(2) ? 0 : random.between(0, 255));
        break;
    }
    case 5:
        m += static_cast<char>(random.between(0, 3));
        [[fallthrough]];
    case 2:
    case 3:
    {
        const auto n = random.between(0, 5);
        append(m, static_cast<std::uint32_t>(random.one_in(8) ? random.between(0, 1000) : n));
        for (std::size_t k = 0; k < n; ++k) append(m, static_cast<std::uint32_t>(random.between(0, 1000)));
        break;
    }
    case 4:
        m += static_cast<char>(random.between(0, 2));
        break;
    case 9:
        append(m, 1);
        break;
    case 10:
    case 12:
        for (int k = 0; k < (m[0] == 10 ? 28 : 24); ++k)
            m += static_cast<char>(random.one_in(2) ? 0 : random.between(0, 255));
        break;
    default:
        break;
    }
    return m;
}

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed)
{
    return taut::fuzz::mutate(data, size, most, seed, generate);
}

/// Whatever the bytes, they are a message whose numbers can be used, or a message_error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const taut::fuzz::budget limit(size);
    try
    {
        const auto m = view::parse({data, size});
        std::visit(
            [&](const auto& w)
            {
                using kind = std::remove_cvref_t<decltype(w)>;
                if constexpr (std::is_same_v<kind, view::ask::places>)
                    for (const auto& p : w.pins)
                        fuzz::require(p.vertex >= 0 && p.held < 8 && std::isfinite(p.x[0] + p.x[1] * 0 + p.x[2] * 0),
                                      "a place is one");
                else if constexpr (std::is_same_v<kind, view::ask::release>)
                    fuzz::require(4 * w.vertices.size() < size, "as many as there are bytes for");
                else if constexpr (std::is_same_v<kind, view::ask::pose>)
                    fuzz::require(std::isfinite(w.turn + w.scale * 0 + w.softness * 0), "a pose is one");
                else if constexpr (std::is_same_v<kind, view::ask::move>)
                    fuzz::require(std::isfinite(w.by[0] + w.by[1] * 0 + w.by[2] * 0), "a way is one");
                else if constexpr (std::is_same_v<kind, view::ask::align>)
                    fuzz::require(w.axis < 3, "an axis");
            },
            m.what);
    }
    catch (const view::message_error&)
    {
    }
    return 0;
}
