// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include <taut/impl/files/surface/ply.hpp>

#include "budget.hpp"
#include "mutator.hpp"
#include "surface_promises.hpp"

namespace
{

using namespace taut;
using fuzz::dice;

constexpr std::array<std::array<std::string_view, 2>, 8> type_names = {{{"char", "int8"},
                                                                        {"uchar", "uint8"},
                                                                        {"short", "int16"},
                                                                        {"ushort", "uint16"},
                                                                        {"int", "int32"},
                                                                        {"uint", "uint32"},
                                                                        {"float", "float32"},
                                                                        {"double", "float64"}}};

struct property
{
    std::string name;
    std::size_t type;
    bool list;
    std::size_t count_type;
};

/// Writes values of the three encodings.
class body
{
public:
    explicit body(std::size_t encoding) : encoding_(encoding) {}

    void add(double x, std::size_t type)
    {
        switch (type)
        {
        case 0:
            return put(static_cast<std::int8_t>(x));
        case 1:
            return put(static_cast<std::uint8_t>(static_cast<int>(x)));
        case 2:
            return put(static_cast<std::int16_t>(x));
        case 3:
            return put(static_cast<std::uint16_t>(static_cast<int>(x)));
        case 4:
            return put(static_cast<std::int32_t>(x));
        case 5:
            return put(static_cast<std::uint32_t>(static_cast<long long>(x)));
        case 6:
            return put(static_cast<float>(x));
        default:
            return put(x);
        }
    }
    void end_row()
    {
        if (encoding_ == 0) text += '\n';
    }

    std::string text;

private:
    template <class T>
    void put(T x)
    {
        if (encoding_ == 0)
        {
            text += std::to_string(x) + ' ';
            return;
        }
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), &x, sizeof x);
        if ((encoding_ == 2) != (std::endian::native == std::endian::big)) std::reverse(bytes.begin(), bytes.end());
        text.append(bytes.data(), bytes.size());
    }

    std::size_t encoding_;
};

/// Elements with properties in any order, of any type; some that matter missing, repeated or lists where they should
/// be none.
std::string generate(dice& random)
{
    const std::size_t encoding = random.below(3);
    const auto any_type = [&] { return random.below(type_names.size()); };
    std::string header = "ply\nformat " +
                         std::string(std::array{"ascii", "binary_little_endian", "binary_big_endian"}[encoding]) +
                         " 1.0\n";
    body data(encoding);
    std::size_t vertices = 0;
    for (std::size_t n = random.between(2, 5), e = 0; e < n; ++e)
    {
        const bool last = e + 1 == n;
        const std::string name(random.one_in(10) ? random.pick({"vertex", "face", "edge", ""})
                               : last            ? "face"
                               : e == 0          ? "vertex"
                                                 : random.pick({"edge", "camera", "vertex", "face"}));
        const std::size_t rows = random.between(name == "vertex" ? 3 : 1, 6);
        std::vector<property> properties;
        const auto add = [&](std::string_view property_name, bool list = false) {
            properties.push_back({std::string(property_name), any_type(), list != random.one_in(60), any_type() % 6});
        };
        if (name == "vertex")
        {
            for (const auto* p : {"x", "y", "z"})
                if (!random.one_in(60)) add(p);
            for (const auto& group : {std::vector{"s", "t"}, {"u", "v"}, {"nx", "ny", "nz"}, {"red", "green", "blue"}})
                if (random.one_in(3))
                    for (const auto* p : group)
                        if (!random.one_in(20)) add(p);
        }
        if (name == "face")
        {
            if (!random.one_in(40)) add(random.pick({"vertex_indices", "vertex_index"}), true);
            if (random.one_in(3)) add(random.pick({"texcoord", "texcoords"}), true);
        }
        for (std::size_t k = random.below(3); k > 0; --k)
            add(random.pick({"quality", "flags", "id", "x", "w"}), random.one_in(2));
        if (!properties.empty() && random.one_in(3))
            std::swap(properties.front(), properties[random.below(properties.size())]);
        header += std::string(random.pick({"", "", "comment c # \\\n", "obj_info\n"})) + "element " + name + ' ' +
                  (random.one_in(60) ? random.number() : std::to_string(rows)) + '\n';
        for (const auto& p : properties)
            header += "property " +
                      (p.list ? "list " + std::string(type_names[p.count_type][random.below(2)]) + ' ' : "") +
                      std::string(type_names[p.type][random.below(2)]) + ' ' + p.name + '\n';
        for (std::size_t r = 0; r < rows; ++r)
        {
            const std::size_t corners = random.one_in(40) ? random.below(7) : random.between(3, 5),
                              first = random.below(vertices + 1);
            for (const auto& p : properties)
            {
                const bool indices = p.name.starts_with("vertex"), coords = p.name.starts_with("texcoord");
                const std::size_t items = !p.list   ? 1
                                          : indices ? corners
                                          : coords  ? (random.one_in(30)  ? 5
                                                       : random.one_in(8) ? 0
                                                                          : 2 * corners)
                                                    : random.below(4);
                if (p.list) data.add(static_cast<double>(items), p.count_type);
                for (std::size_t k = 0; k < items; ++k)
                    data.add(indices ? static_cast<double>(
                                           random.one_in(60) ? 99 : (first + k) % std::max<std::size_t>(vertices, 1))
                                     : static_cast<double>(random.below(40)) * 0.25 - (random.one_in(3) ? 4 : 0),
                             p.type);
            }
            data.end_row();
        }
        if (name == "vertex") vertices += rows;
    }
    return header + "end_header\n" + data.text;
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
        fuzz::require_promises(io::impl::parse_ply(std::string_view(reinterpret_cast<const char*>(data), size)));
    }
    catch (const error&)
    {
    }
    try
    {
        fuzz::require_repairable(io::impl::parse_ply_soup(std::string_view(reinterpret_cast<const char*>(data), size)));
    }
    catch (const error&)
    {
    }
    return 0;
}
