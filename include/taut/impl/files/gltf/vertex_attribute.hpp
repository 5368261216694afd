// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <taut/gltf.hpp>
#include <taut/impl/files/gltf/primitives.hpp>

namespace taut::io::impl
{

/// An attribute at the corners of the triangles of a model.
struct corner_attribute
{
    std::size_t components = 0; ///< 0: no primitive has it
    std::vector<double> values; ///< components numbers per corner, three corners per triangle; NaN where there is none

    const double* at(std::size_t triangle, std::size_t corner) const
    {
        return values.data() + (3 * triangle + corner) * components;
    }
};

/// Reads an attribute such as NORMAL, with as many components as the first primitive that has it. Throws io_error.
inline corner_attribute read_attribute(const gltf_model& model, const std::string& name)
{
    const gltf_primitives primitives = primitives_of(model.source);
    corner_attribute result;
    for (const gltf_primitive& p : primitives.all)
    {
        const std::size_t* const number = p.count > 0 ? p.attribute(name) : nullptr;
        if (!number) continue;
        const gltf_accessor a = accessor_of(model.source, *number);
        const std::size_t n = a.type.size() == 4 && a.type.starts_with("VEC") ? std::size_t(a.type[3] - '0') : 0;
        if (n == 0) throw io_error(model.source.path, p.name + " has a " + name + " of no vectors; export it again");
        if (result.components == 0)
        {
            result.components = n;
            result.values.assign(3 * n * model.triangles.size(), std::numeric_limits<double>::quiet_NaN());
        }
        const std::string bytes = all_elements(model.source, a, name);
        for (std::size_t t = p.first; t < p.first + p.count; ++t)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const std::size_t v = static_cast<std::size_t>(model.vertices[t][k]) - primitives.first_vertex[p.pool];
                for (std::size_t i = 0; i < result.components; ++i)
                    result.values[(3 * t + k) * result.components + i] = i < n ? load_number(bytes, a, v * n + i) : 1;
            }
    }
    return result;
}

} // namespace taut::io::impl
