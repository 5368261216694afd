// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include <taut/impl/files/file/read_file.hpp>
#include <taut/impl/files/surface/prob.hpp>
#include <taut/impl/files/surface/prob_bodies.hpp>
#include <taut/surface_file.hpp>

namespace taut::io
{

std::variant<impl::prob_file<triangle>, impl::prob_file<tetrahedron>> read_prob(const std::filesystem::path& path)
{
    const std::string text = impl::read_file(path);
    impl::prob_reader reader(text, path.string());
    reader.read_rest();
    if (reader.map_dimension() == 2) return reader.read_map<triangle>();
    return reader.read_map<tetrahedron>();
}

} // namespace taut::io
