// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_BAKE
#endif
#ifndef TAUT_BAKE_HPP
#define TAUT_BAKE_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <taut/errors.hpp>
#include <taut/queue.hpp>
#include <taut/types.hpp>

/// Transfers textures from one UV atlas to another.
namespace taut
{

/// Image of a texture: width x height texels of 1 to 4 numbers each, linear (not encoded as sRGB). Row 0 is at v = 0,
/// and v runs upwards, as in OBJ: the centre of texel (i, j) is at ((i + 0.5) / width, (j + 0.5) / height). Files have
/// their top row first.
struct texture
{
    /// Interpolation between texels.
    enum class filter
    {
        bilinear, ///< of the four texels around
        nearest   ///< the texel that the place is in: for numbers that are labels
    };

    /// Continuation of a texture beyond the unit square.
    enum class wrap
    {
        repeat,
        clamp, ///< the texel of the border
        mirror ///< it repeats, every other copy mirrored
    };

    idx width = 0, height = 0, channels = 0;
    std::vector<float> texels; ///< row by row, the channels of a texel one after the other

    /// Throws parameter_error: sizes from 1 to 65,536, 1 to 4 channels, as many numbers.
    void validate(const std::string& name = "texture") const
    {
        if (width < 1 || height < 1 || width > 65536 || height > 65536)
            throw parameter_error(name, "has " + std::to_string(width) + " x " + std::to_string(height) +
                                            " texels; give 1 to 65536 along each side");
        if (channels < 1 || channels > 4)
            throw parameter_error(name, "has " + std::to_string(channels) + " channels; give 1 to 4");
        if (texels.size() != size())
            throw parameter_error(name, "has " + std::to_string(texels.size()) + " numbers for " +
                                            std::to_string(size()) + "; give width * height * channels");
    }

    std::size_t size() const
    {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(channels);
    }

    const float* at(idx i, idx j) const
    {
        return texels.data() +
               (static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)) *
                   static_cast<std::size_t>(channels);
    }

    /// Value of the texture at a place: unused channels are 0. The reference of what devices compute.
    /// beyond_v: along v, if that is another one
    std::array<double, 4> sample(vec2 uv, filter by = filter::bilinear, wrap beyond = wrap::repeat,
                                 std::optional<wrap> beyond_v = {}) const
    {
        const auto wrapped = [](double x, idx size, wrap how)
        {
            const double n = static_cast<double>(size), period = how == wrap::mirror ? 2 * n : n;
            if (how != wrap::clamp) x -= period * std::floor(x / period);
            if (how == wrap::mirror && x >= n) x = period - 1 - x;
            return static_cast<idx>(std::clamp(x, 0.0, n - 1));
        };
        std::array<double, 4> value{};
        const auto add = [&](double x, double y, double weight)
        {
            const float* const texel = at(wrapped(x, width, beyond), wrapped(y, height, beyond_v.value_or(beyond)));
            for (idx c = 0; c < channels; ++c)
                value[static_cast<std::size_t>(c)] += weight * static_cast<double>(texel[c]);
        };
        const double x = uv.x * width, y = uv.y * height;
        if (by == filter::nearest)
        {
            add(std::floor(x), std::floor(y), 1);
            return value;
        }
        const double i = std::floor(x - 0.5), j = std::floor(y - 0.5), s = x - 0.5 - i, t = y - 0.5 - j;
        add(i, j, (1 - s) * (1 - t));
        add(i + 1, j, s * (1 - t));
        add(i, j + 1, (1 - s) * t);
        add(i + 1, j + 1, s * t);
        return value;
    }
};

/// Tangent of each corner of a triangle: direction in which u grows, and in w the side of the bitangent, in which v
/// grows: it is w * cross(normal, tangent), w = 1 or -1 where the map is mirrored.
using corner_tangents = std::array<vec<4>, 3>;

/// Smooth normals of a surface: those of the triangles around a vertex weighted by their angle there (Thürmer, Wüthrich
/// 1998), one per corner.
std::vector<std::array<vec3, 3>> smooth_normals(std::span<const vec3> points,
                                                std::span<const std::array<idx, 3>> triangles);

/// Tangents of a map of a surface, as in MikkTSpace (Mikkelsen 2008): the directions of u of the triangles around a
/// vertex, projected across its normal and weighted by their angle there; corners share one where position, normal,
/// texture coordinates and the side of the map agree. One triple per triangle; a triangle without an area in the map
/// adds nothing, and has any tangent where no other one is.
///
/// normals: unit vectors, one per corner
/// uv: one per corner, v upwards
/// Throws parameter_error for wrong numbers of these.
std::vector<corner_tangents> tangent_frames(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles,
                                            std::span<const std::array<vec3, 3>> normals,
                                            std::span<const std::array<vec2, 3>> uv);

