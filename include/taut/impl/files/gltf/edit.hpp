// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/files/gltf/primitives.hpp>

namespace taut::io::impl
{

/// Calls f with each "bufferView" of a value that is one; extras are ignored.
template <class Json, class F>
void for_each_view_reference(Json& value, F f)
{
    if (!value.is_structured()) return;
    for (auto item = value.begin(); item != value.end(); ++item)
    {
        if (value.is_object() && item.key() == "extras") continue;
        if (value.is_object() && item.key() == "bufferView" && item->is_number_integer())
            f(*item);
        else
            for_each_view_reference(*item, f);
    }
}

/// Number of references to each accessor from other than primitives: animations, skins, instances.
inline std::vector<std::size_t> other_uses(const gltf_source& source)
{
    std::vector<std::size_t> uses(root_of(source).items("accessors").size());
    const auto use = [&](const gltf_json& x)
    {
        if (x.is_number_integer() && x.get<std::size_t>() < uses.size()) ++uses[x.get<std::size_t>()];
    };
    const auto use_member = [&](const gltf_json& object, const char* key)
    {
        if (object.is_object() && object.contains(key)) use(object[key]);
    };
    const gltf_object root = root_of(source);
    for (const gltf_json& animation : root.items("animations"))
        for (const gltf_json& sampler : gltf_object(animation, "an animation", source.path).items("samplers"))
            for (const char* const key : {"input", "output"}) use_member(sampler, key);
    for (const gltf_json& skin : root.items("skins")) use_member(skin, "inverseBindMatrices");
    const auto instances = gltf_json::json_pointer("/extensions/EXT_mesh_gpu_instancing/attributes");
    for (const gltf_json& node : root.items("nodes"))
        if (node.contains(instances))
            for (const gltf_json& accessor : node[instances]) use(accessor);
    return uses;
}

/// A document with other accessors and bufferViews. What is new lies behind the old data; what nothing names any more
/// is taken out, and its number in the list of bufferViews is used again.
class gltf_edit
{
public:
    /// times: more new bytes than usual
    explicit gltf_edit(const gltf_source& source, std::size_t times = 1)
        : source_(source),
          document_(source.document),
          old_views_(root_of(source).items("bufferViews").size()),
          uses_(other_uses(source)),
          named_before_(views_named()),
          made_(source, 64 * times)
    {
    }

    gltf_json& document() { return document_; }
    std::vector<std::size_t>& uses() { return uses_; } ///< of each accessor; primitives are to be counted by the caller

    /// Counts bytes that are looked at or made. Throws io_error where they are too many for the bytes there are.
    void spend(std::size_t bytes) { made_.take(bytes, "new bytes"); }

    /// A new bufferView. like: an old one whose members it takes over, but for those that say where it lies.
    std::size_t add_view(std::string bytes, const gltf_json& members, const std::size_t* like = nullptr)
    {
        gltf_json view = like ? source_.document["bufferViews"][*like] : gltf_json::object();
        spend(bytes.size() + (like ? view.dump().size() : 0));
        view["buffer"] = 0;
        for (const char* const key : {"byteOffset", "byteStride"}) view.erase(key);
        view["byteLength"] = bytes.size();
        view.update(members);
        views_.push_back({std::move(view), std::move(bytes)});
        return old_views_ + views_.size() - 1;
    }

    /// A new bufferView of an image. Its bytes are not counted: they are made of others than those of the model.
    std::size_t add_image(std::string bytes)
    {
        views_.push_back({{{"buffer", 0}, {"byteLength", bytes.size()}}, std::move(bytes)});
        return old_views_ + views_.size() - 1;
    }

    /// Gives all who name an accessor another one: in its place if nobody else names it, else as a new one.
    /// refs: where the number of the accessor stands, the same in all; or `nothing`
    void put(std::span<std::size_t* const> refs, gltf_json accessor)
    {
        const std::size_t old = *refs[0];
        gltf_json& accessors = document_["accessors"];
        const bool in_place = old < uses_.size() && uses_[old] == refs.size();
        if (in_place)
            accessors[old] = std::move(accessor);
        else
        {
            spend(accessor.dump().size());
            accessors.push_back(std::move(accessor));
            if (old < uses_.size()) uses_[old] -= refs.size();
        }
        for (std::size_t* const ref : refs) *ref = in_place ? old : accessors.size() - 1;
    }

    static constexpr std::size_t nothing = SIZE_MAX;

