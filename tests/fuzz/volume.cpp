// SPDX-License-Identifier: MIT
#include <span>
#include <string>
#include <string_view>

#include <taut/io/cell_faces.hpp>
#include <taut/io/read_volume.hpp>
#include <taut/io/write_volume.hpp>

#include "../support/volume_promises.hpp"
#include "../support/volume_texts.hpp"
#include "mutator.hpp"
#include "require.hpp"

namespace
{

using namespace taut;
using fuzz::dice;
using io::volume_format;

/// The first byte of an input says which format the rest is of. Files of TetGen follow each other, with form feeds
/// between them.
constexpr std::string_view letters = " mgvutsp";

/// A small mesh with any numbers in any format.
std::string generate(dice& random)
{
    auto s = random.one_in(4) ? test::small_square() : test::small_volume(random.one_in(2));
    for (vec3& p : s.points)
        for (int k = 0; k < 3; ++k)
            if (random.one_in(3)) p[k] = static_cast<double>(random.below(2000)) / 1024 - 1;
    for (auto& cell : s.cells)
    {
        if (random.one_in(4)) cell.tag = static_cast<int>(random.below(5)) - 1;
        for (idx& v : cell.corners)
            if (random.one_in(40)) v = static_cast<idx>(random.below(s.points.size() + 1));
    }
    const test::volume_encoding e{random.one_in(2), random.one_in(2) ? std::endian::big : std::endian::little,
                                  random.one_in(3)};
    const int dimension = random.one_in(5) ? 2 : 3;
    const std::string end(random.pick({"\n", "\n", "\r\n"}));
    switch (random.below(9))
    {
    case 0:
        return 'm' + test::medit_text(s, dimension, end);
    case 1:
        return 'g' + test::gmsh2_text(s, e);
    case 2:
        return 'g' + test::gmsh4_text(s, e);
    case 3:
        return 'v' + test::vtk_text(s, e, 3);
    case 4:
        return 'v' + test::vtk_text(s, e, 5);
    case 5:
        return 'u' + test::vtu_text(s, e, random.one_in(2));
    case 6:
        return 's' + test::su2_text(s, dimension, end);
    case 7:
        return "p4 3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n4 3\n0 0 0\n1 0 0\n0 1 0\n0 0 " + random.number() +
               "\n1 4\n0 1 2 3\n1\n2\n";
    default:
        return 't' + test::tetgen_nodes(s, 1, dimension) + '\f' + test::tetgen_cells(s, io::cell_kind::tetrahedron) +
               '\f' + test::tetgen_cells(s, io::cell_kind::triangle);
    }
}

/// Calls f, whose errors are those of bad input.
template <class F>
void attempt(const F& f)
{
    try
    {
        f();
    }
    catch (const error&)
    {
    }
}

/// Whatever the bytes: corners and groups are in range, and of what is written again nothing but coordinates differs.
void examine(const io::volume_file& file, const std::function<io::volume_file(const std::string&)>& read)
{
    std::string broken;
    try
    {
        broken = test::broken_promise(file, read);
    }
    catch (const error& e)
    {
        broken = std::string("what is written can be read: ") + e.what();
    }
    fuzz::require(broken.empty(), broken.c_str());
    attempt([&] { io::tetrahedra_of(file); });
    attempt([&] { io::triangles_of(file); });
    attempt([&] { io::corner_simplices_of(file); });
    attempt([&] { io::corner_simplices_of<triangle>(file); });
    attempt([&] { io::check_sides(file); });
    attempt([&] { io::kept_facets(file, true); });
    attempt([&] { file.find_group("1"); });
}

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed)
{
    return taut::fuzz::mutate(data, size, most, seed, generate);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    const auto letter = size == 0 ? letters.npos : letters.find(bytes[0]);
    if (letter == letters.npos || letter == 0) return 0;
    constexpr std::array formats = {volume_format::automatic, volume_format::medit,  volume_format::gmsh,
                                    volume_format::vtk,       volume_format::vtu,    volume_format::tetgen,
                                    volume_format::su2,       volume_format::problem};
    const auto cut = std::min(bytes.find('\f'), size), second = std::min(bytes.find('\f', cut + 1), size);
    const auto read = [&](const std::string& text)
    {
        if (formats[letter] != volume_format::tetgen) return io::parse_volume(text, formats[letter]);
        return io::parse_tetgen(text, bytes.substr(std::min(cut + 1, size), second - std::min(cut + 1, second)),
                                bytes.substr(std::min(second + 1, size)));
    };
    attempt(
        [&]
        {
            const auto text = bytes.substr(
                1, formats[letter] == volume_format::tetgen ? std::max(cut, std::size_t(1)) - 1 : bytes.npos);
            const auto file = read(text);
            examine(file, read);
        });
    return 0;
}
