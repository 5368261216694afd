// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <taut/dist.hpp>
#include <taut/impl/files/volume/formats.hpp>

#include "mpi/case_folder.hpp"
#include "mpi/piece_turns.hpp"
#include "mpi/shape_source.hpp"
#include "shared/companions.hpp"
#include "shared/failure.hpp"
#include "shared/writing.hpp"

namespace taut::tools::mpi
{

/// A mesh file with the shape so far, which a later run begins with. All functions are collective.
template <class Element>
class checkpoint
{
public:
    using points = typename shape_source<Element>::points;

    /// All are referred to.
    checkpoint(const dist::impl::communicator& all, const mpi_options& options, const shape_source<Element>& source)
        : all_(all), options_(options), source_(source)
    {
    }

    /// The shape that is there; nothing where there is none. Throws unsuitable_input where that is another mesh,
    /// io_error.
    points read() const
    {
        std::error_code unknown;
        const std::string& path = options_.checkpoint;
        if (path.empty()) return {};
        all_.together(
            [&]
            {
                if (all_.rank() == 0) require_kind();
            });
        if (!all_.shared(static_cast<int>(std::filesystem::exists(path, unknown)))) return {};
        return source_.read(path);
    }

    /// Brings a session to its end as solve() does, and writes the shape each time that the interval is over.
    dist::result<Element> solve(dist::session<Element>& session, const std::function<run_limits()>& limits_left) const
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
            limits.observer = [&](const taut::progress& p)
            {
                const bool go_on = !observer || observer(p);
                refused = refused || !go_on;
                return go_on;
            };
            auto found = session.solve(limits);
            if (found.report.steps == 0 && found.report.stopped) // too short for anything
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

    /// After the result is written: the files that runs have written, those of one that was killed, too.
    void remove() const
    {
        if (options_.checkpoint.empty()) return;
        std::vector<std::string> left;
        if (is_in_pieces())
            for (const auto& turn : piece_turns(options_.checkpoint).turns())
                for (auto& file : source_.files_at(turn.string())) left.push_back(std::move(file));
        if (all_.rank() != 0) return;
        std::error_code unknown;
        const std::filesystem::path path = options_.checkpoint;
        if (is_case())
            for (const auto& folder : {named(), unfinished()}) listed_folder(folder).remove();
        else if (is_in_pieces())
        {
            piece_turns(path).remove();
            remove_files(left);
        }
        else
            for (const auto& file : written_as(path, options_.shape.input)) std::filesystem::remove(file, unknown);
    }

private:
    bool is_in_pieces() const { return io::impl::small_extension(options_.checkpoint) == ".pvtu"; }

    /// Whether it is a folder, as the input.
    bool is_case() const
    {
        std::error_code unknown;
        return std::filesystem::is_directory(options_.shape.input, unknown);
    }

    /// Throws usage_error where one is a folder and the other is not.
    void require_kind() const
    {
        std::error_code unknown;
        const std::string& path = options_.checkpoint;
        if (std::filesystem::exists(path, unknown) && std::filesystem::is_directory(path, unknown) != is_case())
            throw usage_error(
                "--checkpoint " + path +
                (is_case() ? ": is a file, and the mesh is a folder; name another" : ": is a folder; name a file"));
    }

    /// All pieces of what has the name are of one time.
    void write(const points& x) const
    {
        const auto by_first = [&](const auto& body)
        {
            all_.together(
                [&]
                {
                    if (all_.rank() == 0) writing(body);
                });
        };
        if (is_case())
        {
            const listed_folder made(unfinished());
            auto files = source_.files_at(unfinished().string());
            for (auto& file : files) file = std::filesystem::path(file).lexically_relative(unfinished()).string();
            by_first(
                [&]
                {
                    made.remove(); // of a run that was killed
                    made.make(files);
                });
            source_.write(unfinished().string(), x);
            by_first([&] { made.rename_to(named()); });
        }
        else if (is_in_pieces())
        {
            const piece_turns turns(options_.checkpoint);
            const std::string made = all_.shared(turns.next().string());
            const auto left = source_.files_at(made);
            by_first([&] { remove_files(left); }); // of a run that was killed
            source_.write(made, x);
            by_first([&] { turns.replace(made); });
        }
        else
            source_.write(options_.checkpoint, x);
    }

    std::filesystem::path named() const
    {
        const std::filesystem::path path = options_.checkpoint;
        return path.has_filename() ? path : path.parent_path();
    }
    std::filesystem::path unfinished() const
    {
        return named().parent_path() / ('.' + named().filename().string() + ".taut-checkpoint");
    }

    const dist::impl::communicator& all_;
    const mpi_options& options_;
    const shape_source<Element>& source_;
};

} // namespace taut::tools::mpi
