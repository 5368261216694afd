// SPDX-License-Identifier: MIT
#include "mpi/checkpoint.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>

#include <taut/impl/dist/deal.hpp>
#include <taut/impl/dist/file/open_volume.hpp>
#include <taut/impl/io/read_volume.hpp>
#include <taut/impl/io/write_volume.hpp>

#include "shared/failure.hpp"
#include "shared/writing.hpp"

namespace taut::tools::mpi
{

namespace
{

struct placed
{
    std::int64_t id;
    vec3 x;
};

} // namespace

std::vector<vec3> checkpoint::read() const
{
    const std::string& path = options_.checkpoint;
    std::error_code unknown;
    if (path.empty() || !all_.shared(static_cast<int>(std::filesystem::exists(path, unknown)))) return {};
    const auto refuse = [&]
    {
        throw unsuitable_input(path + ": a checkpoint of another mesh, by its number of vertices; remove it, or name "
                                      "another file");
    };
    if (!volume_)
    {
        std::vector<vec3> x;
        all_.together(
            [&]
            {
                if (all_.rank() != 0) return;
                x = io::read_volume_file(path).points;
                if (x.size() != file_->points.size()) refuse();
            });
        return dist::impl::spread(all_, x);
    }
    std::vector<placed> mine;
    std::int64_t vertices = 0;
    try
    {
        const auto found = dist::impl::open_volume(all_, path);
        vertices = found->vertices;
        for (std::size_t v = 0; v < found->piece.ids.size(); ++v)
            mine.push_back({found->piece.ids[v], found->piece.points[v]});
    }
    catch (const dist::impl::unsuited& e)
    {
        throw io::io_error(path, std::string("cannot be read as a checkpoint: ") + e.what());
    }
    if (vertices != volume_->vertices) refuse();
    std::vector<vec3> x(volume_->piece.ids.size());
    for (const auto& p : volume_->sent_home(mine)) x[static_cast<std::size_t>(p.id - volume_->first())] = p.x;
    return x;
}

dist::result<tetrahedron> checkpoint::solve(dist::session<tetrahedron>& session,
                                            const std::function<run_limits()>& limits_left) const
{
    if (options_.checkpoint.empty()) return session.solve(limits_left());
    using seconds = std::chrono::duration<double>;
    double interval = options_.checkpoint_interval;
    int steps = 0, products = 0;
    double energy = 0, gradient = 0;
    for (;;)
    {
        auto limits = limits_left();
        const bool last = !(interval < limits.time_limit.count());
        bool refused = false;
        if (!last) limits.time_limit = seconds(interval);
        const auto observer = std::exchange(limits.observer, {});
        limits.observer = [&](const progress& p)
        {
            const bool go_on = !observer || observer(p);
            refused = refused || !go_on;
            return go_on;
        };
        auto found = session.solve(limits);
        if (found.report.steps == 0) // too short for anything
        {
            interval *= 2;
            found.report.energy = energy;
            found.report.gradient = gradient;
        }
        energy = found.report.energy;
        gradient = found.report.gradient;
        found.report.steps += std::exchange(steps, steps + found.report.steps);
        found.report.products += std::exchange(products, products + found.report.products);
        const bool by_interval = !all_.any(last || refused);
        if (!by_interval || !found.report.stopped || !found.report.flips) return found;
        write(found.x);
    }
}

void checkpoint::write(const std::vector<vec3>& x) const
{
    if (volume_)
    {
        dist::impl::ranged_volume::outputs files;
        writing([&] { files = volume_->write(options_.checkpoint, x); });
        return all_.together(
            [&]
            {
                if (all_.rank() == 0)
                    for (const auto& file : files) writing([&] { file->commit(); });
            });
    }
    const auto whole = dist::impl::collected(all_, x);
    all_.together(
        [&]
        {
            if (all_.rank() == 0) writing([&] { io::write_volume(options_.checkpoint, *file_, whole); });
        });
}

void checkpoint::remove() const
{
    std::error_code unknown;
    if (all_.rank() == 0 && !options_.checkpoint.empty()) std::filesystem::remove(options_.checkpoint, unknown);
}

} // namespace taut::tools::mpi
