// SPDX-License-Identifier: MIT
#include "bake/model_images.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <utility>

#include "shared/failure.hpp"

namespace taut::tools
{

namespace
{

using io::impl::find_in;
using io::impl::gltf_json;
using io::impl::gltf_object;
using io::impl::item_of;
using pointer = gltf_json::json_pointer;

/// Whether a value is this whole number.
bool is_number(const gltf_json* value, std::size_t number)
{
    return value && value->is_number_unsigned() && value->get<std::size_t>() == number;
}

/// The textureInfos of all materials by the texture that they name.
std::map<std::size_t, std::set<std::string>> places_of_textures(const gltf_json& document)
{
    std::map<std::size_t, std::set<std::string>> places;
    const gltf_json* const materials = find_in(document, {"materials"});
    if (!materials) return places;
    for_each_texture(*materials, pointer("/materials"),
                     [&](const std::string&, const pointer& place)
                     {
                         const gltf_json& index = document[place]["index"];
                         if (index.is_number_unsigned()) places[index.get<std::size_t>()].insert(place.to_string());
                     });
    return places;
}

/// The places of uses.
std::set<std::string> places_of(const std::vector<model_texture>& uses)
{
    std::set<std::string> places;
    for (const auto& use : uses)
        for (const auto& place : use.places) places.insert(place.to_string());
    return places;
}

/// Names of the extensions of a texture that name an image.
std::vector<std::string> other_sources(const gltf_json& texture)
{
    std::vector<std::string> names;
    const gltf_json* const extensions = find_in(texture, {"extensions"});
    if (!extensions || !extensions->is_object()) return names;
    for (const auto& [name, value] : extensions->items())
        if (value.is_object() && value.contains("source")) names.push_back(name);
    return names;
}

/// Whether an extension elsewhere than in materials and textures names images or textures.
bool are_named_elsewhere(const gltf_json& value, bool in_extension)
{
    if (!value.is_structured()) return false;
    for (const auto& [key, member] : value.items())
    {
        if (key == "extras") continue;
        std::string word = key;
        for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        const bool names = word.find("image") != std::string::npos || word.find("texture") != std::string::npos;
        if (in_extension && value.is_object() && names) return true;
        if (are_named_elsewhere(member, in_extension || (value.is_object() && key == "extensions"))) return true;
    }
    return false;
}

bool are_named_elsewhere(const gltf_json& document)
{
    return std::any_of(document.items().begin(), document.items().end(),
                       [](const auto& member)
                       {
                           const std::string& key = member.key();
                           if (key == "materials" || key == "textures" || key == "extras") return false;
                           return are_named_elsewhere(member.value(), key == "extensions");
                       });
}

bool names_extension(const gltf_json& value, const std::string& name)
{
    if (!value.is_structured()) return false;
    for (const auto& [key, member] : value.items())
    {
        if (key == "extras") continue;
        if (value.is_object() && key == "extensions" && member.is_object() && member.contains(name)) return true;
        if (names_extension(member, name)) return true;
    }
    return false;
}

/// Takes extensions that nothing has any more out of the lists of those that are used.
void take_out_unused(gltf_json& document, const std::set<std::string>& names)
{
    for (const std::string& name : names)
    {
        if (names_extension(document, name)) continue;
        for (const char* const list : {"extensionsUsed", "extensionsRequired"})
        {
            if (!document.contains(list) || !document[list].is_array()) continue;
            gltf_json left = gltf_json::array();
            for (const gltf_json& used : document[list])
                if (used != name) left.push_back(used);
            if (left.empty())
                document.erase(list);
            else
                document[list] = std::move(left);
        }
    }
}

/// Gives the texture of a place another image: in its place where all who show it are of the use, else as a copy.
class texture_turns
{
public:
    texture_turns(gltf_json& document, std::set<std::string>& taken_out)
        : textures_(document["textures"]), shown_(places_of_textures(document)), taken_out_(taken_out)
    {
    }

