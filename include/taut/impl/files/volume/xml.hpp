// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace taut::io::impl
{

/// A tag of an XML text, of which it is a view.
struct xml_tag
{
    std::string_view name; ///< with a slash before it where it ends an element
    std::string_view attributes;
    std::size_t begin, end; ///< of its text, < and > included

    /// The value of an attribute, as it is written.
    std::optional<std::string_view> attribute(std::string_view key) const
    {
        constexpr std::string_view blank = " \t\r\n";
        std::string_view rest = attributes;
        for (;;)
        {
            const auto first = rest.find_first_not_of(blank);
            const auto equals = rest.find('=');
            if (first == rest.npos || equals == rest.npos || equals < first) return std::nullopt;
            std::string_view name_found = rest.substr(first, equals - first);
            name_found = name_found.substr(0, name_found.find_last_not_of(blank) + 1);
            const auto quote = rest.find_first_of("\"'", equals);
            if (quote == rest.npos) return std::nullopt;
            const auto close = rest.find(rest[quote], quote + 1);
            if (close == rest.npos) return std::nullopt;
            if (name_found == key) return rest.substr(quote + 1, close - quote - 1);
            rest.remove_prefix(close + 1);
        }
    }

    std::string_view attribute_or(std::string_view key, std::string_view otherwise) const
    {
        return attribute(key).value_or(otherwise);
    }
};

/// Tags of an XML text, one after the other; declarations and comments are passed over.
class xml_tags
{
public:
    explicit xml_tags(std::string_view text) : text_(text) {}

    std::optional<xml_tag> next()
    {
        for (;;)
        {
            const auto begin = text_.find('<', at_);
            if (begin == text_.npos) return std::nullopt;
            const bool comment = text_.substr(begin).starts_with("<!--");
            const auto close = comment ? text_.find("-->", begin) : end_of_tag(begin);
            if (close == text_.npos) return std::nullopt;
            at_ = close + (comment ? 3 : 1);
            std::string_view inside = text_.substr(begin + 1, close - begin - 1);
            if (comment || inside.starts_with('?') || inside.starts_with('!')) continue;
            if (inside.ends_with('/')) inside.remove_suffix(1);
            const auto name = inside.substr(0, inside.find_first_of(" \t\r\n"));
            return xml_tag{name, inside.substr(name.size()), begin, at_};
        }
    }

private:
    /// The > of a tag: none within quotes.
    std::size_t end_of_tag(std::size_t at) const
    {
        char quote = '\0';
        for (; at < text_.size(); ++at)
        {
            const char c = text_[at];
            if (quote != '\0')
                quote = c == quote ? '\0' : quote;
            else if (c == '"' || c == '\'')
                quote = c;
            else if (c == '>')
                return at;
        }
        return text_.npos;
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

/// Characters of XML's own, and the names that stand for them.
inline constexpr std::array<std::pair<char, std::string_view>, 5> xml_entities = {
    {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&apos;"}}};

/// What the value of an attribute stands for.
inline std::string from_xml(std::string_view value)
{
    std::string text;
    while (!value.empty())
    {
        const auto* const entity = std::find_if(xml_entities.begin(), xml_entities.end(),
                                                [&](const auto& e) { return value.starts_with(e.second); });
        const bool named = entity != xml_entities.end();
        text += named ? entity->first : value.front();
        value.remove_prefix(named ? entity->second.size() : 1);
    }
    return text;
}

/// A text as the value of an attribute.
inline std::string to_xml(std::string_view text)
{
    std::string value;
    for (const char c : text)
    {
        const auto* const entity =
            std::find_if(xml_entities.begin(), xml_entities.end(), [&](const auto& e) { return e.first == c; });
        value += entity != xml_entities.end() ? entity->second : std::string_view(&c, 1);
    }
    return value;
}

} // namespace taut::io::impl
