// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include <taut/io/obj.hpp>
#include <taut/io/off.hpp>
#include <taut/io/ply.hpp>
#include <taut/mesh/boundary.hpp>
#include <taut/mesh/order.hpp>
#include <taut/mesh/validate.hpp>

/// libFuzzer: TAUT_FUZZ_PARSE is one of parse_obj, parse_off, parse_ply. Whatever the bytes, the reader returns a
/// surface or throws an error of the library; and check(), the order and the boundary cope with every surface.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    try
    {
        const std::string_view bytes(reinterpret_cast<const char*>(data), size);
        const auto file = taut::io::TAUT_FUZZ_PARSE(bytes);
        const auto sides = taut::facets(file.surface);
        const auto found = taut::check(file.surface, sides);
        const auto same = taut::check(taut::permute(file.surface, taut::locality_order(file.surface)));
        if (found.size() != same.size()) std::abort(); // renumbering hid or made a fault
        if (sides.oriented()) taut::boundary_loops(file.surface, sides);
        if (!file.texcoords.empty()) file.vertex_texcoords();
    }
    catch (const taut::error&)
    {
    }
    return 0;
}
