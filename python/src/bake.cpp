// SPDX-License-Identifier: MIT
// Textures of one atlas made for another.
#include <algorithm>

#include <taut/bake.hpp>

#include "bindings.hpp"
#include "queues.hpp"

namespace taut::python
{

namespace
{

/// Texture coordinates of corners: (3 m, 2).
std::vector<std::array<vec2, 3>> corners_of(const array& rows, const char* name)
{
    const auto points = points_of<2>(rows, name);
    std::vector<std::array<vec2, 3>> corners(points.size() / 3);
    for (std::size_t c = 0; c < 3 * corners.size(); ++c) corners[c / 3][c % 3] = points[c];
    return corners;
}

/// image: height * width rows of channels, from v = 0 upwards
nb::tuple bake_image(const array& image, const array& old_uv, const array& new_uv, const nb::dict& keywords)
{
    const options given(keywords);
    texture old;
    given.read("width", old.width);
    given.read("height", old.height);
    given.read("channels", old.channels);
    for (const double x : numbers_of(image)) old.texels.push_back(static_cast<float>(x));
    const auto from = corners_of(old_uv, "old_uv"), to = corners_of(new_uv, "new_uv");
    bake_params params;
    given.read("new_width", params.width);
    given.read("new_height", params.height);
    given.read_word("filter", params.filter,
                    {{"bilinear", texture::filter::bilinear}, {"nearest", texture::filter::nearest}});
    given.read_word(
        "wrap", params.wrap,
        {{"repeat", texture::wrap::repeat}, {"clamp", texture::wrap::clamp}, {"mirror", texture::wrap::mirror}});
    given.read("samples", params.samples);
    given.read("gutter", params.gutter);
    std::string device;
    given.read("device", device);
    std::optional<baked_texture> made;
    {
        nb::gil_scoped_release unlocked;
        const auto q = borrow_queue(device);
        made.emplace(bake(*q, old, from, to, params));
    }
    std::vector<double> texels(made->image.texels.begin(), made->image.texels.end());
    const std::vector<idx> covered(made->covered.begin(), made->covered.end());
    return nb::make_tuple(array_of(std::move(texels)), array_of(covered), made->image.width, made->image.height);
}

} // namespace

void add_bake(nb::module_& m)
{
    m.def("bake", &bake_image);
}

} // namespace taut::python
