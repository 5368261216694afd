// SPDX-License-Identifier: MIT
#include "view/subjects.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <taut/deform.hpp>
#include <taut/impl/files/volume/cell_faces.hpp>
#include <taut/parameterize.hpp>
#include <taut/shell.hpp>
#include <taut/surface_file.hpp>
#include <taut/volume_file.hpp>

#include "shared/failure.hpp"
#include "shared/seams.hpp"
#include "view/floats.hpp"
#include "view/session_subject.hpp"
#include "view/written.hpp"
#include "volume/volume_case.hpp"
#include "volume/written_shape.hpp"

namespace taut::view
{

namespace
{

using corners = std::array<std::uint32_t, 3>;

std::vector<corners> as_corners(const std::vector<std::array<idx, 3>>& cells)
{
    std::vector<corners> faces;
    faces.reserve(cells.size());
    for (const auto& c : cells)
        faces.push_back(
            {static_cast<std::uint32_t>(c[0]), static_cast<std::uint32_t>(c[1]), static_cast<std::uint32_t>(c[2])});
    return faces;
}

std::string base_name(const std::string& path)
{
    return std::filesystem::path(path).filename().string();
}

template <class Element>
taut::constraints<Element> pinned(const mesh<Element>& m, const std::vector<io::pin<Element::dimension>>& pins)
{
    taut::constraints<Element> c(m);
    c.add(pins);
    return c;
}

/// Opened surface file, cut open along its seams where needed. Not movable: a session refers to it.
struct opened_surface
{
    explicit opened_surface(const source& from)
        : file(io::read_surface_file(from.path, from.format)),
          cut(tools::cut_open(file, {.one_boundary = !from.holes}, false))
    {
        if (from.pins.empty()) return;
        const auto pins = io::read_pins<2>(from.pins, file.surface.vertex_count());
        if (cut) tools::require_undivided(pins, tools::divided_vertices(*cut));
        constraints = pinned(surface(), pins);
    }
    const mesh<triangle>& surface() const { return cut ? cut->surface : file.surface; }

    io::surface_file file;
    std::optional<io::cut_surface> cut;
    taut::constraints<triangle> constraints;
};

parameterize_params params_of(const opened_surface& in)
{
    parameterize_params p;
    p.constraints = in.constraints;
    return p;
}

class map_subject final : private opened_surface, public session_subject<triangle>
{
public:
    map_subject(queue& q, const source& from)
        : opened_surface(from),
          session_subject<triangle>(q, surface(),
                                    [&](observer ask)
                                    {
                                        return std::make_unique<session<triangle>>(
                                            q, surface(), params_of(*this), run_limits{.observer = std::move(ask)});
                                    }),
          name_(base_name(from.path)),
          faces_(as_corners(surface().cells()))
    {
    }

    view::model model() const override
    {
        return {2, showing::map, name_, as_floats(surface().points(), surface().points().front()), as_list(faces_)};
    }

    void start_afresh() override
    {
        parameterize_params p;
        p.constraints = all_held();
        auto result = parameterize(queue_, surface(), p);
        if (!result) throw error(result.reason());
        go_to(result.uv);
    }

    subject::saved write() const override
    {
        return {std::filesystem::path(name_).stem().string() + "-flat.obj", written(
                                                                                [&](const std::filesystem::path& path)
                                                                                {
                                                                                    if (cut)
                                                                                        io::write_obj(path, file, *cut,
                                                                                                      x());
                                                                                    else
                                                                                        io::write_obj(path, file, x());
                                                                                })};
    }

private:
    const std::vector<corners>& shown() const override { return faces_; }

    std::string name_;
    std::vector<corners> faces_;
};

/// Opened volume file, not movable.
template <class Element>
struct opened_volume
{
    opened_volume(io::volume_file f, const source& from) : file(std::move(f)), input(file)
    {
        if (!from.pins.empty()) constraints = pinned(input.simplices(), input.read_pins(from.pins));
    }

    deform_params<Element> params() const
    {
        deform_params<Element> p;
        p.constraints = constraints;
        p.owners = input.owners();
        if (input.parts().overlapping) p.data.weights = input.parts().weights;
        return p;
    }

    /// The skin, or all of a planar mesh.
    std::vector<corners> faces() const
    {
        std::vector<corners> list;
        if constexpr (Element::dimension == 2)
            list = as_corners(input.simplices().cells());
        else
        {
            const auto sides = file.faces();
            for (std::size_t f = 0; f < sides.faces.size(); ++f)
                if (sides.twin[f] < 0)
                {
                    const auto around = sides.faces[f].corners();
                    for (std::size_t k = 2; k < around.size(); ++k)
                        list.push_back({static_cast<std::uint32_t>(around[0]),
                                        static_cast<std::uint32_t>(around[k - 1]),
                                        static_cast<std::uint32_t>(around[k])});
                }
        }
        return list;
    }

