// SPDX-License-Identifier: MIT
#pragma once

#include <taut/dist.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/dist/ranges/open_volume.ipp>
#include <taut/impl/dist/ranges/piece_shapes.hpp>
#include <taut/impl/dist/ranges/whole_volume.hpp>

namespace taut::dist
{

volume_pieces::volume_pieces(MPI_Comm comm, const std::filesystem::path& path)
{
    const impl::communicator all(comm);
    all.guarded(
        [&]
        {
            try
            {
                volume_ = impl::open_volume(all, path);
                const auto corners = volume_->at_corners(volume_->piece.points);
                if (!volume_->partitioned && !(impl::piece_shapes(all, volume_->piece, corners).worst.mean_ratio > 0))
                    throw impl::unsuited("cells are inverted or flat");
            }
            catch (const impl::unsuited& e)
            {
                read_whole_ = e.what();
                volume_ = std::make_unique<impl::whole_volume>(all, path);
            }
        });
}
volume_pieces::~volume_pieces() = default;
volume_pieces::volume_pieces(volume_pieces&&) noexcept = default;
volume_pieces& volume_pieces::operator=(volume_pieces&&) noexcept = default;

const mesh_piece<tetrahedron>& volume_pieces::piece() const
{
    return volume_->piece;
}

const vec3& volume_pieces::point(std::int64_t id) const
{
    return volume_->piece.points[static_cast<std::size_t>(id - volume_->first())];
}

std::vector<std::string> volume_pieces::groups() const
{
    std::vector<std::string> names;
    for (const auto& g : volume_->groups) names.push_back(g.name);
    return names;
}

std::vector<std::int64_t> volume_pieces::members(const std::string& group) const
{
    io::volume_file names; // of the groups alone
    for (const auto& g : volume_->groups) names.groups.push_back({g.name, g.dimension, {}});
    std::vector<std::int64_t> found;
    volume_->processes().guarded(
        [&] { found = volume_->members(static_cast<std::size_t>(&names.find_group(group) - names.groups.data())); });
    return found;
}

void volume_pieces::write(const std::filesystem::path& path, const std::vector<vec3>& x) const
{
    const auto& all = volume_->processes();
    all.together(
        [&]
        {
            if (x.size() != volume_->piece.points.size())
                throw parameter_error("x", std::to_string(x.size()) + " positions for " +
                                               std::to_string(volume_->piece.points.size()) + " vertices of the piece");
        });
    all.guarded([&] { volume_->commit(volume_->write(path, x)); });
}

report deform(MPI_Comm comm, const std::filesystem::path& input, const std::filesystem::path& output,
              const deform_params<tetrahedron>& params, const std::vector<std::string>& fixed, const run_limits& limits)
{
    const volume_pieces volume(comm, input);
    auto how = params;
    for (const auto& group : fixed)
        for (const std::int64_t v : volume.members(group)) how.constraints.pin(v, volume.point(v));
    auto found = session<tetrahedron>(comm, volume.piece(), how).solve(limits);
    if (found) volume.write(output, found.x);
    return std::move(found.report);
}

} // namespace taut::dist
