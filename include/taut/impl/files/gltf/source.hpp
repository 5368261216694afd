// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/files/gltf/json.hpp>

namespace taut::io::impl
{

/// A glTF file as it is, for those who write it again.
struct gltf_source
{
    std::string path;                           ///< of the file, named in errors; URIs are relative to its folder
    gltf_json document;                         ///< all of the JSON, members in their order
    std::vector<std::string> buffers = {};      ///< the bytes of each; none of those that no bufferView names
    std::vector<std::string> more_chunks = {};  ///< of GLB behind JSON and BIN, with their heads
    bool data_uris = false;                     ///< whether all buffers are data URIs
    std::set<std::filesystem::path> files = {}; ///< that buffers were read from
    bool apart = false;                         ///< meshes that share triangles have their own texture coordinates
};

/// An object of a document, and what messages call it.
class gltf_object
{
public:
    /// Throws io_error if the value is no object.
    gltf_object(const gltf_json& value, std::string name, const std::string& path)
        : value_(value), name_(std::move(name)), path_(path)
    {
        if (!value.is_object()) fail("is no JSON object; write it in braces");
    }

    const std::string& name() const { return name_; }
    [[noreturn]] void fail(const std::string& what) const { throw io_error(path_, name_ + ' ' + what); }

    /// Null if there is none.
    const gltf_json* find(const char* key) const
    {
        const auto at = value_.find(key);
        return at == value_.end() ? nullptr : &*at;
    }

    /// A whole number >= 0. Throws io_error.
    std::size_t whole(const char* key) const
    {
        const gltf_json* const x = find(key);
        if (!x) fail("has no " + std::string(key));
        return whole(*x, key);
    }
    std::size_t whole(const char* key, std::size_t otherwise) const
    {
        const gltf_json* const x = find(key);
        return x ? whole(*x, key) : otherwise;
    }
    std::size_t whole(const gltf_json& x, const std::string& key) const
    {
        constexpr std::int64_t most = std::int64_t(1) << 53; // of whole numbers in JSON
        const std::int64_t value = x.is_number_integer() ? x.get<std::int64_t>() : -1;
        if (value < 0 || value > most) fail("has a " + key + " that is no whole number; give one from 0");
        return static_cast<std::size_t>(value);
    }

    /// Throws io_error if there is none or if it is no text.
    const std::string& text(const char* key) const
    {
        const gltf_json* const x = find(key);
        if (!x || !x->is_string()) fail("has no " + std::string(key));
        return x->get_ref<const std::string&>();
    }

    gltf_object object(const char* key) const
    {
        const gltf_json* const x = find(key);
        if (!x) fail("has no " + std::string(key));
        return {*x, name_ + '.' + key, path_};
    }

    /// The items of an array; none if there is none. Throws io_error if it is no array.
    const gltf_json& items(const char* key) const
    {
        static const gltf_json nothing = gltf_json::array();
        const gltf_json* const x = find(key);
        if (x && !x->is_array()) fail("has " + std::string(key) + " that are no array; write them in brackets");
        return x ? *x : nothing;
    }

private:
    const gltf_json& value_;
    std::string name_;
    const std::string& path_;
};

inline gltf_object root_of(const gltf_source& source)
{
    return {source.document, "the document", source.path};
}

/// Item i of a list of the document. Throws io_error if there is none.
inline gltf_object item_of(const gltf_source& source, const char* list, std::size_t i)
{
    const gltf_json& items = root_of(source).items(list);
    if (i >= items.size())
        throw io_error(source.path, std::string(list) + ' ' + std::to_string(i) + " is named, but there are " +
                                        std::to_string(items.size()) + ", counted from 0; name one that is there");
    return {items[i], std::string(list) + ' ' + std::to_string(i), source.path};
}

/// A member of a member ...; null where it is not there, or no object on the way to it.
inline const gltf_json* find_in(const gltf_json& value, std::initializer_list<const char*> keys)
{
    const gltf_json* at = &value;
    for (const char* const key : keys)
    {
        if (!at->is_object()) return nullptr;
        const auto found = at->find(key);
        if (found == at->end()) return nullptr;
        at = &*found;
    }
    return at;
}

/// Limit of the memory made of a file: a small one may reference the same bytes repeatedly, or elements without data.
class gltf_allowance
{
public:
    /// times: what a byte of the buffers allows
    gltf_allowance(const gltf_source& source, std::size_t times) : path_(source.path), left_(std::size_t(1) << 16)
    {
        for (const std::string& buffer : source.buffers) left_ += buffer.size();
        left_ *= times;
    }

    /// Throws io_error where it is used up. what: "vertices"
    void take(std::size_t n, const char* what)
    {
        if (n > left_)
            throw io_error(path_, "more " + std::string(what) + " than the bytes of its buffers can stand for: " +
                                      "accessors share bytes, or have none; give each its own");
        left_ -= n;
    }

private:
    const std::string& path_;
    std::size_t left_;
};

/// Returns whether brackets are nested deeper than in any glTF.
inline bool is_deep(std::string_view text)
{
    constexpr int deepest = 256; // a document is walked through recursively
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i)
        if (quoted)
        {
            if (text[i] == '\\')
                ++i;
            else
                quoted = text[i] != '"';
        }
        else if (text[i] == '"')
            quoted = true;
        else if (text[i] == '[' || text[i] == '{')
        {
            if (++depth > deepest) return true;
        }
        else if (text[i] == ']' || text[i] == '}')
            --depth;
    return false;
}

/// Throws io_error for what is no JSON, or is nested too deep.
inline gltf_json parse_gltf_json(std::string_view text, const std::string& path)
{
    if (text.empty()) throw io_error(path, "the file is empty; export the model again");
    if (is_deep(text)) throw io_error(path, "JSON that is nested too deep; no model needs that, export it again");
    try
    {
        // With a callback it would look through lists again and again.
        return gltf_json::parse(text.begin(), text.end());
    }
    catch (const gltf_json::exception& e)
    {
        const std::string what = e.what();
        throw io_error(path, "no JSON of glTF: " + what.substr(std::min(what.find("] ") + 2, what.size())));
    }
}

} // namespace taut::io::impl
