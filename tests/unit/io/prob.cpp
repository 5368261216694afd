// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <string>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>
#include <taut/errors.hpp>
#include <taut/impl/files/surface/prob.hpp>
#include <taut/impl/files/surface/prob_bodies.hpp>
#include <taut/surface_file.hpp>

using namespace taut;
using test::temporary_folder;

namespace
{

const std::string square_problem = "4 2\n0 0\n1 0\n1 1\n0 1\n"
                                   "4 2\n0 0\n1 0\n0.25 1e-3\n0 1\n"
                                   "2 3\n0 1 2\n0 2 3\n"
                                   "2\n0\n3\n";

/// `text` with its first `from` replaced.
std::string with(std::string text, const std::string& from, const std::string& to)
{
    return text.replace(text.find(from), from.size(), to);
}

void check_problem_refused(const std::string& text, std::size_t line, const std::string& words)
{
    CAPTURE(text);
    try
    {
        io::impl::parse_prob<triangle>(text);
        FAIL("accepted");
    }
    catch (const io::io_error& e)
    {
        CHECK_MESSAGE(std::string(e.what()).find(words) != std::string::npos, e.what());
        REQUIRE(e.place());
        CHECK(e.place()->number == line);
    }
}

} // namespace

TEST_CASE("problem files: rest shape, initial map, triangles and fixed vertices")
{
    const auto p = io::impl::parse_prob<triangle>(square_problem);
    CHECK(p.rest.size() == 4);
    CHECK(p.rest[2] == vec3(1, 1, 0));
    CHECK(p.initial[2] == vec2(0.25, 1e-3));
    CHECK(p.cells == std::vector<std::array<taut::idx, 3>>{{0, 1, 2}, {0, 2, 3}});
    CHECK(p.fixed == std::vector<taut::idx>{0, 3});

    // Lines ends of any kind, blank lines, a surface in space at rest.
    std::string other;
    for (const char c : square_problem) other += c == '\n' ? "\r\n\r\n" : std::string(1, c);
    CHECK(io::impl::parse_prob<triangle>(other).cells == p.cells);
    const std::string space =
        with(with(square_problem, "4 2\n0 0\n1 0\n1 1\n0 1", "4 3\n0 0 7\n1 0 7\n1 1 7\n0 1 7"), "2\n0\n3", "0");
    CHECK(io::impl::parse_prob<triangle>(space).rest[3] == vec3(0, 1, 7));
    CHECK(io::impl::parse_prob<triangle>(space).fixed.empty());
}

TEST_CASE("problem files: tetrahedra are told from triangles")
{
    temporary_folder folder;
    const std::string text = "4 3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n4 3\n0 0 0\n1 0 0\n0 1 0\n0 0 -1\n1 4\n0 1 2 3\n1\n2\n";
    folder.write(folder / "a.prob", square_problem);
    folder.write(folder / "b.prob", text);
    CHECK(std::holds_alternative<io::impl::prob_file<triangle>>(io::read_prob(folder / "a.prob")));
    const auto b = io::read_prob(folder / "b.prob");
    REQUIRE(std::holds_alternative<io::impl::prob_file<tetrahedron>>(b));
    CHECK(std::get<1>(b).initial[3] == vec3(0, 0, -1));
    CHECK_THROWS_AS(io::impl::parse_prob<triangle>(text), io::io_error);
    CHECK_THROWS_AS(io::read_prob(folder / "none.prob"), io::io_error);
}

TEST_CASE("problem files: whatever is malformed is refused with its line")
{
    check_problem_refused("", 1, "rest vertices");
    check_problem_refused(with(square_problem, "4 2", "4 5"), 1, "2 or 3");
    check_problem_refused(with(square_problem, "4 2", "-4 2"), 1, "32 bits");
    check_problem_refused(with(square_problem, "4 2", "4"), 1, "dimension");
    check_problem_refused(with(square_problem, "1 1", "1 one"), 4, "expected a number, found 'one'");
    check_problem_refused(with(square_problem, "1 1", "1 nan"), 4, "finite");
    check_problem_refused(with(square_problem, "1 1", "1e999 1"), 4, "finite");
    check_problem_refused(with(square_problem, "1 1", "1 1 1"), 4, "end of the line");
    check_problem_refused(with(square_problem, "1 1", "1"), 4, "expected a number");
    check_problem_refused(with(square_problem, "4 2\n0 0\n1 0\n0.25", "5 2\n0 0\n1 0\n0.25"), 6,
                          "one position a vertex");
    check_problem_refused(with(square_problem, "2 3\n", "2 4\n"), 11, "4 corners");
    check_problem_refused(with(square_problem, "0 1 2", "0 1 4"), 12, "vertex 4 of 4");
    check_problem_refused(with(square_problem, "0 1 2", "0 -1 2"), 12, "vertex -1");
    check_problem_refused(with(square_problem, "0 1 2", "0 1 1"), 12, "vertex 1 twice");
    check_problem_refused(with(square_problem, "0 1 2", "0 1 2.5"), 12, "found '2.5'");
    check_problem_refused(with(square_problem, "2 3\n", "3 3\n"), 14,
                          "end of the line"); // the number of fixed vertices is no triangle
    check_problem_refused(with(square_problem, "2\n0\n3", "2\n0\n9"), 16, "vertex 9");
    check_problem_refused(with(square_problem, "2\n0\n3\n", "2\n0\n"), 16, "ends before fixed vertex 1 of 2");
    check_problem_refused(square_problem + "7\n", 17, "end of the file");
    check_problem_refused("2000000000 3\n0 0 0\n", 3, "ends before rest vertex 1");
    CHECK_THROWS_AS(io::impl::parse_prob<tetrahedron>(square_problem), io::io_error);
    CHECK_THROWS_AS(io::impl::parse_prob<triangle>(std::string(10, '\0')), io::io_error);
    for (std::size_t n = 0; n + 4 < square_problem.size(); ++n) // cut anywhere
        CHECK_THROWS_AS(io::impl::parse_prob<triangle>(square_problem.substr(0, n)), io::io_error);
}

TEST_CASE("maps: a vertex a line, numbers read back bit for bit")
{
    temporary_folder folder;
    const std::vector<vec2> x{{0.1, -1.0 / 3}, {1e-300, 5e-324}, {-0.0, 12345678.9}};
    io::write_map<2>(folder / "out.txt", x);
    const std::string text = folder.read(folder / "out.txt");
    const char* at = text.c_str();
    for (const vec2& p : x)
        for (int k = 0; k < 2; ++k)
        {
            char* end = nullptr;
            CHECK(std::strtod(at, &end) == p[k]);
            at = end;
        }
    CHECK(text.starts_with("0.10000000000000001 -0.33333333333333331\n"));
    CHECK(std::count(text.begin(), text.end(), '\n') == 3);
    CHECK_THROWS_AS(io::write_map<2>(folder / "missing/out.txt", x), io::io_error);
    CHECK(folder.entries() == 1);
}
