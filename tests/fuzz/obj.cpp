// SPDX-License-Identifier: MIT
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "budget.hpp"
#include "mutator.hpp"
#include "surface_promises.hpp"

namespace
{

using namespace taut;
using fuzz::dice;

/// A face or what may stand between faces.
std::string statement(dice& random, std::size_t vertices, std::size_t coords, const std::string& end)
{
    const std::string blank =
        random.one_in(20) ? " \\" + (end == "\r" ? "\n" : end) : std::string(random.pick({" ", " ", "\t"}));
    const auto number = [&](std::size_t n)
    {
        return random.one_in(6)    ? '-' + std::to_string(random.between(1, n))
               : random.one_in(50) ? random.count(n)
                                   : std::to_string(random.between(1, n));
    };
    if (random.one_in(4))
        return std::string(random.pick({"usemtl wood", "g a b", "o thing", "s 1", "# note", "#\\", "l 1 2", "l 1/1 2/2",
                                        "v 0 0 0 # c:\\", "mtllib c:\\x\\", "vn 0 0 1", "vt 0.5 0.5 0", "v 1 2 3 c",
                                        "v 0 0 1 1 1 1 # c", "", "p 1", "curv \\"})) +
               end;
    std::string text = random.one_in(30) ? " f" : "f";
    const std::size_t size = random.one_in(40) ? random.between(0, 9) : random.between(3, 5),
                      first = random.below(vertices);
    const std::size_t style = random.below(6);
    for (std::size_t k = 0; k < size; ++k)
    {
        // Corners of a face differ, mostly.
        text += blank + (random.one_in(8) ? number(vertices) : std::to_string((first + k) % vertices + 1));
        if (style == 1) text += '/' + number(coords);
        if (style == 2) text += "//" + number(1);
        if (style == 3) text += '/' + number(coords) + '/' + number(1);
        if (style == 4) text += random.pick({"", "/", "//"});
    }
    return text + std::string(random.pick({"", "", " ", " # c"})) + end;
}

std::string generate(dice& random)
{
    const std::string end(random.pick({"\n", "\n", "\r\n", "\r"}));
    const std::size_t vertices = random.between(3, 9), coords = random.between(1, 9);
    std::string points = "vn 0 0 1" + end, faces;
    for (std::size_t v = 0; v < vertices; ++v)
        points += "v " + random.number() + ' ' + random.number() + ' ' + random.number() + end;
    for (std::size_t t = 0; t < coords; ++t) points += "vt " + random.number() + ' ' + random.number() + end;
    for (std::size_t n = random.between(1, 9); n > 0; --n) faces += statement(random, vertices, coords, end);
    return std::string(random.one_in(10) ? "\xef\xbb\xbf" : "") + (random.one_in(5) ? faces + points : points + faces);
}

/// The text without vt statements and without the texture coordinates of faces: by other code than the reader's.
/// Without blank lines, and with CR for CR LF, as a CR that comes to stand before the LF of a blank line is one with
/// it.
std::string without_texcoords(const std::string& text)
{
    static const std::set<std::string> of_numbers{"v",    "vt",    "vn",   "vp",   "f",     "fo",    "l",     "p",
                                                  "curv", "curv2", "surf", "parm", "trim",  "hole",  "scrv",  "sp",
                                                  "con",  "deg",   "bmat", "step", "ctech", "stech", "cstype"};
    std::string result;
    std::size_t at = text.starts_with("\xef\xbb\xbf") ? 3 : 0;
    result.append(text, 0, at);
    const auto joins = [&](std::size_t i)
    { return text[i] == '\\' && i + 1 < text.size() && (text[i + 1] == '\n' || text[i + 1] == '\r'); };
    const auto join_length = [&](std::size_t i) -> std::size_t { return text.compare(i, 3, "\\\r\n") == 0 ? 3 : 2; };
    while (at < text.size())
    {
        // The words of a statement with the blanks before them.
        std::vector<std::pair<std::string, std::string>> words;
        bool ended = false;
        while (!ended)
        {
            std::string blanks, word;
            while (at < text.size() && (std::string(" \t\v\f").find(text[at]) != std::string::npos || joins(at)))
            {
                const std::size_t n = joins(at) ? join_length(at) : 1;
                blanks.append(text, at, n);
                at += n;
            }
            while (at < text.size() && std::string(" \t\v\f\r\n").find(text[at]) == std::string::npos && !joins(at))
                word += text[at++];
            ended = word.empty();
            words.emplace_back(blanks, word);
            if (of_numbers.contains(words[0].second) && word.find('#') == word.npos) continue;
            ended = true; // names and comments end with their line
            while (at < text.size() && text[at] != '\n' && text[at] != '\r') words.back().second += text[at++];
        }
        std::string end;
        if (at < text.size()) end = text[at];
        at += text.compare(at, 2, "\r\n") == 0 ? 2 : end.size();
        if (words[0].second == "vt" || (words.size() == 1 && words[0].first.empty() && words[0].second.empty()))
            continue;
        bool corners = false;
        for (auto& [blanks, word] : words)
        {
            if (word.starts_with('#')) corners = false;
            const auto slash = word.find('/');
            if (corners && slash != word.npos) word.erase(slash, word.find('/', slash + 1) - slash);
            if (&word == &words[0].second) corners = word == "f" || word == "l" || word == "surf";
            result += blanks + word;
        }
        result += end;
    }
    return result;
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
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    try
    {
        const std::string written = fuzz::require_promises(io::impl::parse_obj(bytes));
        const std::string before = without_texcoords(bytes), after = without_texcoords(written);
        if (before != after) std::fprintf(stderr, "--- read\n%s\n--- written\n%s\n", before.c_str(), after.c_str());
        fuzz::require(before == after, "only texture coordinates change");
    }
    catch (const error&)
    {
    }
    try
    {
        fuzz::require_repairable(io::impl::parse_obj_soup(bytes));
    }
    catch (const error&)
    {
    }
    return 0;
}
