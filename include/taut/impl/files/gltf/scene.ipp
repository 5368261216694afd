// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/files/gltf/accessor.hpp>
#include <taut/impl/files/gltf/primitives.hpp>
#include <taut/impl/files/gltf/scene.hpp>

namespace taut::io::impl
{

/// Walks from the roots of the nodes to those that draw meshes.
class gltf_scenes
{
public:
    explicit gltf_scenes(const gltf_source& source)
        : source_(source), count_(root_of(source).items("nodes").size()), allowance_(source, 1)
    {
        find_children();
        place_nodes();
    }

    std::vector<gltf_draw> draws()
    {
        const auto shown = shown_nodes();
        std::vector<gltf_draw> result;
        for (std::size_t n = 0; n < count_; ++n)
        {
            const gltf_object object = node(n);
            if (!shown[n] || !object.find("mesh")) continue;
            gltf_draw draw{.node = n, .mesh = object.whole("mesh"), .place = place_of(object, n)};
            item_of(source_, "meshes", draw.mesh); // is there
            draw.least = draw.place.scale();
            if (const gltf_json* const attributes =
                    find_in(source_.document["nodes"][n], {"extensions", "EXT_mesh_gpu_instancing", "attributes"}))
                take_instances(draw, gltf_object(*attributes, object.name() + ", its instances,", source_.path));
            if (draw.instances > 0) result.push_back(draw);
        }
        return result;
    }

private:
    gltf_object node(std::size_t n) const { return item_of(source_, "nodes", n); }

    void find_children()
    {
        children_.resize(count_);
        has_parent_.assign(count_, 0);
        for (std::size_t n = 0; n < count_; ++n)
        {
            const gltf_object object = node(n);
            for (const gltf_json& item : object.items("children"))
            {
                const std::size_t child = object.whole(item, "child");
                const gltf_object below = node(child);
                if (has_parent_[child]) below.fail("is a child of two nodes; give each node one parent");
                has_parent_[child] = 1;
                children_[n].push_back(child);
            }
        }
    }

    /// Calls f with each node that is reached from these, parents first, and its children.
    template <class F>
    void walk(std::vector<std::size_t> from, F f) const
    {
        while (!from.empty())
        {
            const std::size_t n = from.back();
            from.pop_back();
            if (f(n)) from.insert(from.end(), children_[n].begin(), children_[n].end());
        }
    }

    void place_nodes()
    {
        std::vector<std::size_t> roots;
        for (std::size_t n = 0; n < count_; ++n)
            if (!has_parent_[n]) roots.push_back(n);
        places_.resize(count_);
        std::vector<char> reached(count_, 0);
        walk(roots,
             [&](std::size_t n)
             {
                 reached[n] = 1;
                 places_[n] = places_[n] * own_transform(node(n));
                 for (const std::size_t child : children_[n]) places_[child] = places_[n];
                 return true;
             });
        for (std::size_t n = 0; n < count_; ++n)
            if (!reached[n]) node(n).fail("is below itself; take it out of the children of the nodes below it");
    }

    std::vector<char> shown_nodes() const
    {
        const gltf_json& scenes = root_of(source_).items("scenes");
        std::vector<char> shown(count_, scenes.empty() ? 1 : 0);
        for (std::size_t s = 0; s < scenes.size(); ++s)
        {
            const gltf_object scene = item_of(source_, "scenes", s);
            std::vector<std::size_t> roots;
            for (const gltf_json& item : scene.items("nodes"))
            {
                roots.push_back(scene.whole(item, "node"));
                node(roots.back()); // is there
            }
            walk(roots, [&](std::size_t n) { return std::exchange(shown[n], 1) == 0; });
        }
        return shown;
    }

    /// Numbers of a member; nothing where there is none.
    static std::optional<std::vector<double>> numbers(const gltf_object& object, const char* key, std::size_t count)
    {
        const gltf_json* const list = object.find(key);
        if (!list) return {};
        std::vector<double> result;
        if (list->is_array())
            for (const gltf_json& x : *list)
                if (x.is_number()) result.push_back(x.get<double>());
        if (result.size() != count || list->size() != count)
            object.fail("has a " + std::string(key) + " that is not " + std::to_string(count) + " numbers");
        return result;
    }

    static gltf_transform own_transform(const gltf_object& object)
    {
        if (const auto m = numbers(object, "matrix", 16)) return of_columns(m->data());
        const auto t = numbers(object, "translation", 3), r = numbers(object, "rotation", 4),
                   s = numbers(object, "scale", 3);
        const auto vector = [](const auto& x, double otherwise)
        { return x ? vec3((*x)[0], (*x)[1], (*x)[2]) : vec3(otherwise); };
        return composed(vector(t, 0), r ? r->data() : nullptr, vector(s, 1), object);
    }

    static gltf_transform of_columns(const double* m)
    {
        gltf_transform place;
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) place.linear[c][r] = m[4 * c + r];
        place.shift = {m[12], m[13], m[14]};
        return place;
    }

