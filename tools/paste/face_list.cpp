// SPDX-License-Identifier: MIT
#include "paste/face_list.hpp"

#include <charconv>
#include <cstddef>
#include <system_error>

#include <taut/impl/files/file/read_file.hpp>

namespace taut::tools
{

std::vector<idx> parse_faces(std::string_view text, const std::string& path)
{
    std::vector<idx> faces;
    std::size_t line = 1;
    for (const char *at = text.data(), *const end = at + text.size(); at != end;)
    {
        if (*at == '#')
            while (at != end && *at != '\n') ++at;
        else if (*at == '\n' || *at == ' ' || *at == '\t' || *at == '\r' || *at == ',')
            line += *at++ == '\n' ? 1 : 0;
        else
        {
            idx face = 0;
            const auto [next, error] = std::from_chars(at, end, face);
            if (error != std::errc{})
                throw io::io_error(path, "line " + std::to_string(line) + ": no number of a face; write them from 0");
            faces.push_back(face);
            at = next;
        }
    }
    return faces;
}

std::vector<idx> read_faces(const std::string& path)
{
    return parse_faces(io::impl::read_file(path), path);
}

} // namespace taut::tools