    /// Lays out the buffer and completes the document. Returns the bytes of its only buffer.
    std::string finish()
    {
        const auto named = views_named();
        std::vector<char> unused(old_views_, 0);
        std::vector<std::size_t> numbers; // of the new bufferViews
        for (std::size_t v = 0; v < old_views_ && numbers.size() < views_.size(); ++v)
            if (named_before_[v] && !named[v])
            {
                unused[v] = 1;
                numbers.push_back(v);
            }
        for (std::size_t v = old_views_; numbers.size() < views_.size(); ++v) numbers.push_back(v);
        for (const char* const list : {"accessors", "images"})
            if (document_.contains(list))
                for_each_view_reference(document_[list],
                                        [&](gltf_json& v)
                                        {
                                            const auto i = v.get<std::size_t>() - old_views_; // of new ones
                                            if (i < numbers.size()) v = numbers[i];
                                        });
        std::string bytes = old_bytes(unused);
        add_new_views(numbers, bytes);
        if (bytes.empty()) return bytes;
        gltf_json buffer = source_.buffers.empty() ? gltf_json::object() : document_["buffers"][0];
        buffer.erase("uri");
        buffer["byteLength"] = bytes.size();
        document_["buffers"] = gltf_json::array({std::move(buffer)});
        return bytes;
    }

private:
    struct new_view
    {
        gltf_json members;
        std::string bytes;
    };
    struct range
    {
        std::size_t begin, end;
    };

    std::vector<char> views_named() const
    {
        std::vector<char> named(old_views_, 0);
        for_each_view_reference(document_,
                                [&](const gltf_json& v)
                                {
                                    const auto number = v.get<std::size_t>();
                                    if (number < named.size()) named[number] = 1;
                                });
        return named;
    }

    static void align(std::string& bytes) { bytes.append((8 - bytes.size() % 8) % 8, '\0'); }

    /// The old buffers one after the other, without what only unused views hold; moves the views that stay. What moves
    /// does so by multiples of 8 bytes.
    std::string old_bytes(const std::vector<char>& unused)
    {
        std::string bytes;
        std::vector<std::vector<std::size_t>> views(source_.buffers.size()); // of each
        for (std::size_t v = 0; v < old_views_; ++v)
            if (const std::size_t b = view(v).whole("buffer"); b < views.size()) views[b].push_back(v);
        for (std::size_t b = 0; b < source_.buffers.size(); ++b)
        {
            align(bytes);
            const std::size_t base = bytes.size();
            const std::string& old = source_.buffers[b];
            std::vector<range> gone = unused_ranges(views[b], unused, old.size());
            std::vector<std::size_t> removed{0}; // before each of them
            std::size_t at = 0;
            for (const range& r : gone)
            {
                bytes.append(old, at, r.begin - at);
                at = r.end;
                removed.push_back(removed.back() + r.end - r.begin);
            }
            bytes.append(old, at);
            for (const std::size_t v : views[b])
            {
                if (unused[v]) continue;
                const std::size_t offset = view(v).whole("byteOffset", 0);
                const auto before = std::upper_bound(gone.begin(), gone.end(), offset,
                                                     [](std::size_t x, const range& r) { return x < r.begin; });
                const std::size_t moved = base + offset - removed[static_cast<std::size_t>(before - gone.begin())];
                gltf_json& members = document_["bufferViews"][v];
                if (moved != offset) members["byteOffset"] = moved;
                if (b > 0) members["buffer"] = 0;
            }
        }
        return bytes;
    }

    /// Ranges of a buffer of this size that only unused views cover, in multiples of 8 bytes.
    std::vector<range> unused_ranges(const std::vector<std::size_t>& views, const std::vector<char>& unused,
                                     std::size_t size) const
    {
        struct step
        {
            std::size_t at;
            int kept, gone; // how many more begin here than end
        };
        std::vector<step> steps;
        for (const std::size_t v : views)
        {
            const std::size_t offset = view(v).whole("byteOffset", 0), length = view(v).whole("byteLength");
            const std::size_t begin = std::min(offset, size), end = std::min(offset + length, size);
            const int gone = unused[v] ? 1 : 0;
            steps.push_back({begin, 1 - gone, gone});
            steps.push_back({end, gone - 1, -gone});
        }
        std::sort(steps.begin(), steps.end(), [](const step& x, const step& y) { return x.at < y.at; });
        std::vector<range> ranges;
        int kept = 0, gone = 0;
        for (std::size_t i = 0; i + 1 < steps.size(); ++i)
        {
            kept += steps[i].kept;
            gone += steps[i].gone;
            const std::size_t length = (steps[i + 1].at - steps[i].at) / 8 * 8;
            if (kept == 0 && gone > 0 && length > 0) ranges.push_back({steps[i].at, steps[i].at + length});
        }
        return ranges;
    }

    void add_new_views(const std::vector<std::size_t>& numbers, std::string& bytes)
    {
        gltf_json& list = document_["bufferViews"];
        for (std::size_t i = 0; i < views_.size(); ++i)
        {
            align(bytes);
            views_[i].members["byteOffset"] = bytes.size();
            bytes += std::exchange(views_[i].bytes, {});
            if (numbers[i] < list.size())
                list[numbers[i]] = std::move(views_[i].members);
            else
                list.push_back(std::move(views_[i].members));
        }
    }

    gltf_object view(std::size_t v) const { return item_of(source_, "bufferViews", v); }

    const gltf_source& source_;
    gltf_json document_;
    std::size_t old_views_;
    std::vector<std::size_t> uses_;
    std::vector<char> named_before_;
    std::vector<new_view> views_;
    gltf_allowance made_;
};

} // namespace taut::io::impl