    /// rotation: a quaternion, its real part last; null: none
    static gltf_transform composed(const vec3& translation, const double* rotation, const vec3& scale,
                                   const gltf_object& object)
    {
        gltf_transform place{mat3(1.0), translation};
        if (rotation)
        {
            const vec3 v(rotation[0], rotation[1], rotation[2]);
            const double w = rotation[3], square = glm::dot(v, v) + w * w;
            if (!(square > 0 && square < 1e200)) object.fail("has a rotation that is no unit quaternion");
            for (int k = 0; k < 3; ++k)
            {
                vec3 e(0.0);
                e[k] = 1;
                place.linear[k] = e + 2 / square * glm::cross(v, glm::cross(v, e) + w * e);
            }
        }
        for (int k = 0; k < 3; ++k) place.linear[k] *= scale[k];
        return place;
    }

    /// From the mesh of a node to the scene.
    gltf_transform place_of(const gltf_object& object, std::size_t n)
    {
        if (!object.find("skin")) return places_[n];
        const gltf_object skin = item_of(source_, "skins", object.whole("skin"));
        const gltf_json& joints = skin.items("joints");
        if (joints.empty()) skin.fail("has no joints; give it one, or leave out the skin");
        const std::size_t joint = skin.whole(joints[0], "joint");
        node(joint); // is there
        if (!skin.find("inverseBindMatrices")) return places_[joint];
        const auto inverse = elements(skin.whole("inverseBindMatrices"), "MAT4", skin);
        if (inverse.size() < 16) skin.fail("has no inverseBindMatrices; give one for each joint");
        return places_[joint] * of_columns(inverse.data());
    }

    std::vector<double> elements(std::size_t number, const char* type, const gltf_object& owner)
    {
        const gltf_accessor a = accessor_of(source_, number);
        if (a.type != type)
            owner.fail("names accessor " + std::to_string(number) + ", which is no " + type + "; name one that is");
        allowance_.take(a.count, "elements");
        const std::string bytes = all_elements(source_, a, "accessor " + std::to_string(number));
        std::vector<double> result(bytes.size() / size_of(a.component));
        for (std::size_t k = 0; k < result.size(); ++k) result[k] = load_number(bytes, a, k);
        return result;
    }

    /// Takes the largest one for the place.
    void take_instances(gltf_draw& draw, const gltf_object& attributes)
    {
        std::optional<std::size_t> count;
        const auto list = [&](const char* key, const char* type, std::size_t numbers)
        {
            std::vector<double> result;
            if (!attributes.find(key)) return result;
            result = elements(attributes.whole(key), type, attributes);
            if (count.value_or(result.size() / numbers) != result.size() / numbers)
                attributes.fail("are of different counts: " + std::string(key) + "; give each one per instance");
            count = result.size() / numbers;
            return result;
        };
        const auto translations = list("TRANSLATION", "VEC3", 3), rotations = list("ROTATION", "VEC4", 4),
                   scales = list("SCALE", "VEC3", 3);
        if (!count) return;
        const gltf_transform of_node = draw.place;
        draw.instances = *count;
        const auto vector = [](const std::vector<double>& all, std::size_t i, double otherwise)
        { return all.empty() ? vec3(otherwise) : vec3(all[3 * i], all[3 * i + 1], all[3 * i + 2]); };
        draw.least = std::numeric_limits<double>::infinity();
        double most = -1;
        for (std::size_t i = 0; i < *count; ++i)
        {
            const gltf_transform place =
                of_node * composed(vector(translations, i, 0), rotations.empty() ? nullptr : &rotations[4 * i],
                                   vector(scales, i, 1), attributes);
            draw.least = std::min(draw.least, place.scale());
            if (!(place.scale() > most)) continue;
            most = place.scale();
            draw.place = place;
        }
    }

    const gltf_source& source_;
    std::size_t count_;
    gltf_allowance allowance_; // of elements
    std::vector<std::vector<std::size_t>> children_;
    std::vector<char> has_parent_;
    std::vector<gltf_transform> places_; // in the scene
};

std::vector<gltf_draw> drawn_meshes(const gltf_source& source)
{
    return gltf_scenes(source).draws();
}

std::vector<gltf_copy> copied_triangles(const gltf_source& source)
{
    const gltf_primitives primitives = primitives_of(source);
    std::vector<gltf_copy> result;
    for (const gltf_primitive& p : primitives.all)
        if (p.copy_of)
        {
            const gltf_primitive& own = primitives.drawn_by(p);
            result.push_back({own.first, own.count, own.mesh, p.mesh, p.material});
        }
    return result;
}

void part_meshes(gltf_source& source, std::span<const gltf_draw> draws)
{
    source.apart = true;
    std::size_t left = std::size_t(1) << 26; // bytes of JSON
    gltf_json& meshes = source.document["meshes"];
    std::vector<char> is_drawn(meshes.size(), 0);
    for (const gltf_draw& draw : draws)
    {
        if (std::exchange(is_drawn[draw.mesh], 1) == 0) continue;
        gltf_json copy = meshes[draw.mesh];
        const std::size_t size = copy.dump().size();
        if (size > left)
            throw io_error(source.path,
                           "too many nodes draw the same meshes for a copy each; draw fewer, or split the scene");
        left -= size;
        source.document["nodes"][draw.node]["mesh"] = meshes.size();
        meshes.push_back(std::move(copy));
    }
}

} // namespace taut::io::impl
