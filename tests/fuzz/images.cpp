// SPDX-License-Identifier: MIT
// Images of textures, by the program's own reader: stb_image and tinyexr are not ours, but what they leave behind is.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <taut/errors.hpp>

#include <bake/exr_image.cpp>
#include <bake/image_file.cpp>
#include <bake/png_rows.cpp>
#include <shared/png.cpp>

#include "require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace taut;
    try
    {
        const auto file = tools::read_image({reinterpret_cast<const char*>(data), size}, "image");
        const impl::texture_rows& image = file.rows;
        fuzz::require(image.width > 0 && image.height > 0 && image.channels >= 1 && image.channels <= 4,
                      "an image has texels of one to four numbers");
        std::vector<float> row(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels));
        for (idx j = 0; j < image.height; ++j)
        {
            image.values(j, row.data());
            if (file.numbers != tools::image_numbers::floats)
                fuzz::require(std::all_of(row.begin(), row.end(), [](float x) { return x >= 0 && x <= 1; }),
                              "numbers of PNG and JPEG are from 0 to 1");
        }
    }
    catch (const io::io_error&)
    {
    }
    return 0;
}
