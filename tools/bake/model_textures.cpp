// SPDX-License-Identifier: MIT
#include "bake/model_textures.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include <taut/impl/gltf/primitives.hpp>

namespace taut::tools
{

namespace
{

using io::impl::gltf_json;
using pointer = gltf_json::json_pointer;

/// Meaning of a texture by the name that a material has for it.
texture_content content_of(std::string_view key)
{
    if (key.ends_with("ormalTexture")) return texture_content::normal;
    for (const char* const colour : {"baseColorTexture", "emissiveTexture", "diffuseTexture", "sheenColorTexture",
                                     "specularColorTexture", "specularGlossinessTexture"})
        if (key == colour) return texture_content::colour;
    return texture_content::data;
}

/// Calls f(key, place) for each textureInfo below a value.
template <class F>
void for_each_texture(const gltf_json& value, const pointer& place, F f)
{
    if (!value.is_structured()) return;
    if (value.is_array())
    {
        for (std::size_t i = 0; i < value.size(); ++i) for_each_texture(value[i], place / i, f);
        return;
    }
    for (const auto& [key, member] : value.items())
        if (key != "extras")
        {
            if (key.ends_with("Texture") && member.is_object() && member.contains("index"))
                f(key, place / key);
            else
                for_each_texture(member, place / key, f);
        }
}

double number_of(const gltf_json& list, std::size_t i, double otherwise)
{
    return list.is_array() && i < list.size() && list[i].is_number() ? list[i].get<double>() : otherwise;
}

/// A textureInfo as it is used.
model_texture use_of(const io::gltf_model& model, const std::string& key, const gltf_json& info, std::size_t image,
                     const gltf_json& texture)
{
    model_texture use;
    use.image = image;
    use.content = content_of(key);
    const io::impl::gltf_object images = io::impl::item_of(model.source, "images", image);
    use.name = images.find("name") && images.find("name")->is_string() ? images.text("name")
                                                                       : "image " + std::to_string(image);
    if (texture.contains("sampler") && texture["sampler"].is_number_unsigned())
    {
        const auto sampler = io::impl::item_of(model.source, "samplers", texture["sampler"].get<std::size_t>());
        constexpr std::size_t clamp_to_edge = 33071;
        if (sampler.whole("wrapS", 10497) == clamp_to_edge) use.wrap = texture::wrap::clamp;
    }
    const auto found = info.value(pointer("/extensions/KHR_texture_transform"), gltf_json());
    if (!found.is_object()) return use;
    const auto list = [&](const char* name) { return found.contains(name) ? found[name] : gltf_json(); };
    use.transform = {number_of(list("offset"), 0, 0), number_of(list("offset"), 1, 0),
                     list("rotation").is_number() ? list("rotation").get<double>() : 0, number_of(list("scale"), 0, 1),
                     number_of(list("scale"), 1, 1)};
    return use;
}

/// The set that a textureInfo names.
std::size_t set_of(const io::gltf_model& model, const gltf_json& info)
{
    const io::impl::gltf_object object(info, "a texture of a material", model.source.path);
    const auto own = pointer("/extensions/KHR_texture_transform/texCoord");
    if (info.contains(own) && info[own].is_number_unsigned()) return info[own].get<std::size_t>();
    return object.whole("texCoord", 0);
}

} // namespace

vec2 model_texture::place(vec2 uv) const
{
    // KHR_texture_transform: translation * rotation * scale, of coordinates whose v runs downwards.
    const double u = transform[3] * uv.x, v = transform[4] * (1 - uv.y);
    const double c = std::cos(transform[2]), s = std::sin(transform[2]);
    return {transform[0] + c * u + s * v, 1 - (transform[1] - s * u + c * v)};
}

std::vector<model_texture> textures_of(const io::gltf_model& model, int texcoord_set, std::vector<std::string>& notes)
{
    using ranges = std::vector<std::array<std::size_t, 2>>;
    std::map<idx, ranges> shown; // by material
    const auto primitives = io::impl::primitives_of(model.source);
    for (const auto& p : primitives.all)
    {
        const auto& drawn = p.copy_of ? primitives.all[*p.copy_of] : p;
        if (drawn.count == 0) continue;
        shown[p.material].push_back({static_cast<std::size_t>(drawn.first), static_cast<std::size_t>(drawn.count)});
    }
    std::vector<model_texture> uses;
    const auto& document = model.source.document;
    std::size_t others = 0;
    const auto add = [&](const std::string& key, const pointer& place, const ranges& triangles)
    {
        const gltf_json& info = document[place];
        if (set_of(model, info) != static_cast<std::size_t>(texcoord_set))
        {
            ++others;
            return;
        }
        const io::impl::gltf_object object(info, place.to_string(), model.source.path);
        const auto texture = io::impl::item_of(model.source, "textures", object.whole("index"));
        if (!texture.find("source"))
            texture.fail(
                "has no PNG or JPEG, but an extension in its place; convert the images, as gltf-transform does");
        model_texture use =
            use_of(model, key, info, texture.whole("source"), document["textures"][object.whole("index")]);
        auto same = std::find_if(uses.begin(), uses.end(),
                                 [&](const model_texture& u) {
                                     return u.image == use.image && u.content == use.content && u.wrap == use.wrap &&
                                            u.transform == use.transform;
                                 });
        if (same == uses.end()) same = uses.insert(uses.end(), std::move(use));
        same->places.push_back(place);
        same->shown.insert(same->shown.end(), triangles.begin(), triangles.end());
    };
    for (const auto& [material, triangles] : shown)
    {
        if (material < 0) continue;
        const auto number = static_cast<std::size_t>(material);
        io::impl::item_of(model.source, "materials", number); // is there
        for_each_texture(document["materials"][number], pointer("/materials") / number,
                         [&, &triangles = triangles](const std::string& key, const pointer& place)
                         { add(key, place, triangles); });
    }
    if (others > 0)
        notes.push_back(std::to_string(others) + (others == 1 ? " texture has" : " textures have") +
                        " another set of texture coordinates than TEXCOORD_" + std::to_string(texcoord_set) +
                        ", and stay as they are");
    return uses;
}

void show_images(gltf_json& document, const std::vector<model_texture>& uses, const std::vector<std::size_t>& images,
                 int texcoord_set)
{
    const std::size_t textures = document["textures"].size();
    for (std::size_t n = 0; n < uses.size(); ++n)
    {
        std::map<std::size_t, std::size_t> copies; // of textures, with the new image
        for (const pointer& place : uses[n].places)
        {
            gltf_json& info = document[place];
            const auto number = info["index"].get<std::size_t>();
            if (images[n] != uses[n].image && number < textures)
            {
                const auto [at, is_new] = copies.try_emplace(number, document["textures"].size());
                if (is_new)
                {
                    gltf_json copy = document["textures"][number];
                    copy["source"] = images[n];
                    document["textures"].push_back(std::move(copy));
                }
                info["index"] = at->second;
            }
            info["texCoord"] = texcoord_set;
            if (!info.contains("extensions")) continue;
            info["extensions"].erase("KHR_texture_transform");
            if (info["extensions"].empty()) info.erase("extensions");
        }
    }
    if (std::none_of(uses.begin(), uses.end(),
                     [](const model_texture& use) { return use.content == texture_content::normal; }))
        return;
    for (gltf_json& mesh : document["meshes"])
        for (gltf_json& primitive : mesh["primitives"])
            if (primitive.contains("attributes")) primitive["attributes"].erase("TANGENT");
}

} // namespace taut::tools
