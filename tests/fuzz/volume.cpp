// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <taut/impl/files/volume/cell_faces.hpp>
#include <taut/impl/files/volume/coding/array_code.hpp>
#include <taut/impl/files/volume/read_volume.hpp>
#include <taut/impl/files/volume/write_volume.hpp>
#include <taut/volume_file.hpp>

#include "../support/volume_promises.hpp"
#include "../support/volume_texts.hpp"
#include "budget.hpp"
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

/// A code for n bytes of a VTU file.
io::impl::array_code random_code(dice& random, const io::impl::array_code& all, std::size_t n)
{
    auto code = all;
    code.apart = random.one_in(2);
    if (n == 0) return code;
    code.block = random.between(1, n + 3);
    code.blocks = (n + code.block - 1) / code.block;
    code.last = n % code.block;
    if (code.last == 0 && random.one_in(4)) code.last = code.block;
    return code;
}

/// A VTU file of one tetrahedron with arrays of any type, count and encoding, that may share their bytes.
std::string generate_vtu(dice& random)
{
    namespace d = io::impl;
    const bool big = random.one_in(2), wide = random.one_in(2);
    const std::string appended = std::string(random.pick({"raw", "raw", "base64"}));
    d::array_code all;
    all.order = big ? std::endian::big : std::endian::little;
    all.word = wide ? 8 : 4;
    std::string compressor;
    if (random.one_in(2))
    {
        const auto& words = d::compressors[random.below(d::compressors.size())];
        compressor = " compressor=\"" + std::string(words.name) + '"';
        if (words.built) all.packed = words.kind;
    }
    const bool inline_arrays = random.one_in(3);
    std::string data, arrays, cells;
    std::vector<std::string> places;
    const auto put = [&](std::string& to, auto value)
    {
        std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
        if (big) std::reverse(bytes.begin(), bytes.end());
        to += bytes;
    };
    const auto array = [&](std::string_view type, const std::string& name, std::initializer_list<int> values)
    {
        std::string bytes, words;
        for (const int x : values)
        {
            words += std::to_string(x) + ' ';
            if (type.ends_with("8")) put(bytes, static_cast<std::int8_t>(x));
            if (type.ends_with("Int16")) put(bytes, static_cast<std::int16_t>(x));
            if (type.ends_with("Int32")) put(bytes, static_cast<std::int32_t>(x));
            if (type.ends_with("Int64")) put(bytes, static_cast<std::int64_t>(x));
            if (type == "Float32") put(bytes, static_cast<float>(x));
            if (type == "Float64") put(bytes, static_cast<double>(x));
        }
        std::string tag = "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\" ";
        if (name == "Points" || random.one_in(12)) tag += "NumberOfComponents=\"3\" ";
        if (random.one_in(4)) return tag + "format=\"ascii\">" + words + "</DataArray>";
        const bool appended_here = random.one_in(20) ? inline_arrays : !inline_arrays;
        auto code = random_code(random, all, bytes.size());
        code.base64 = !appended_here || appended == "base64";
        std::string text = d::coded(bytes, code);
        if (random.one_in(60)) text.resize(random.below(text.size() + 1));
        if (!appended_here)
        {
            if (random.one_in(8)) text.insert(random.below(text.size() + 1), random.pick({"\n", "  ", "\r\n", "="}));
            return tag + "format=\"binary\">" + std::string(random.pick({"", "\n  "})) + text + "</DataArray>";
        }
        if (places.empty() || !random.one_in(12))
        {
            places.push_back(std::to_string(data.size()));
            data += text;
            return tag + "format=\"appended\" offset=\"" + places.back() + "\"/>";
        }
        return tag + "format=\"appended\" offset=\"" + places[random.below(places.size())] + "\"/>";
    };
    const auto integers = [&] { return random.pick({"Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64"}); };
    const std::string points =
        array(random.pick({"Float32", "Float64"}), "Points", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
    cells = array(integers(), "connectivity", {0, 1, 2, 3}) + array(integers(), "offsets", {4});
    cells += array(integers(), "types", {10});
    for (std::size_t k = random.below(6); k > 0; --k)
        arrays += array(random.one_in(6) ? "Float64" : integers(), "a" + std::to_string(k), {1, 2, 1, 2});
    return "<VTKFile type=\"UnstructuredGrid\" byte_order=\"" + std::string(big ? "BigEndian" : "LittleEndian") +
           "\" header_type=\"" + (wide ? "UInt64" : "UInt32") + '"' + compressor +
           "><UnstructuredGrid>\n<Piece NumberOfPoints=\"" + (random.one_in(8) ? random.count(5) : "4") +
           "\" NumberOfCells=\"1\">\n<PointData>\n" + arrays + "\n</PointData>\n<Points>" + points +
           "</Points>\n<Cells>" + cells + "</Cells></Piece></UnstructuredGrid>\n<AppendedData encoding=\"" + appended +
           "\">_" + data + "</AppendedData></VTKFile>";
}

/// A text of gmsh 4.1 with entities of any number of tags, blocks in any order, parameters, and names.
std::string generate_gmsh4(dice& random)
{
    std::string text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
    if (random.one_in(2))
        text += "$PhysicalNames\n2\n3 1 \"body\"\n2 " + random.count(4) + " \"" +
                std::string(random.pick({"body", "", "wall"})) + "\"\n$EndPhysicalNames\n";
    const std::size_t entities = random.between(1, 3);
    text += "$Entities\n0 0 0 " + std::to_string(entities) + '\n';
    for (std::size_t k = 1; k <= entities; ++k)
    {
        const std::size_t tags = random.one_in(6) ? random.between(0, 60) : random.below(3);
        text += std::to_string(random.one_in(12) ? 1 : k) + " 0 0 0 1 1 1 " + std::to_string(tags);
        for (std::size_t t = 0; t < tags; ++t) text += ' ' + std::to_string(random.between(1, 9));
        text += random.one_in(2) ? " 0\n" : " 2 1 -2\n";
    }
    text += "$EndEntities\n$Nodes\n" + std::to_string(entities) + ' ' + std::to_string(4 * entities) + " 1 99\n";
    const std::size_t dimension = random.between(2, 3);
    for (std::size_t k = 0; k < entities; ++k)
    {
        const bool parameters = random.one_in(3);
        text += std::to_string(dimension) + ' ' + std::to_string(k + 1) + (parameters ? " 1 4\n" : " 0 4\n");
        for (std::size_t v = 0; v < 4; ++v) text += std::to_string(4 * k + v + 1) + '\n';
        for (const char* corner : {"0 0 ", "1 0 ", "0 1 ", "0 0 "})
            text += corner + random.number() + (!parameters ? "" : dimension == 2 ? " 0.5 0.5" : " 0.5 0.5 0") + '\n';
    }
    text += "$EndNodes\n$Elements\n" + std::to_string(entities) + ' ' + std::to_string(entities) + " 1 99\n";
    for (std::size_t k = 0; k < entities; ++k)
    {
        text += "3 " + random.count(entities + 1) + " 4 1\n" + std::to_string(k + 1);
        for (std::size_t v = 0; v < 4; ++v) text += ' ' + std::to_string(4 * k + v + 1);
        text += '\n';
    }
    return text + "$EndElements\n";
}

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
    switch (random.below(11))
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
    case 8:
        return 'u' + generate_vtu(random);
    case 9:
        return 'g' + generate_gmsh4(random);
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
    attempt([&] { file.tetrahedra(); });
    attempt([&] { file.triangles(); });
    attempt([&] { file.corner_simplices(); });
    attempt([&] { file.corner_simplices<triangle>(); });
    attempt([&] { io::impl::check_sides(file); });
    attempt([&] { file.kept_facets(true); });
    attempt([&] { file.find_group("1"); });
}

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed)
{
    return taut::fuzz::mutate(data, size, most, seed, generate);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const taut::fuzz::budget limit(size);
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    const auto letter = size == 0 ? letters.npos : letters.find(bytes[0]);
    if (letter == letters.npos || letter == 0) return 0;
    constexpr std::array formats = {volume_format::automatic, volume_format::medit,  volume_format::gmsh,
                                    volume_format::vtk,       volume_format::vtu,    volume_format::tetgen,
                                    volume_format::su2,       volume_format::problem};
    const auto cut = std::min(bytes.find('\f'), size), second = std::min(bytes.find('\f', cut + 1), size);
    const auto read = [&](const std::string& text)
    {
        if (formats[letter] != volume_format::tetgen) return io::impl::parse_volume(text, formats[letter]);
        return io::impl::parse_tetgen(text, bytes.substr(std::min(cut + 1, size), second - std::min(cut + 1, second)),
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
