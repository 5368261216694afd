// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "../../tools/paste/face_list.cpp"
#include "../../tools/shared/edge_list.cpp"
#include "budget.hpp"
#include "mutator.hpp"
#include "require.hpp"

namespace
{

using namespace taut;
using fuzz::dice;

constexpr idx vertices = 9;

/// Edges, as of --seams, or faces, as of --keep-charts and --region.
std::string generate(dice& random)
{
    const bool edges = random.one_in(2);
    const std::string end(random.pick({"\n", "\n", "\r\n", "\r"}));
    std::string text;
    for (std::size_t n = random.between(1, 8); n > 0; --n)
    {
        text += random.count(vertices);
        if (edges) text += std::string(random.pick({" ", " ", ",", "\t", ", "})) + random.count(vertices);
        text += std::string(random.pick({"", "", "", "# c", " "})) + end;
    }
    return text;
}

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed)
{
    return taut::fuzz::mutate(data, size, most, seed, generate);
}

/// Whatever the bytes, they are edges of vertices that there are, each once, and numbers of faces, or an error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const taut::fuzz::budget limit(size);
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try
    {
        const auto edges = tools::parse_edges(text, "seams", vertices);
        fuzz::require(std::is_sorted(edges.begin(), edges.end(), std::less_equal<>()), "edges ascend, each once");
        for (const auto& e : edges)
            fuzz::require(e[0] >= 0 && e[0] <= e[1] && e[1] < vertices, "vertices of edges in range");
    }
    catch (const error&)
    {
    }
    try
    {
        fuzz::require(tools::parse_faces(text, "faces").size() <= size, "no more faces than bytes");
    }
    catch (const error&)
    {
    }
    return 0;
}
