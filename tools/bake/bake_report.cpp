// SPDX-License-Identifier: MIT
#include "bake/bake_report.hpp"

#include <iostream>
#include <sstream>
#include <utility>

#include "shared/assessment.hpp"
#include "shared/printable.hpp"
#include "shared/text_table.hpp"

namespace taut::tools
{

namespace
{

const char* word_of(texture_content content)
{
    switch (content)
    {
    case texture_content::colour:
        return "colour";
    case texture_content::normal:
        return "normal";
    case texture_content::direction:
        return "direction";
    default:
        return "data";
    }
}

double part_covered(const baked_report& t)
{
    return t.texels > 0 ? static_cast<double>(t.covered) / static_cast<double>(t.texels) : 0;
}

} // namespace

nlohmann::ordered_json to_json(const bake_report& r, const bake_options& o)
{
    nlohmann::ordered_json json;
    json["schema"] = "taut.bake/1";
    json["old"] = o.before;
    json["new"] = o.after;
    json["output"] = o.output;
    json["device"] = r.device;
    json["faces"] = r.triangles;
    json["left_out"] = r.left_out;
    json["textures"] = nlohmann::ordered_json::array();
    for (const auto& t : r.textures)
    {
        nlohmann::ordered_json texture{{"name", t.name},
                                       {"content", word_of(t.content)},
                                       {"width", t.width},
                                       {"height", t.height},
                                       {"channels", t.channels},
                                       {"tiles", t.tiles},
                                       {"texels", t.texels},
                                       {"bytes", t.bytes},
                                       {"covered", part_covered(t)}};
        texture["largest_difference"] = t.largest ? finite(*t.largest) : nullptr;
        texture["rms_difference"] = t.rms ? finite(*t.rms) : nullptr;
        texture["compared_texels"] = t.compared;
        texture["unlike_numbers"] = t.unlike;
        json["textures"].push_back(std::move(texture));
    }
    json["seconds"] = {{"read", r.read}, {"bake", r.bake}, {"write", r.write}, {"total", r.total}};
    json["notes"] = r.notes;
    return json;
}

std::string text_of(const bake_report& r, const bake_options& o)
{
    for (const auto& note : r.notes) std::cerr << "taut: note: " << printable(note) << '\n';
    labelled_lines lines;
    lines.add("surface", o.before + " -> " + o.after + ": " + count(r.triangles, "triangle", "triangles") +
                             (r.left_out > 0 ? ", " + count(r.left_out) + " left out" : ""));
    lines.add("device", r.device_label);
    for (const auto& t : r.textures)
        lines.add(
            "texture",
            t.name + ": " + word_of(t.content) + ", " + (t.tiles > 1 ? "up to " : "") + std::to_string(t.width) +
                " x " + std::to_string(t.height) +
                (t.tiles > 1 ? ", " + std::to_string(t.tiles) + " tiles of " + count(t.texels) + " texels, " : ", ") +
                number(100 * part_covered(t), 3) + " % covered" +
                (t.largest ? "; through both atlases rms " + number(*t.rms, 3) + ", at most " + number(*t.largest, 3)
                           : ""));
    lines.add("time", duration(r.total) + ": read " + duration(r.read) + ", bake " + duration(r.bake) + ", write " +
                          duration(r.write));
    lines.add_written({o.output, o.difference, o.stats});
    std::ostringstream out;
    out << lines;
    return out.str();
}

} // namespace taut::tools