    /// The number of a texture with one of the images of a use. copies: of the use
    std::size_t turned(std::size_t number, const std::vector<std::size_t>& images, const model_texture& use,
                       std::map<std::size_t, std::size_t>& copies)
    {
        const auto others = other_sources(textures_[number]);
        const std::size_t source = textures_[number]["source"].get<std::size_t>();
        const bool kept = std::find(images.begin(), images.end(), source) != images.end();
        if (kept && others.empty()) return number;
        const auto& shown = shown_[number];
        const bool alone =
            std::all_of(shown.begin(), shown.end(),
                        [&](const std::string& place)
                        {
                            return std::any_of(use.places.begin(), use.places.end(),
                                               [&](const auto& own) { return own.to_string() == place; });
                        });
        const auto [at, is_new] = copies.try_emplace(number, alone ? number : textures_.size());
        if (!is_new) return at->second;
        if (!alone) textures_.push_back(gltf_json(textures_[number]));
        gltf_json& texture = textures_[at->second];
        texture["source"] = kept ? source : images.front();
        for (const std::string& name : others)
        {
            texture["extensions"].erase(name);
            taken_out_.insert(name);
        }
        if (!others.empty() && texture["extensions"].empty()) texture.erase("extensions");
        return at->second;
    }

private:
    gltf_json& textures_;
    std::map<std::size_t, std::set<std::string>> shown_;
    std::set<std::string>& taken_out_;
};

} // namespace

void require_same_textures(const io::gltf_model& old, const io::gltf_model& next,
                           const std::vector<model_texture>& uses)
{
    constexpr const char* remedy = ": NEW is to be made of OLD, as by `taut atlas OLD -o NEW`";
    for (const char* const list : {"materials", "textures", "images"})
        if (io::impl::root_of(old.source).items(list).size() != io::impl::root_of(next.source).items(list).size())
            throw unsuitable_input(old.source.path + " and " + next.source.path + " have other numbers of " + list +
                                   remedy);
    for (std::size_t t = 0; t < old.materials.size(); ++t)
        if (old.materials[t] != next.materials[t])
            throw unsuitable_input("triangle " + std::to_string(t) + " has other materials in " + old.source.path +
                                   " and " + next.source.path + remedy);
    for (const auto& use : uses)
        for (const pointer& place : use.places)
        {
            const auto number = old.source.document[place]["index"].get<std::size_t>();
            const auto source = item_of(old.source, "textures", number).whole("source");
            const gltf_json& document = next.source.document;
            const gltf_json* const info = document.contains(place) ? &document[place] : nullptr;
            if (!info || !is_number(find_in(*info, {"index"}), number))
                throw unsuitable_input(next.source.path + ": " + place.to_string() + " does not name texture " +
                                       std::to_string(number) + ", as in " + old.source.path + remedy);
            if (item_of(next.source, "textures", number).whole("source", SIZE_MAX >> 1) != source)
                throw unsuitable_input(next.source.path + ": texture " + std::to_string(number) +
                                       " does not have image " + std::to_string(source) + ", as in " + old.source.path +
                                       remedy);
            if (info->contains("extensions") && !(*info)["extensions"].is_object())
                throw io::io_error(next.source.path,
                                   place.to_string() + " has extensions that are no object; export the model again");
        }
}

std::vector<std::vector<std::size_t>> places_of_images(const io::gltf_model& model,
                                                       const std::vector<model_texture>& uses)
{
    const gltf_json& document = model.source.document;
    const std::size_t count = io::impl::root_of(model.source).items("images").size();
    const gltf_json& textures = io::impl::root_of(model.source).items("textures");
    const auto shown = places_of_textures(document);
    const auto own = places_of(uses);
    std::vector<char> free(count, !are_named_elsewhere(document));
    for (std::size_t t = 0; t < textures.size(); ++t)
    {
        const auto at = shown.find(t);
        const bool all =
            at != shown.end() && std::includes(own.begin(), own.end(), at->second.begin(), at->second.end());
        if (all) continue;
        const auto take = [&](const gltf_json* image)
        {
            if (image && image->is_number_unsigned() && image->get<std::size_t>() < count)
                free[image->get<std::size_t>()] = 0;
        };
        take(find_in(textures[t], {"source"}));
        for (const auto& extension : other_sources(textures[t]))
            take(find_in(textures[t], {"extensions", extension.c_str(), "source"}));
    }
    std::size_t next = count;
    std::vector<std::vector<std::size_t>> images;
    for (const auto& use : uses)
    {
        std::vector<std::size_t> taken;
        for (const std::size_t i : use.images)
            if (free[i])
            {
                taken.push_back(i);
                free[i] = 0;
            }
        if (taken.empty()) taken.push_back(next++);
        images.push_back(std::move(taken));
    }
    return images;
}

void show_images(gltf_json& document, const io::gltf_model& model, const std::vector<model_texture>& uses,
                 const std::vector<std::vector<std::size_t>>& images, int texcoord_set, std::vector<std::string>& notes)
{
    std::set<std::string> sources, taken_out{"KHR_texture_transform"};
    std::set<idx> turned;
    texture_turns textures(document, sources);
    for (std::size_t n = 0; n < uses.size(); ++n)
    {
        std::map<std::size_t, std::size_t> copies; // of textures, with the new image
        const auto content = uses[n].content;
        if (is_turned(content)) turned.insert(uses[n].materials.begin(), uses[n].materials.end());
        for (const pointer& place : uses[n].places)
        {
            gltf_json& info = document[place];
            info["index"] = textures.turned(info["index"].get<std::size_t>(), images[n], uses[n], copies);
            info["texCoord"] = texcoord_set;
            if (info.contains("extensions"))
            {
                info["extensions"].erase("KHR_texture_transform");
                if (info["extensions"].empty()) info.erase("extensions");
            }
            if (content == texture_content::direction) document[place.parent_pointer()].erase("anisotropyRotation");
        }
    }
    for (const std::string& name : sources)
        notes.push_back("textures have images of " + name + " beside PNG or JPEG; these are made anew, and " + name +
                        " is taken out of them");
    taken_out.insert(sources.begin(), sources.end());
    take_out_unused(document, taken_out);
    if (turned.empty()) return;
    for (const auto& primitive : io::impl::primitives_of(model.source).all)
    {
        // What stays as it was needs the old ones.
        const auto materials = materials_of(model, primitive);
        if (std::any_of(materials.begin(), materials.end(),
                        [&](idx m)
                        {
                            const auto n = static_cast<std::size_t>(m);
                            return m >= 0 && n < document["materials"].size() && !turned.contains(m) &&
                                   needs_tangents(document["materials"][n]);
                        }))
            continue;
        gltf_json& object = document["meshes"][primitive.mesh]["primitives"][primitive.number];
        if (object.contains("attributes")) object["attributes"].erase("TANGENT");
        for (std::size_t t = 0; t < primitive.targets.size(); ++t) object["targets"][t].erase("TANGENT");
    }
}

} // namespace taut::tools
