// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <taut/bake.hpp>
#include <taut/impl/charts/bake/compare_textures.hpp>

namespace taut
{

texture_difference compare_textures(const texture& a, const texture& b, std::span<const std::uint8_t> compared)
{
    a.validate("a");
    b.validate("b");
    if (a.width != b.width || a.height != b.height || a.channels != b.channels)
        throw parameter_error("b", "is of another size than a; give textures of one size");
    const std::size_t count = a.size() / static_cast<std::size_t>(a.channels);
    if (!compared.empty() && compared.size() != count)
        throw parameter_error("compared", "has another number of texels than the textures; give one for each");
    texture differences{a.width, a.height, a.channels, std::vector<float>(a.size(), 0.0f)};
    const auto channels = static_cast<std::size_t>(a.channels);
    impl::difference_sum sum(a.channels);
    for (std::size_t n = 0; n < count; ++n)
        if (compared.empty() || compared[n] != 0)
            sum.add(&a.texels[n * channels], &b.texels[n * channels], &differences.texels[n * channels]);
    texture_difference result = sum.result();
    result.image = std::move(differences);
    return result;
}

} // namespace taut
