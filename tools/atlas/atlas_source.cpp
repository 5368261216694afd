// SPDX-License-Identifier: MIT
#include "atlas_source.hpp"

#include <numeric>
#include <optional>
#include <utility>

#include <taut/io/write_obj.hpp>
#include <taut/repair/repair_surface.hpp>

namespace taut::tools
{

namespace
{

/// OBJ, OFF, PLY or STL; written as OBJ.
class surface_source : public atlas_source
{
public:
    surface_source(io::surface_soup file, mesh<triangle> surface) : file_(std::move(file)), whole_(std::move(surface))
    {
        describe();
    }
    surface_source(io::surface_soup file, repaired_surface repaired)
        : file_(std::move(file)), repaired_(std::move(repaired))
    {
        describe();
    }

    const mesh<triangle>& surface() const override { return repaired_ ? repaired_->surface : *whole_; }

    idx vertex_origin(idx v) const override
    {
        return repaired_ ? repaired_->vertex_origins[static_cast<std::size_t>(v)] : v;
    }

    std::vector<std::array<vec2, 3>> texcoords() const override
    {
        if (file_.texcoords.empty()) return {};
        std::vector<std::array<vec2, 3>> result(surface().cells().size());
        for (std::size_t c = 0; c < result.size(); ++c)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const auto [cell, corner] = origin(c, k);
                const idx t = file_.texcoord_cells[cell][corner];
                if (t < 0) return {};
                result[c][k] = file_.texcoords[static_cast<std::size_t>(t)];
            }
        return result;
    }

    void write(io::atomic_file& out, const corner_map& map) const override
    {
        std::vector<idx> texcoords(file_.faces.corners.size(), -1);
        for (std::size_t c = 0; c < map.cells.size(); ++c)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const auto [cell, corner] = origin(c, k);
                texcoords[file_.faces.corner(cell, corner)] = map.cells[c][k];
            }
        io::write_obj(out, file_, texcoords, map.uv);
    }

private:
    void describe()
    {
        file_vertices = static_cast<idx>(file_.points.size());
        file_triangles = static_cast<idx>(file_.triangles.size());
        notes = file_.notes;
    }

    /// The triangle of the file and the corner of it.
    std::pair<std::size_t, std::size_t> origin(std::size_t c, std::size_t k) const
    {
        if (!repaired_) return {c, k};
        return {static_cast<std::size_t>(repaired_->cell_origins[c]), repaired_->corner_origin(c, k)};
    }

    io::surface_soup file_;
    std::optional<mesh<triangle>> whole_;      // of the file as it is,
    std::optional<repaired_surface> repaired_; // or this
};

} // namespace

std::unique_ptr<atlas_source> open_atlas_source(const std::string& path, const source_options& options)
{
    auto soup = io::read_surface_soup(path, options.format);
    if (options.repair)
    {
        auto repaired = repair_surface(soup.points, soup.triangles);
        return std::make_unique<surface_source>(std::move(soup), std::move(repaired));
    }
    if (soup.fault) throw mesh_error(*soup.fault);
    mesh<triangle> surface(soup.points, soup.triangles);
    return std::make_unique<surface_source>(std::move(soup), std::move(surface));
}

} // namespace taut::tools
