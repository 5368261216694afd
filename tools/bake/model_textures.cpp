// SPDX-License-Identifier: MIT
#include "bake/model_textures.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include <taut/impl/files/gltf/container.hpp>

#include "shared/failure.hpp"
#include "shared/text_table.hpp"

namespace taut::tools
{

namespace
{

using io::impl::find_in;
using io::impl::gltf_json;
using io::impl::gltf_object;
using io::impl::item_of;
using pointer = gltf_json::json_pointer;
using parts = std::map<std::size_t, shown_part>; // by the first triangle

/// Triangles that show a material.
struct shown_triangles
{
    parts all;
    bool divided = false; ///< some through two kinds of texture coordinates
};

/// Meaning of a texture by the name that a material has for it.
texture_content content_of(std::string_view key)
{
    if (key.ends_with("ormalTexture")) return texture_content::normal;
    if (key == "anisotropyTexture") return texture_content::direction;
    if (key.ends_with("ColorTexture")) return texture_content::colour;
    for (const char* const colour : {"emissiveTexture", "diffuseTexture", "specularGlossinessTexture",
                                     "shadeMultiplyTexture", "rimMultiplyTexture"})
        if (key == colour) return texture_content::colour;
    return texture_content::data;
}

double number_of(const gltf_json* list, std::size_t i, double otherwise)
{
    return list && list->is_array() && i < list->size() && (*list)[i].is_number() ? (*list)[i].get<double>()
                                                                                  : otherwise;
}

/// KHR_texture_transform of a textureInfo.
std::array<double, 5> transform_of(const gltf_json& info)
{
    const gltf_json* const moved = find_in(info, {"extensions", "KHR_texture_transform"});
    if (!moved) return shown_part{}.transform;
    const auto* const offset = find_in(*moved, {"offset"});
    const auto* const scale = find_in(*moved, {"scale"});
    const auto* const rotation = find_in(*moved, {"rotation"});
    return {number_of(offset, 0, 0), number_of(offset, 1, 0),
            rotation && rotation->is_number() ? rotation->get<double>() : 0, number_of(scale, 0, 1),
            number_of(scale, 1, 1)};
}

/// Continuation of a texture, of wrapS or wrapT.
texture::wrap wrap_of(const gltf_object& sampler, const char* key)
{
    constexpr std::size_t repeat = 10497, clamp_to_edge = 33071, mirrored_repeat = 33648;
    const std::size_t wrap = sampler.whole(key, repeat);
    if (wrap == clamp_to_edge) return texture::wrap::clamp;
    if (wrap == mirrored_repeat) return texture::wrap::mirror;
    if (wrap != repeat) sampler.fail("has a " + std::string(key) + " that glTF has not; give 10497, 33071 or 33648");
    return texture::wrap::repeat;
}

/// Images with the bytes of each: the first such one stands for all.
std::vector<std::size_t> same_images(const io::gltf_model& model)
{
    std::vector<std::size_t> first;
    std::map<std::string, std::size_t> known;
    for (std::size_t i = 0; i < io::impl::root_of(model.source).items("images").size(); ++i)
    {
        const gltf_object image = item_of(model.source, "images", i);
        std::string bytes = "image " + std::to_string(i);
        if (const auto file = io::impl::file_of_image(model.source, i))
            bytes = "file " + file->string();
        else if (image.find("bufferView") && !image.find("uri"))
        {
            const auto view = item_of(model.source, "bufferViews", image.whole("bufferView"));
            bytes = "bytes";
            for (const char* const key : {"buffer", "byteOffset", "byteLength"})
                bytes += ' ' + std::to_string(view.whole(key, 0));
        }
        first.push_back(known.emplace(std::move(bytes), i).first->second);
    }
    return first;
}

/// The triangles of a primitive, or of the one that it draws again; coordinates: the name of its texture coordinates.
shown_part part_of(const io::impl::gltf_primitives& primitives, const io::impl::gltf_primitive& p,
                   const std::string& coordinates)
{
    const auto& drawn = p.copy_of ? primitives.all[*p.copy_of] : p;
    shown_part part{.count = drawn.count, .first_vertex = primitives.first_vertex[drawn.pool]};
    const auto differs = [&](const std::string& name)
    {
        const std::size_t *const own = p.attribute(name), *const read = drawn.attribute(name);
        return own && read ? *own != *read : own != read;
    };
    if (const std::size_t* const own = p.attribute(coordinates); own && differs(coordinates)) part.texcoords = *own;
    part.other_frames = differs("NORMAL") || differs("TANGENT");
    return part;
}

/// Adds parts; false: one is shown in another way already, and nothing is added.
bool join(parts& into, const parts& more)
{
    for (const auto& [first, part] : more)
        if (const auto at = into.find(first); at != into.end() && at->second != part) return false;
    into.insert(more.begin(), more.end());
    return true;
}

/// Triangles by the material that shows them.
std::map<idx, shown_triangles> shown_by_material(const io::gltf_model& model, int texcoord_set)
{
    std::map<idx, shown_triangles> shown;
    const auto primitives = io::impl::primitives_of(model.source);
    const std::string coordinates = "TEXCOORD_" + std::to_string(texcoord_set);
    for (const auto& p : primitives.all)
    {
        const auto& drawn = p.copy_of ? primitives.all[*p.copy_of] : p;
        if (drawn.count == 0 || (p.copy_of && !p.attribute(coordinates))) continue;
        const parts part{{drawn.first, part_of(primitives, p, coordinates)}};
        for (const idx material : materials_of(model, p))
        {
            shown_triangles& triangles = shown[material];
            if (!join(triangles.all, part)) triangles.divided = true;
        }
    }
    // MSFT_lod: others that take the place of a material far away.
    const auto with_levels = shown;
    for (const auto& [material, triangles] : with_levels)
    {
        if (material < 0) continue;
        item_of(model.source, "materials", static_cast<std::size_t>(material)); // is there
        const auto& own = model.source.document["materials"][static_cast<std::size_t>(material)];
        const gltf_json* const ids = find_in(own, {"extensions", "MSFT_lod", "ids"});
        for (std::size_t i = 0; ids && ids->is_array() && i < ids->size(); ++i)
            if ((*ids)[i].is_number_unsigned() &&
                (*ids)[i].get<std::size_t>() < model.source.document["materials"].size())
            {
                auto& level = shown[static_cast<idx>((*ids)[i].get<std::size_t>())];
                if (!join(level.all, triangles.all)) level.divided = true;
            }
    }
    shown.erase(-1);
    return shown;
}

/// Finds the uses of a model.
class use_search
{
public:
    use_search(const io::gltf_model& model, int texcoord_set)
        : model_(model), set_(static_cast<std::size_t>(texcoord_set)), same_(same_images(model))
    {
    }

