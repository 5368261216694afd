// SPDX-License-Identifier: MIT
#pragma once

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

/// A tiny checker of what an SVG needs to be read at all. Returns "" or the first fault found.
inline std::string xml_fault(std::string_view text)
{
    std::vector<std::string> open;
    std::size_t roots = 0;
    const auto entity_ok = [](std::string_view rest)
    {
        for (const std::string_view e : {"&amp;", "&lt;", "&gt;", "&quot;", "&apos;"})
            if (rest.substr(0, e.size()) == e) return true;
        return false;
    };
    for (std::size_t at = 0; at < text.size();)
    {
        if (text[at] != '<')
        {
            if (text[at] == '&' && !entity_ok(text.substr(at))) return "bare &";
            if (text[at] == '>') return "bare >";
            if (open.empty() && std::isspace(static_cast<unsigned char>(text[at])) == 0) return "text outside the root";
            if (static_cast<unsigned char>(text[at]) < 32 && text[at] != '\n') return "control character";
            ++at;
            continue;
        }
        const std::size_t end = text.find('>', at);
        if (end == std::string_view::npos) return "unclosed tag";
        std::string_view tag = text.substr(at + 1, end - at - 1);
        at = end + 1;
        if (tag.empty() || tag.find('<') != std::string_view::npos) return "broken tag";
        if (tag.front() == '/')
        {
            if (open.empty() || open.back() != tag.substr(1)) return "unbalanced </" + std::string(tag.substr(1)) + ">";
            open.pop_back();
            continue;
        }
        const bool empty = tag.back() == '/';
        if (empty) tag.remove_suffix(1);
        std::size_t p = 0;
        while (p < tag.size() && tag[p] != ' ') ++p;
        const std::string name(tag.substr(0, p));
        if (open.empty() && ++roots > 1) return "two roots";
        // Attributes: name="value", each name once.
        std::vector<std::string> names;
        while (p < tag.size())
        {
            if (tag[p] != ' ') return "no blank before an attribute of " + name;
            const std::size_t equals = tag.find("=\"", ++p);
            if (equals == std::string_view::npos) return "attribute without a value in " + name;
            const std::size_t close = tag.find('"', equals + 2);
            if (close == std::string_view::npos) return "unclosed attribute in " + name;
            for (const std::string& n : names)
                if (n == tag.substr(p, equals - p)) return "attribute twice: " + n;
            names.emplace_back(tag.substr(p, equals - p));
            p = close + 1;
        }
        if (!empty) open.push_back(name);
    }
    if (!open.empty()) return "not closed: " + open.back();
    return roots == 1 ? "" : "no root";
}
