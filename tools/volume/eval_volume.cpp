// SPDX-License-Identifier: MIT
#include "volume/eval_volume.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <utility>
#include <vector>

#include <taut/impl/core/measure/describe_defects.hpp>
#include <taut/quality.hpp>

#include "shared/assessment.hpp"
#include "shared/outputs.hpp"
#include "shared/printable.hpp"
#include "shared/report_files.hpp"
#include "shared/text_table.hpp"
#include "shared/writing.hpp"
#include "volume/shape_report.hpp"
#include "volume/volume_case.hpp"
#include "volume/volume_drawing.hpp"

namespace taut::tools
{

namespace
{

/// Summary of the distortion of cells.
struct distortion_summary
{
    double median = 0, percentile99 = 0, most = 0;
    std::vector<idx> worst_ids; ///< ten

    explicit distortion_summary(const std::vector<double>& of_cells)
    {
        std::vector<std::pair<double, idx>> ranked;
        for (std::size_t c = 0; c < of_cells.size(); ++c)
            if (!std::isnan(of_cells[c])) ranked.emplace_back(of_cells[c], static_cast<idx>(c));
        if (ranked.empty()) return;
        std::sort(ranked.begin(), ranked.end());
        const auto rank = [&](double part)
        { return ranked[static_cast<std::size_t>(std::lround(part * static_cast<double>(ranked.size() - 1)))].first; };
        median = rank(0.5);
        percentile99 = rank(0.99);
        most = rank(1);
        for (std::size_t k = 0; k < std::min<std::size_t>(10, ranked.size()); ++k)
            worst_ids.push_back(ranked[ranked.size() - 1 - k].second);
    }
};

/// Map from the rest shape.
struct volume_map
{
    taut::quality quality; ///< of all cells with a volume at rest
    std::size_t left_out = 0;
    double least = 0, most = 0; ///< singular values
};

template <class Element>
volume_map measure(const volume_case<Element>& input, const std::vector<vec<Element::dimension>>& x)
{
    constexpr int D = Element::dimension;
    const auto& whole = input.simplices();
    auto [flat, inverted] = impl::bad_rest_cells(whole);
    std::vector<char> keep(whole.cells().size(), 1);
    for (const auto* bad : {&flat, &inverted})
        for (const idx c : *bad) keep[static_cast<std::size_t>(c)] = 0;
    std::vector<typename mesh<Element>::cell> cells;
    std::vector<double> weights;
    for (std::size_t c = 0; c < keep.size(); ++c)
        if (keep[c])
        {
            cells.push_back(whole.cells()[c]);
            weights.push_back(input.parts().weights[c]);
        }
    volume_map map;
    map.left_out = keep.size() - cells.size();
    if (cells.empty()) return map;
    const mesh<Element> solid(whole.points(), std::move(cells));
    const double unit = impl::unit_scale(solid);
    auto scaled = x;
    for (auto& p : scaled) p *= unit;
    impl::ideal_elements<Element> ideal(solid, unit);
    const auto flips = certify<D>(solid.cells(), std::span<const vec<D>>(scaled), ideal.measure);
    for (std::size_t c = 0; c < weights.size(); ++c) ideal.measure[c] *= weights[c];
    map.quality = measure_quality<Element>(solid, ideal, scaled);
    map.quality.flips = flips;
    map.least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < weights.size(); ++c)
    {
        const auto s = impl::singular_values<D>(
            impl::shape_matrix<D>(solid.cells()[c], std::span<const vec<D>>(scaled), ideal.inverse[c]));
        map.most = std::max(map.most, s.front());
        map.least = std::min(map.least, s.back());
    }
    return map;
}

template <class Element>
void evaluate(const eval_volume_options& options, const volume_case<Element>& input)
{
    constexpr int D = Element::dimension;
    const auto x = input.points();
    const auto state = input.look_as_read(x);
    const bool has_rest = !input.file().rest.empty();
    std::vector<std::string> notes = input.file().notes;
    if (!input.file().turned.empty()) notes.push_back(turned_note(input.file()));
    volume_map map;
    if (has_rest) map = measure(input, x);
    if (!has_rest) notes.push_back("no rest shape, so no distortion: give its file first, `taut eval REST MAP`");
    if (map.left_out > 0)
        notes.push_back(impl::counted(map.left_out, "corner", "corners") +
                        " not positive at rest: left out of everything but the count of inverted cells");
    const distortion_summary distortion(has_rest ? input.distortion(x) : input.shape_distortion(x));

    if (options.json)
    {
        nlohmann::ordered_json json;
        json["schema"] = "taut.eval/1";
        json["input"] = options.input;
        json["rest"] = has_rest ? nlohmann::ordered_json(options.rest.empty() ? options.input : options.rest)
                                : nlohmann::ordered_json(nullptr);
        json["format"] = input.file().format;
        json["element"] = input.element();
        json["vertices"] = input.file().points.size();
        json["elements"] = input.cells();
        json["inverted"] = state.inverted.size();
        json["inverted_ids"] = state.inverted;
        json[D == 2 ? "branch_points" : "branch_edges"] = state.simplices.branched;
        json["branch_ids"] = state.simplices.branch_ids;
        json["min_det"] = has_rest ? finite(map.quality.flips.min_det) : nlohmann::ordered_json(nullptr);
        json["max_det"] = has_rest ? finite(map.quality.flips.max_det) : nlohmann::ordered_json(nullptr);
        json["quality"] = has_rest ? to_json(map.quality, D) : nlohmann::ordered_json(nullptr);
        json["singular_values"] =
            has_rest ? nlohmann::ordered_json({{"least", finite(map.least)}, {"most", finite(map.most)}})
                     : nlohmann::ordered_json(nullptr);
        json["distortion"] = {{"measure", has_rest ? "max(s1, 1/sn)" : "1 / mean ratio"},
                              {"median", finite(distortion.median)},
                              {"percentile99", finite(distortion.percentile99)},
                              {"most", finite(distortion.most)},
                              {"worst_ids", distortion.worst_ids}};
        if (input.parts().overlapping && D == 3) json["insides"] = insides_json(state);
        json["shapes"] = shapes_json(state.shapes);
        json["notes"] = notes;
        write_standard_output(text_of(json));
        return;
    }
    for (const auto& note : notes) std::cerr << "taut: note: " << printable(note) << '\n';
    labelled_lines lines;
    lines.add("mesh", options.input + ": " + count(input.file().points.size(), "vertex", "vertices") + ", " +
                          count_cells(input.file(), D));
    lines.add("inverted",
              count(state.inverted.size()) + " of " + count(input.cells()) +
                  (has_rest ? "; det " + number(map.quality.flips.min_det) + " .. " + number(map.quality.flips.max_det)
                            : ""));
    if (input.parts().overlapping && D == 3) lines.add("insides", insides_text(state));
    lines.add("winding", state.simplices.branched == 0
                             ? std::string(D == 2 ? "once around every inner vertex" : "once around every inner edge")
                             : impl::describe_defects<Element>(state.simplices));
    if (has_rest) lines.add("stretch", "singular values " + number(map.least) + " .. " + number(map.most));
    lines.add(has_rest ? "distortion" : "1/ratio", "median " + number(distortion.median) + ", 99 % below " +
                                                       number(distortion.percentile99) + ", largest " +
                                                       number(distortion.most));
    lines.add("shapes", shapes_text(state.shapes));
    std::ostringstream out;
    out << lines;
    if (has_rest) print(out, map.quality, D);
    write_standard_output(out.str());
}

} // namespace

exit_code evaluate_volume(const eval_volume_options& options)
{
    const auto file = read_volume_at_rest(options.input, options.rest, options.zone);
    const drawing_options drawing{options.picture, options.clip, file.rest.empty()};
    require_drawable(file, drawing);
    require_mesh(file);
    with_case(file,
              [&](const auto& input)
              {
                  evaluate(options, input);
                  if (drawing.path.empty()) return;
                  const auto state = state_to_draw(input, std::filesystem::path(options.input).filename().string(),
                                                   input.points(), drawing.by_shape);
                  writing([&] { io::write_file(drawing.path, draw_states(file, {state}, drawing)); });
              });
    return exit_code::valid;
}

} // namespace taut::tools