    io::volume_file file;
    tools::volume_case<Element> input;
    taut::constraints<Element> constraints;
};

template <class Element>
class shape_subject final : private opened_volume<Element>, public session_subject<Element>
{
    using opened = opened_volume<Element>;
    using base = session_subject<Element>;
    using opened::input;

public:
    shape_subject(queue& q, io::volume_file f, const source& from)
        : opened(std::move(f), from),
          base(q, input.simplices(),
               [&](observer ask)
               {
                   return std::make_unique<session<Element>>(q, input.simplices(), opened::params(),
                                                             run_limits{.observer = std::move(ask)});
               }),
          name_(base_name(from.path)),
          faces_(opened::faces())
    {
    }

    view::model model() const override
    {
        return {static_cast<std::uint8_t>(Element::dimension), showing::shape, name_,
                as_floats(opened::file.points, opened::file.points.front()), as_list(faces_)};
    }

    void start_afresh() override
    {
        auto p = opened::params();
        p.constraints = base::all_held();
        auto result = deform(base::queue_, input.simplices(), p);
        if (!result) throw error(result.report.reason);
        base::go_to(result.x);
    }

    /// As `taut deform` does, to places that the file can hold.
    void pin(std::span<const place> pins) override
    {
        tools::held_by_file held(opened::file);
        std::vector<place> places(pins.begin(), pins.end());
        for (place& p : places)
            for (int k = 0; k < Element::dimension; ++k) p.x[k] = held(p.vertex, p.x[k]);
        base::pin(places);
    }

    subject::saved write() const override
    {
        const auto held = base::asked().held();
        const tools::written_shape<Element> written(input, base::x(),
                                                    [&](std::size_t v, int k) { return !held.test(v, k); });
        if (auto why = written.defects(input); !why.empty()) throw error(why);
        return {name_, io::impl::with_points(opened::file, written.points)};
    }

private:
    const std::vector<corners>& shown() const override { return faces_; }

    std::string name_;
    std::vector<corners> faces_;
};

/// Opened surface file as a shell, not movable.
struct opened_shell
{
    explicit opened_shell(const source& from) : file(io::read_surface_file(from.path, from.format)), shell(file.surface)
    {
        if (!from.pins.empty())
            constraints = pinned(shell.hinges(), io::read_pins<3>(from.pins, file.surface.vertex_count()));
    }

    io::surface_file file;
    thin_shell shell;
    taut::constraints<hinge> constraints;
};

class shell_subject final : private opened_shell, public session_subject<hinge>
{
public:
    shell_subject(queue& q, const source& from)
        : opened_shell(from),
          session_subject<hinge>(q, shell.hinges(),
                                 [&](observer ask)
                                 {
                                     return std::make_unique<session<hinge>>(
                                         q, shell, shell_params{.constraints = opened_shell::constraints},
                                         run_limits{.observer = std::move(ask)});
                                 }),
          name_(base_name(from.path)),
          faces_(as_corners(shell.surface().cells()))
    {
    }

    view::model model() const override
    {
        return {3, showing::shape, name_, as_floats(shell.surface().points(), shell.surface().points().front()),
                as_list(faces_)};
    }

    void start_afresh() override
    {
        auto result = deform(queue_, shell, shell_params{.constraints = all_held()});
        if (!result) throw error(result.report.reason);
        go_to(result.x);
    }

    subject::saved write() const override
    {
        return {std::filesystem::path(name_).stem().string() + "-moved.obj", written(
                                                                                 [&](const std::filesystem::path& path)
                                                                                 {
                                                                                     io::atomic_file out(path);
                                                                                     file.write(out, x());
                                                                                     out.commit();
                                                                                 })};
    }

private:
    const std::vector<corners>& shown() const override { return faces_; }

    std::string name_;
    std::vector<corners> faces_;
};

} // namespace

namespace
{

/// Throws usage_error for options that would have no effect.
void require_used(const source& from, bool pasting, bool volume)
{
    const auto refuse = [](const char* option, const char* why)
    { throw tools::usage_error(std::string(option) + ' ' + why + "; leave it out"); };
    if (from.zone > 0 && !volume) refuse("--zone", "is for SU2 files");
    if (pasting && !from.pins.empty()) refuse("--pins", "is not for a pasted feature");
    if (pasting && from.shell) refuse("--shell", "is not for a pasted feature");
    if (from.holes && (pasting || from.shell || volume))
        refuse("--holes", volume ? "is for surfaces" : "is for maps; other surfaces may have holes");
}

} // namespace

std::unique_ptr<subject> make_subject(queue& q, const source& from)
{
    const bool pasting = !from.feature.source.empty();
    const bool volume =
        !pasting && !from.shell && from.format == io::surface_format::automatic && tools::names_volume(from.path);
    require_used(from, pasting, volume);
    if (pasting) return make_paste_subject(q, from);
    if (from.shell) return std::make_unique<shell_subject>(q, from);
    if (!volume) return std::make_unique<map_subject>(q, from);
    auto file = io::read_volume_file(from.path, io::volume_format::automatic, from.zone);
    tools::require_mesh(file);
    if (file.dimension == 2) return std::make_unique<shape_subject<triangle>>(q, std::move(file), from);
    return std::make_unique<shape_subject<tetrahedron>>(q, std::move(file), from);
}

} // namespace taut::view
