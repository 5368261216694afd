// SPDX-License-Identifier: MIT
// Pictures are written with stb, which the library and most tests do without: no stb, no test of it.
#if __has_include(<stb/stb_image_write.h>) && __has_include(<stb/stb_image.h>)

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "../../../tools/png.cpp" // the encoder is not in a library of its own

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

using taut::io::image;
using taut::io::rgb;
namespace fs = std::filesystem;

namespace
{

struct scratch_folder
{
    fs::path path = fs::temp_directory_path() / ("taut-png-" + std::to_string(::getpid()));
    scratch_folder() { fs::create_directories(path); }
    ~scratch_folder() { fs::remove_all(path); }
};

std::string contents(const fs::path& path)
{
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

} // namespace

TEST_CASE("png: a picture written and decoded is the same picture")
{
    image picture(37, 11);
    for (int y = 0; y < 11; ++y)
        for (int x = 0; x < 37; ++x)
            picture(x, y) = {static_cast<std::uint8_t>(7 * x), static_cast<std::uint8_t>(20 * y),
                             static_cast<std::uint8_t>(x * y)};
    const scratch_folder folder;
    taut::tools::write_png(folder.path / "a.png", picture);
    const std::string bytes = contents(folder.path / "a.png");
    int width = 0, height = 0, channels = 0;
    unsigned char* decoded = stbi_load_from_memory(reinterpret_cast<const unsigned char*>(bytes.data()),
                                                   static_cast<int>(bytes.size()), &width, &height, &channels, 3);
    REQUIRE(decoded != nullptr);
    CHECK(width == 37);
    CHECK(height == 11);
    CHECK(std::equal(decoded, decoded + 3 * 37 * 11, picture.bytes()));
    stbi_image_free(decoded);
}

TEST_CASE("png: a file is replaced as a whole and nothing else is left in the folder")
{
    const scratch_folder folder;
    std::ofstream(folder.path / "a.png") << "old";
    taut::tools::write_png(folder.path / "a.png", image(2, 2));
    CHECK(contents(folder.path / "a.png").substr(1, 3) == "PNG");
    CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);
}

TEST_CASE("png: what cannot be written is named, and nothing is left behind")
{
    const scratch_folder folder;
    const fs::path missing = folder.path / "no" / "such" / "a.png";
    CHECK_THROWS_WITH_AS(taut::tools::write_png(missing, image(2, 2)), doctest::Contains("a.png"),
                         taut::tools::picture_error);
    fs::create_directories(folder.path / "taken" / "full"); // a folder that is not empty is not replaced by a file
    CHECK_THROWS_AS(taut::tools::write_png(folder.path / "taken", image(2, 2)), taut::tools::picture_error);
    CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);
    CHECK_THROWS_AS(taut::tools::encode_png(image()), taut::tools::picture_error);
}

#endif