    void look_at(idx material, const shown_triangles& triangles)
    {
        const auto number = static_cast<std::size_t>(material);
        const gltf_json& value = model_.source.document["materials"][number];
        item_of(model_.source, "materials", number); // is an object
        bool turned = false, stays = false, direction = false;
        for_each_texture(value, pointer("/materials") / number,
                         [&](const std::string& key, const pointer& place)
                         {
                             const bool shown = add(key, place, material, triangles);
                             const auto content = content_of(key);
                             direction = direction || content == texture_content::direction;
                             if (is_turned(content)) (shown ? turned : stays) = true;
                         });
        const gltf_json* const strength =
            find_in(value, {"extensions", "KHR_materials_anisotropy", "anisotropyStrength"});
        const bool grained = strength && strength->is_number() && strength->get<double>() != 0 && !direction;
        if (turned && (stays || grained))
            fail(number, "shows normals or directions through another set of texture coordinates, or without any, and "
                         "their tangents change; take KHR_materials_anisotropy or the other textures out");
        if (grained && !has_tangents(material))
            fail(number, "has KHR_materials_anisotropy without a texture: its grain follows the atlas; give it an "
                         "anisotropyTexture, or the primitives tangents");
    }

    /// Counts textures of materials that nothing shows.
    void leave(std::size_t material)
    {
        for_each_texture(model_.source.document["materials"][material], pointer("/materials") / material,
                         [&](const std::string&, const pointer&) { hidden_.insert(material); });
    }

    std::vector<model_texture> found(std::vector<std::string>& notes)
    {
        if (others_ > 0)
            notes.push_back(count(others_, "texture has", "textures have") +
                            " another set of texture coordinates than TEXCOORD_" + std::to_string(set_) + ", and " +
                            (others_ == 1 ? "stays as it is" : "stay as they are"));
        std::string names;
        for (const std::size_t n : hidden_)
            if (n != *hidden_.begin() && names.size() > 200)
            {
                names += ", ...";
                break;
            }
            else
                names += (names.empty() ? "" : ", ") + std::to_string(n);
        if (!hidden_.empty())
            notes.push_back((hidden_.size() == 1 ? "no primitive has material " : "no primitive has materials ") +
                            names + "; textures that only such have stay as they are");
        return std::move(uses_);
    }

private:
    [[noreturn]] void fail(std::size_t material, const std::string& what) const
    {
        throw unsuitable_input(model_.source.path + ": material " + std::to_string(material) + ' ' + what);
    }

