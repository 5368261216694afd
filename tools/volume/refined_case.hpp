// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include <taut/impl/core/mesh/refine_elements.hpp>
#include <taut/impl/files/volume/write_volume.hpp>

#include "shared/failure.hpp"
#include "volume/volume_case.hpp"

namespace taut::tools
{

/// Size of a refined mesh.
struct refined_size
{
    int rounds = 0;
    std::size_t vertices = 0, elements = 0;
};

nlohmann::ordered_json refined_json(const std::optional<refined_size>& size); ///< null: no element was split
std::string refined_text(const refined_size& size);

/// The lines element,of: of each element, the one of the input that it is a part of.
std::string table_of_parts(std::span<const idx> parts);

/// A volume file some of whose cells are split.
template <class Element>
class refined_case
{
public:
    refined_case(const io::volume_file& file, const impl::subdivision& how)
        : file_(io::impl::subdivided(file, how)), case_(file_)
    {
    }
    refined_case(const refined_case&) = delete;
    refined_case& operator=(const refined_case&) = delete;

    const volume_case<Element>& parts() const { return case_; }

private:
    io::volume_file file_;
    volume_case<Element> case_; ///< refers to the file
};

/// Before anything is solved. Throws io_error for files that are not written with more cells.
inline void require_refinable(const io::volume_file& file)
{
    io::impl::subdivided(file, impl::subdivision(static_cast<idx>(file.points.size())));
}

} // namespace taut::tools
