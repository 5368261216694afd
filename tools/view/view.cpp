// SPDX-License-Identifier: MIT
#include <chrono>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "commands.hpp"
#include "report/report_page.hpp"
#include "shared/failure.hpp"
#include "shared/interrupt.hpp"
#include "shared/open_queue.hpp"
#include "shared/shared_options.hpp"
#include "view/browser.hpp"
#include "view/page_files.hpp"
#include "view/server.hpp"
#include "view/subjects.hpp"
#include "view/workbench.hpp"

namespace taut::tools
{

namespace
{

struct view_options
{
    view::source from;
    std::string device;
    unsigned short port = 0;
    double frame = 15; ///< milliseconds
    bool no_browser = false;
};

/// Opens a browser; if that fails, the address was printed.
void open_browser(std::optional<view::browser>& browser, const std::string& url)
{
    try
    {
        browser.emplace(url);
    }
    catch (const std::exception& e)
    {
        std::cerr << "taut: note: the browser is not opened: " << e.what() << '\n';
    }
}

exit_code serve(const view_options& options)
{
    queue q = tools::open_queue(options.device, false);
    auto subject = view::make_subject(q, options.from);
    std::optional<view::server> server;
    try
    {
        server.emplace(options.port,
                       view::page{view::page_html, view::page_script, view::page_style, report::scene_script},
                       encode(subject->model()));
    }
    catch (const std::exception& e)
    {
        throw usage_error("--port " + std::to_string(options.port) + ": " + e.what() + "; leave it out for a free one");
    }
    view::workbench bench(std::move(subject),
                          {.show = [&](auto state) { server->show(std::move(state)); },
                           .tell = [&](std::string m) { server->tell(std::move(m)); },
                           .open = [&](std::string m) { server->open(std::move(m)); }},
                          std::chrono::duration<double>(options.frame / 1000));
    std::cout << server->url() << std::endl;
    keep(true); // Ctrl-C ends it as it should be ended
    std::optional<view::browser> browser;
    if (!options.no_browser) open_browser(browser, server->url());
    server->run([&](view::message m) { return bench.wish(std::move(m)); },
                [&]
                {
                    if (browser) browser->look();
                    return !interrupted();
                });
    return exit_code::valid;
}

} // namespace

command add_view(command_line& program)
{
    const auto options = std::make_shared<view_options>();
    const auto app =
        program.add_subcommand("view", "Edit a map or shape interactively in a browser, on a page that only this "
                                       "machine can open");
    add_input(app, "IN", options->from.path, "the input", "Surface, volume or planar mesh").required();
    add_format(app, options->from.format);
    add_input(app, "--pins", options->from.pins, "the pins", "First pins and springs, as for unwrap and deform")
        .type_name("FILE.csv");
    auto& feature = options->from.feature;
    const option source = add_input(app, "--source", feature.source, "the source",
                                    "Source surface of a feature to paste on IN, as by `taut paste`");
    app.add_option("--at", feature.at, "Vertex of the source at the centre of the feature, from 0")
        .type_name("V")
        .needs(source);
    app.add_option("--radius", feature.radius, "Geodesic radius of the feature, in units of the source")
        .type_name("R")
        .needs(source);
    app.add_option("--onto", feature.onto, "Initial vertex of the feature on IN, from 0").type_name("V").needs(source);
    app.add_option("--scale", feature.scale,
                   "Scale of the feature: lengths in the result divided by lengths in the source")
        .type_name("S")
        .needs(source);
    app.add_option("--triangles", feature.triangles,
                   "Remesh the feature from its map, with about this many triangles, each time its rim is attached")
        .type_name("N")
        .check_range(1, 100'000'000)
        .needs(source);
    app.add_flag("--holes", options->from.holes, "Accept surfaces with holes");
    app.add_flag("--shell", options->from.shell, "Deform the surface in space, as a thin shell");
    app.add_option("--port", options->port, "Port of 127.0.0.1; 0: a free one")
        .type_name("N")
        .check_range(0, 65535)
        .capture_default_str();
    app.add_option("--frame", options->frame, "Milliseconds of work per frame")
        .type_name("MS")
        .check(number_that([](double x) { return x >= 0; }, "must not be negative"))
        .capture_default_str();
    app.add_flag("--no-browser", options->no_browser, "Only print the address");
    add_zone(app, options->from.zone);
    add_device(app, options->device);
    app.footer("exit codes: 2 usage; 3 unreadable input; 4 unsuitable input; 5 no "
               "device;\n  6 no map to begin with; 9 device failure; 130 ended by Ctrl-C, 143 terminated");
    return [options](const outputs&) { return serve(*options); };
}

} // namespace taut::tools