    /// The set that a textureInfo names.
    std::size_t set_of(const gltf_object& info, const gltf_json& value) const
    {
        const gltf_json* const own = find_in(value, {"extensions", "KHR_texture_transform", "texCoord"});
        return own ? info.whole(*own, "texCoord") : info.whole("texCoord", 0);
    }

    /// Whether all triangles of a material have tangents of their own.
    bool has_tangents(idx material) const
    {
        for (const auto& p : io::impl::primitives_of(model_.source).all)
            if (p.has_triangles() && materials_of(model_, p).contains(material) && !p.attribute("TANGENT"))
                return false;
        return true;
    }

    /// What two textureInfos of one use have in common.
    static auto key_of(const model_texture& u)
    {
        return std::tie(u.images, u.content, u.wrap_u, u.wrap_v, u.filter, u.rotation);
    }

    /// Returns whether it is of the set.
    bool add(const std::string& key, const pointer& place, idx material, const shown_triangles& triangles)
    {
        if (key == "matcapTexture") return false; // by the direction of view
        const auto& document = model_.source.document;
        const gltf_json& value = document[place];
        const gltf_object info(value, place.to_string(), model_.source.path);
        if (set_of(info, value) != set_)
        {
            ++others_;
            return false;
        }
        if (place.to_string().find("/MSFT_packing_") != std::string::npos && key.find("ormal") != std::string::npos)
            fail(static_cast<std::size_t>(material), "has normals packed with other numbers (" + place.to_string() +
                                                         "), which are not read; take that texture out");
        require_still(place);
        model_texture use = use_of(key, info, place);
        require_one_look(static_cast<std::size_t>(material), use.content, triangles);
        parts shown = triangles.all;
        for (auto& [first, part] : shown) part.transform = transform_of(value);
        const auto same =
            std::find_if(uses_.begin(), uses_.end(),
                         [&](model_texture& u) { return key_of(u) == key_of(use) && join(u.shown, shown); });
        const bool is_new = same == uses_.end();
        model_texture& known = is_new ? uses_.emplace_back(std::move(use)) : *same;
        if (is_new) known.shown = std::move(shown);
        known.places.push_back(place);
        known.materials.insert(material);
        return true;
    }

    /// Throws unsuitable_input where the triangles of a primitive are drawn again in a way that one new texture cannot
    /// show.
    void require_one_look(std::size_t material, texture_content content, const shown_triangles& triangles) const
    {
        if (triangles.divided)
            fail(material, "is shown on the same triangles through two kinds of TEXCOORD_" + std::to_string(set_) +
                               ", which have one place in the new atlas; give one of the primitives other materials, "
                               "or positions of its own");
        for (const auto& [first, part] : triangles.all)
            if (is_turned(content) && part.other_frames)
                fail(material, "has normals or directions on a primitive that draws the triangles of another one with "
                               "other NORMAL or TANGENT; give it positions of its own");
    }

    /// Throws unsuitable_input where an animation moves the texture.
    void require_still(const pointer& place) const
    {
        const std::string moved = place.to_string() + "/extensions/KHR_texture_transform";
        for (const gltf_json& animation : io::impl::root_of(model_.source).items("animations"))
            if (const gltf_json* const channels = find_in(animation, {"channels"}))
                for (const gltf_json& channel : *channels)
                {
                    const auto* const named =
                        find_in(channel, {"target", "extensions", "KHR_animation_pointer", "pointer"});
                    if (named && named->is_string() && named->get_ref<const std::string&>().starts_with(moved))
                        throw unsuitable_input(model_.source.path + ": " + place.to_string() +
                                               " is moved by an animation, which no new texture can show; take it out");
                }
    }

