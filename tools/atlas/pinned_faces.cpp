// SPDX-License-Identifier: MIT
#include "atlas/pinned_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>

#include "paste/face_list.hpp"
#include "shared/failure.hpp"

namespace taut::tools
{

std::vector<char> pinned_of(const atlas_source& source, const impl::facet_table& f, const std::string& path)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    auto named = read_faces(path);
    std::sort(named.begin(), named.end());
    named.erase(std::unique(named.begin(), named.end()), named.end());
    const auto face = source.file_faces();
    const auto uv = source.known_texcoords();
    const auto& cells = source.surface().cells();
    std::vector<char> pinned(cells.size(), 0), found(named.size(), 0);
    std::vector<idx> front;
    const auto pin = [&](idx c)
    {
        if (pinned[u(c)]) return;
        pinned[u(c)] = 1;
        front.push_back(c);
        for (const vec2& x : uv[u(c)])
            if (std::isnan(x.x))
                throw unsuitable_input(path + ": face " + std::to_string(face[u(c)]) +
                                       " has no texture coordinates (vt) to stay at; do not name it");
    };
    for (std::size_t c = 0; c < cells.size(); ++c)
        if (const auto at = std::lower_bound(named.begin(), named.end(), face[c]); at != named.end() && *at == face[c])
        {
            found[static_cast<std::size_t>(at - named.begin())] = 1;
            pin(static_cast<idx>(c));
        }
    if (const auto missing = std::find(found.begin(), found.end(), char(0)); missing != found.end())
        throw unsuitable_input(path + ": face " +
                               std::to_string(named[static_cast<std::size_t>(missing - found.begin())]) +
                               " is not there, or was left out; faces run from 0 in the order of the file");
    const auto torn = impl::seams_of_map(source.surface(), f, uv);
    while (!front.empty())
    {
        const idx c = front.back();
        front.pop_back();
        for (auto s = 3 * u(c); s < 3 * u(c) + 3; ++s)
            if (const idx t = f.twin[s]; t >= 0 && (!torn[s] || face[s / 3] == face[u(t) / 3])) pin(t / 3);
    }
    if (std::count(pinned.begin(), pinned.end(), char(0)) == 0)
        throw usage_error("--keep-charts " + path +
                          ": names a face of every chart, so that no chart is left to make; name "
                          "fewer, or pack all charts anew with --charts pack");
    return pinned;
}

} // namespace taut::tools
