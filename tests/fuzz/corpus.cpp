// SPDX-License-Identifier: MIT
#include <iostream>
#include <string>

#include <support/problem_texts.hpp>
#include <support/surface_texts.hpp>
#include <support/temporary_folder.hpp>

/// Writes the files that a fuzzer starts from: corpus <folder>, which gets the folders obj, off, ply and prob.
int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::cerr << "usage: corpus <folder>\n";
        return 1;
    }
    const auto write = [&](const std::string& format, const std::vector<std::string>& texts)
    {
        const auto folder = std::filesystem::path(argv[1]) / format;
        std::filesystem::create_directories(folder);
        int number = 0;
        for (const auto& text : texts)
            taut::test::temporary_folder::write(folder / (std::to_string(number++) + '.' + format), text);
    };
    write("obj", taut::test::obj_texts());
    write("off", taut::test::off_texts());
    write("ply", taut::test::ply_texts());
    auto problems = taut::test::problem_texts();
    for (const auto& pins : taut::test::pin_texts()) problems.push_back(pins);
    write("prob", problems);
}