    /// A textureInfo as it is used.
    model_texture use_of(const std::string& key, const gltf_object& info, const pointer& place) const
    {
        const auto texture = item_of(model_.source, "textures", info.whole("index"));
        if (!texture.find("source"))
            texture.fail(
                "has no PNG or JPEG, but an extension in its place; convert the images, as gltf-transform does");
        model_texture use;
        const std::size_t source = texture.whole("source");
        const gltf_object image = item_of(model_.source, "images", source);
        for (std::size_t i = 0; i < same_.size(); ++i)
            if (same_[i] == same_[source]) use.images.push_back(i);
        use.content = content_of(key);
        use.name = image.find("name") && image.find("name")->is_string() ? image.text("name")
                                                                         : "image " + std::to_string(source);
        if (texture.find("sampler"))
        {
            const auto sampler = item_of(model_.source, "samplers", texture.whole("sampler"));
            constexpr std::size_t nearest = 9728, linear = 9729;
            use.wrap_u = wrap_of(sampler, "wrapS");
            use.wrap_v = wrap_of(sampler, "wrapT");
            if (sampler.whole("magFilter", linear) == nearest) use.filter = texture::filter::nearest;
        }
        if (use.content == texture_content::direction)
            if (const auto* const angle =
                    find_in(model_.source.document[place.parent_pointer()], {"anisotropyRotation"});
                angle && angle->is_number())
                use.rotation = angle->get<double>();
        return use;
    }

    const io::gltf_model& model_;
    std::size_t set_;
    std::vector<std::size_t> same_;
    std::vector<model_texture> uses_;
    std::size_t others_ = 0;
    std::set<std::size_t> hidden_;
};

} // namespace

vec2 shown_part::place(vec2 uv) const
{
    // KHR_texture_transform: translation * rotation * scale, of coordinates whose v runs downwards.
    const double u = transform[3] * uv.x, v = transform[4] * (1 - uv.y);
    const double c = std::cos(transform[2]), s = std::sin(transform[2]);
    return {transform[0] + c * u + s * v, 1 - (transform[1] - s * u + c * v)};
}

corner_uv texcoords_of(const io::gltf_model& model, std::size_t first, const shown_part& part)
{
    const std::string name = "accessor " + std::to_string(*part.texcoords);
    const auto accessor = io::impl::accessor_of(model.source, *part.texcoords);
    if (accessor.type != "VEC2")
        throw io::io_error(model.source.path, name + " has texture coordinates that are no VEC2; save two numbers");
    const std::string bytes = io::impl::all_elements(model.source, accessor, name);
    corner_uv uv(part.count);
    for (std::size_t t = 0; t < part.count; ++t)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const std::size_t v = static_cast<std::size_t>(model.vertices[first + t][k]) - part.first_vertex;
            uv[t][k] = {io::impl::load_number(bytes, accessor, 2 * v),
                        1 - io::impl::load_number(bytes, accessor, 2 * v + 1)};
        }
    return uv;
}

void for_each_texture(const gltf_json& value, const pointer& place,
                      const std::function<void(const std::string&, const pointer&)>& f)
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

bool needs_tangents(const gltf_json& material)
{
    bool needed = find_in(material, {"extensions", "KHR_materials_anisotropy"}) != nullptr;
    for_each_texture(material, pointer(),
                     [&](const std::string& key, const pointer&) { needed = needed || is_turned(content_of(key)); });
    return needed;
}

std::set<idx> materials_of(const io::gltf_model& model, const io::impl::gltf_primitive& primitive)
{
    std::set<idx> materials{primitive.material};
    const gltf_json& own = model.source.document["meshes"][primitive.mesh]["primitives"][primitive.number];
    const auto* const mappings = find_in(own, {"extensions", "KHR_materials_variants", "mappings"});
    if (!mappings || !mappings->is_array()) return materials;
    for (const gltf_json& mapping : *mappings)
    {
        const gltf_object object(mapping, primitive.name + ", a mapping of KHR_materials_variants,", model.source.path);
        const std::size_t material = object.whole("material");
        item_of(model.source, "materials", material); // is there
        materials.insert(static_cast<idx>(material));
    }
    return materials;
}

std::vector<model_texture> textures_of(const io::gltf_model& model, int texcoord_set, std::vector<std::string>& notes)
{
    use_search search(model, texcoord_set);
    const auto shown = shown_by_material(model, texcoord_set);
    for (const auto& [material, triangles] : shown) search.look_at(material, triangles);
    for (std::size_t m = 0; m < io::impl::root_of(model.source).items("materials").size(); ++m)
        if (!shown.contains(static_cast<idx>(m))) search.leave(m);
    return search.found(notes);
}

} // namespace taut::tools
