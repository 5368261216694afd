// SPDX-License-Identifier: MIT
#include "unwrap/unwrap_options.hpp"

#include <chrono>

#include <taut/energies.hpp>

#include "shared/choices.hpp"
#include "shared/failure.hpp"
#include "shared/shared_options.hpp"

namespace taut::tools
{

namespace
{

void declare_map(const subcommand& app, unwrap_options& o)
{
    add_choice<energy_kind>(
        app, "--energy", o.energy,
        {{"isometric", energy_kind::isometric}, {"shape", energy_kind::shape}, {"area", energy_kind::area}},
        "Energy, which preserves lengths, angles or areas");
    add_choice<boundary_kind>(
        app, "--boundary", o.boundary,
        {{"free", boundary_kind::free}, {"circle", boundary_kind::circle}, {"square", boundary_kind::square}},
        "Let the boundary move, or keep it on a circle or square");
    add_choice<energy::weighting>(app, "--weights", o.weights,
                                  {{"measure", energy::weighting::measure}, {"uniform", energy::weighting::uniform}},
                                  "Weight of a triangle: its area, or 1");
    add_choice<start_kind>(app, "--start", o.start,
                           {{"auto", start_kind::automatic},
                            {"coarse", start_kind::coarse},
                            {"stretch", start_kind::stretch},
                            {"tutte", start_kind::tutte},
                            {"mean-value", start_kind::mean_value},
                            {"conformal", start_kind::conformal},
                            {"uv", start_kind::uv}},
                           "Initial map: from a coarser mesh; barycentric with reduced stretch, uniform or "
                           "mean value weights; least squares conformal; the file's vt. auto: coarse for "
                           "newton and mg-lbfgs, else stretch");
    add_choice<boundary_spacing>(app, "--spacing", o.spacing,
                                 {{"chord", boundary_spacing::chord},
                                  {"uniform", boundary_spacing::uniform},
                                  {"centripetal", boundary_spacing::centripetal}},
                                 "Spacing on the circle or square: by edge lengths, uniform, by their square roots");
    add_choice<taut::placement>(
        app, "--placement", o.placement,
        {{"upright", placement::upright}, {"unit-square", placement::unit_square}, {"as-solved", placement::as_solved}},
        "Placement of an unconstrained map: y up or x to the right, the lower left "
        "corner at 0,0; the same scaled into the unit square; anywhere. With --boundary "
        "circle or square the boundary is not moved, unless unit-square scales it into "
        "the unit square, a square onto it");
    add_input(app, "--pins", o.pins, "the pins",
              "Pins and springs, one per line: vertex,u,v[,weight]; vertices from 0, in file order; "
              "without a weight an exact pin, with a weight a spring; an empty u or v is free")
        .type_name("FILE.csv");
    app.add_flag("--cut", o.cut, "Cut closed surfaces, handles, and between boundaries along short seams");
    app.add_flag("--holes", o.holes, "Accept surfaces with holes; the longest boundary is the outer one");
    app.add_flag("--no-overlap", o.no_overlap,
                 "Keep the boundary from crossing itself, so that no two triangles of the map overlap");
}

void declare_solver(const subcommand& app, unwrap_options& o)
{
    add_choice<solver_kind>(app, "--solver", o.solver,
                            {{"newton", solver_kind::newton},
                             {"mg-lbfgs", solver_kind::multigrid_lbfgs},
                             {"lbfgs", solver_kind::lbfgs},
                             {"cg", solver_kind::conjugate_gradient},
                             {"gd", solver_kind::gradient_descent}},
                            "Newton's method or limited-memory BFGS, both with multigrid; plain BFGS; the paper's "
                            "conjugate gradient; gradient descent");
    app.add_option("--iterations", o.iterations, "Stop after N steps")
        .type_name("N")
        .check(whole_number())
        .capture_default_str();
    app.add_option("--tolerance", o.tolerance,
                   "Stop at this relative gradient, below 1, or at a negligible Newton decrement; "
                   "0: never. Default: 1e-6, or a total decrease of at most 1e-4 over five steps")
        .type_name("T")
        .check(number_that([](double x) { return x >= 0; }, "must not be negative"));
    add_time_limit(app, o.time_limit, "Stop after S seconds, with the best map so far (exit code 8)");
    add_choice<taut::precision>(
        app, "--precision", o.precision,
        {{"auto", precision::automatic},
         {"fp64", precision::fp64},
         {"mixed", precision::mixed},
         {"fp32", precision::fp32}},
        "Arithmetic of the optimisation: double, mixed, float; the check for flips is always exact");
    add_device(app, o.device);
}

void declare_reports(const subcommand& app, unwrap_options& o)
{
    add_stats(app, o.stats);
    add_output(app, "--picture", o.picture, {.extensions = {".png", ".svg"}},
               "Draw the flat map, coloured by distortion");
    add_output(app, "--render", o.render, {.extensions = {".png"}}, "Draw the surface with a checkerboard");
    const std::initializer_list<choice<std::optional<vec3>>> axes = {
        {"auto", {}},           {"+x", vec3(1, 0, 0)}, {"-x", vec3(-1, 0, 0)}, {"+y", vec3(0, 1, 0)},
        {"-y", vec3(0, -1, 0)}, {"+z", vec3(0, 0, 1)}, {"-z", vec3(0, 0, -1)}};
    add_choice<std::optional<vec3>>(app, "--up", o.up, axes, "Up direction of the render");
    add_choice<std::optional<vec3>>(app, "--front", o.front, axes, "Viewing side of the render");
    add_progress(app, o.progress, o.quiet);
}

} // namespace

void declare(const subcommand& app, unwrap_options& o)
{
    add_input(
        app, "IN", o.input, "the input",
        "Surface: OBJ, OFF, PLY or STL; - is standard input; if it is no disk, it is cut along the seams of its vt")
        .required();
    add_output(app, "-o,--output", o.output,
               {.extensions = {".obj"}, .made_of = "IN", .in_place = true, .may_fail = true},
               "OBJ to write: the input with new vt; - is standard output, here and below")
        .required()
        .type_name("OUT.obj");
    add_format(app, o.format);
    declare_map(app, o);
    declare_solver(app, o);
    declare_reports(app, o);
}

void check(const unwrap_options& o)
{
    if (o.start == start_kind::uv && o.boundary != boundary_kind::free)
        throw usage_error("--boundary circle and square replace the boundary, which --start uv keeps; "
                          "leave out one of them");
    if (o.start == start_kind::conformal && o.boundary != boundary_kind::free)
        throw usage_error("--start conformal moves the boundary, which --boundary circle and square fix; "
                          "leave out one of them");
    if (o.start == start_kind::coarse && !to_params(o).uses_levels())
        throw usage_error("--start coarse needs --solver newton or mg-lbfgs, which work on coarser meshes");
    if (o.placement != placement::upright && !o.pins.empty())
        throw usage_error("--placement: --pins fix the map; leave one of them out");
    if ((o.up || o.front) && o.render.empty())
        throw usage_error("--up and --front rotate the picture of --render; name one");
    if (o.tolerance && !(*o.tolerance < 1)) throw usage_error("--tolerance: must be below 1");
    if (!(o.time_limit > 0)) throw usage_error("--time-limit: must be positive");
}

parameterize_params to_params(const unwrap_options& o)
{
    parameterize_params p;
    switch (o.energy)
    {
    case energy_kind::isometric:
        p.energy = energy::isometric{};
        break;
    case energy_kind::shape:
        p.energy = energy::shape{};
        break;
    case energy_kind::area:
        p.energy = energy::area{};
        break;
    }
    p.weights = o.weights;
    p.boundary = o.boundary == boundary_kind::free     ? boundary_mode::free
                 : o.boundary == boundary_kind::square ? boundary_mode::square
                                                       : boundary_mode::fixed;
    p.spacing = o.spacing;
    p.start = o.start == start_kind::automatic    ? start_method::automatic
              : o.start == start_kind::coarse     ? start_method::coarse
              : o.start == start_kind::conformal  ? start_method::conformal
              : o.start == start_kind::tutte      ? start_method::tutte
              : o.start == start_kind::mean_value ? start_method::mean_value
                                                  : start_method::barycentric;
    p.placement = o.placement;
    p.holes = o.holes;
    p.no_overlap = o.no_overlap;
    p.precision = o.precision;
    p.multigrid = o.solver == solver_kind::multigrid_lbfgs;
    if (o.tolerance) p.solve = {.gradient_tolerance = *o.tolerance}; // no less strict than that
    p.solve.method = o.solver == solver_kind::newton               ? solve::method::newton
                     : o.solver == solver_kind::conjugate_gradient ? solve::method::conjugate_gradient
                     : o.solver == solver_kind::gradient_descent   ? solve::method::gradient_descent
                                                                   : solve::method::lbfgs;
    p.solve.max_iterations = o.iterations;
    return p;
}

std::string to_string(energy_kind kind)
{
    return kind == energy_kind::isometric ? "isometric" : kind == energy_kind::shape ? "shape" : "area";
}

std::string to_string(solver_kind kind)
{
    switch (kind)
    {
    case solver_kind::newton:
        return "newton";
    case solver_kind::multigrid_lbfgs:
        return "mg-lbfgs";
    case solver_kind::lbfgs:
        return "lbfgs";
    case solver_kind::conjugate_gradient:
        return "cg";
    case solver_kind::gradient_descent:
        break;
    }
    return "gd";
}

std::string to_string(taut::precision p)
{
    return p == precision::fp64 ? "fp64" : p == precision::mixed ? "mixed" : p == precision::fp32 ? "fp32" : "auto";
}

std::string describe_start(const unwrap_options& o)
{
    switch (o.start)
    {
    case start_kind::uv:
        return "the file's vt";
    case start_kind::conformal:
        if (o.boundary == boundary_kind::free) return "conformal";
        break;
    case start_kind::automatic:
    case start_kind::coarse:
        if (to_params(o).uses_levels()) return "coarse";
        break;
    case start_kind::stretch:
    case start_kind::tutte:
    case start_kind::mean_value:
        break;
    }
    const char* kind = o.start == start_kind::tutte        ? "tutte"
                       : o.start == start_kind::mean_value ? "mean value"
                                                           : "evened stretch";
    return std::string(kind) + " on a " + (o.boundary == boundary_kind::square ? "square" : "circle");
}

} // namespace taut::tools
