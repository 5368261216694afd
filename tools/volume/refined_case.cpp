// SPDX-License-Identifier: MIT
#include "volume/refined_case.hpp"

#include "shared/text_table.hpp"

namespace taut::tools
{

nlohmann::ordered_json refined_json(const std::optional<refined_size>& size)
{
    if (!size) return nullptr;
    return {{"rounds", size->rounds}, {"vertices", size->vertices}, {"elements", size->elements}};
}

std::string refined_text(const refined_size& size)
{
    return count(size.vertices, "vertex", "vertices") + ", " + count(size.elements, "element", "elements") + " in " +
           count(static_cast<std::size_t>(size.rounds), "round", "rounds") + " of splits";
}

std::string table_of_parts(std::span<const idx> parts)
{
    std::string text = "element,of\n";
    for (std::size_t c = 0; c < parts.size(); ++c) text += std::to_string(c) + ',' + std::to_string(parts[c]) + '\n';
    return text;
}

} // namespace taut::tools