/// Parameters of bake() and its like.
struct bake_params
{
    idx width = 0, height = 0; ///< texels of the new texture; 0: as many as the old one has, 1024 where there is none
    texture::filter filter = texture::filter::bilinear; ///< of the old texture
    texture::wrap wrap = texture::wrap::repeat;         ///< of the old texture
    std::optional<texture::wrap> wrap_v = {};           ///< along v, if that is another one
    idx samples = 1; ///< along each side of a texel, 1 to 8: their mean is taken, for a new texture that is coarser
                     ///< than the old one; not with `nearest`
    double gutter = std::numeric_limits<double>::infinity(); ///< texels around charts that get the nearest texel of a
                                                             ///< chart; what is farther stays 0
    vec2 origin =
        vec2(0.0); ///< lower left corner of the unit square that the new texture covers: (1, 0) is 1002 of UDIM
    bool green_down = false; ///< of bake() of normals: green grows downwards in the image, as for DirectX

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (width < 0 || width > 65536) throw parameter_error("width", "must be from 1 to 65536, or 0");
        if (height < 0 || height > 65536) throw parameter_error("height", "must be from 1 to 65536, or 0");
        if (samples < 1 || samples > 8) throw parameter_error("samples", "must be from 1 to 8");
        if (samples > 1 && filter == texture::filter::nearest)
            throw parameter_error("samples", "a mean of labels is none; give 1 with the filter `nearest`");
        if (!(gutter >= 0)) throw parameter_error("gutter", "must be 0 or more");
        if (!std::isfinite(origin.x) || !std::isfinite(origin.y)) throw parameter_error("origin", "must be finite");
    }
};

/// Texture for a new atlas.
struct baked_texture
{
    texture image;
    std::vector<std::uint8_t> covered; ///< a number per texel: 1 its centre, or a sample of it, is in a triangle;
                                       ///< 2 it is within a texel and a half of one; 0 elsewhere (gutter)
};

/// Makes the texture for a new atlas of a surface that shows on it what the old texture shows through the old atlas:
/// each texel gets the old texture at the place on the surface that the new atlas has at its centre, on the device.
/// Texels outside of charts have the value of the nearest place of a chart within a texel and a half, and beyond that
/// the nearest such texel. Where triangles overlap in the new atlas, the first one counts.
///
/// from, to: old and new texture coordinates, one per corner of the same triangles, v upwards; a triangle with one that
///           is not finite is left out; one may not reach over 2^24 texels of the old texture
/// Throws parameter_error for numbers that do not fit together, device_error.
baked_texture bake(queue& q, const texture& old, std::span<const std::array<vec2, 3>> from,
                   std::span<const std::array<vec2, 3>> to, const bake_params& params = {});

/// The same for numbers at the corners of triangles, such as colours of vertices, linear in each triangle.
/// values: `channels` numbers (1 to 4) per corner, three corners per triangle
baked_texture bake(queue& q, std::span<const float> values, idx channels, std::span<const std::array<vec2, 3>> to,
                   const bake_params& params = {});

/// Normals of the corners of a surface, and the tangents of both atlases.
struct bake_frames
{
    std::span<const std::array<vec3, 3>> normals; ///< unit vectors, one triple per triangle
    std::span<const corner_tangents> from, to;    ///< as tangent_frames() makes them
    bool directions = false;      ///< of directions across normals, whose third channel says something else
    double before = 0, after = 0; ///< by how much directions are rotated, in radians
};

/// The same for normals in tangent space: three channels (and alpha), (x + 1) / 2 of each coordinate along tangent,
/// bitangent and normal. They are turned from the tangents of the old atlas to those of the new one.
baked_texture bake(queue& q, const texture& old, const bake_frames& frames, std::span<const std::array<vec2, 3>> from,
                   std::span<const std::array<vec2, 3>> to, const bake_params& params = {});

/// Difference of two textures of one size.
struct texture_difference
{
    texture image;          ///< |a - b| by texel and channel; 0 where nothing is compared
    double largest = 0;     ///< of all
    double rms = 0;         ///< root of the mean square over the compared texels and their channels
    std::size_t texels = 0; ///< compared
    std::size_t unlike = 0; ///< numbers that are none in one of the textures alone: they differ by any amount
};

/// Compares two textures, such as one and what came back of it through another atlas. compared: not 0 for the texels
/// that count, or empty for all. Where one alone has no number they differ by infinity. Throws parameter_error if sizes
/// differ.
texture_difference compare_textures(const texture& a, const texture& b, std::span<const std::uint8_t> compared = {});

} // namespace taut

#endif
#include <taut/impl/leave.inl>
