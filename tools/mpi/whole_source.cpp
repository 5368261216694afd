// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include <taut/impl/dist/ranges/deal.hpp>
#include <taut/impl/files/volume/cell_faces.hpp>
#include <taut/impl/files/volume/write_volume.hpp>
#include <taut/surface_file.hpp>
#include <taut/volume_file.hpp>

#include "mpi/shape_source.hpp"
#include "shared/failure.hpp"
#include "shared/writing.hpp"
#include "volume/group_targets.hpp"
#include "volume/written_shape.hpp"

namespace taut::tools::mpi
{

namespace
{

template <class Element>
class whole : public shape_source<Element>
{
public:
    static constexpr int D = Element::dimension;
    using points = typename shape_source<Element>::points;

    whole(const dist::impl::communicator& all, const mpi_options& o, mpi_report& report, io::volume_file file)
        : all_(all), shape_(o.shape), file_(std::move(file))
    {
        points begin_with;
        all_.together(
            [&]
            {
                if (all_.rank() != 0) return;
                input_.emplace(file_);
                this->mixed = input_->parts().overlapping;
                require_names(o, file_);
                read_targets(report);
                if (!file_.rest.empty() && !shape_.smoothing) begin_with = input_->points();
                report.format = file_.format;
                report.cells = count_cells(file_, D);
                report.element = input_->element();
                report.mixed = this->mixed;
                report.dimension = D;
                report.vertices = file_.points.size();
                report.elements = input_->cells();
                report.springs = held_.springs().size();
                report.before = input_->look(input_->points());
            });
        this->mixed = all_.shared(this->mixed);
        this->piece = dealt(input_ ? &*input_ : nullptr);
        if (shape_.smoothing && !shape_.free_interfaces) keep_labels();
        this->initial = dist::impl::spread(all_, begin_with);
    }

    std::vector<idx> doubtful(const points& x) const override
    {
        const auto shape = dist::impl::collected(all_, x);
        std::vector<idx> cells;
        all_.together(
            [&]
            {
                if (all_.rank() != 0) return;
                const auto state = input_->look(input_->as_written(shape));
                for (const auto* some : {&state.negative_inside, &state.undecided, &state.inverted})
                    cells.insert(cells.end(), some->begin(), some->end());
                std::sort(cells.begin(), cells.end());
            });
        return cells;
    }

    dist::mesh_piece<Element> edged(const std::vector<idx>& cells) const override
    {
        std::optional<volume_case<Element>> parts;
        all_.together(
            [&]
            {
                if (all_.rank() == 0) parts.emplace(file_, cells);
            });
        return dealt(parts ? &*parts : nullptr);
    }

    points read(const std::string& path) const override
    {
        points x;
        all_.together(
            [&]
            {
                if (all_.rank() != 0) return;
                const auto found = io::read_volume_file(path).points;
                if (found.size() != file_.points.size())
                    throw unsuitable_input(path + ": a checkpoint of another mesh, by its number of vertices; remove "
                                                  "it, or name another file");
                x.assign(found.begin(), found.end());
            });
        return dist::impl::spread(all_, x);
    }

    void write(const std::string& path, const points& x) const override
    {
        const auto shape = dist::impl::collected(all_, x);
        all_.together(
            [&]
            {
                if (all_.rank() == 0) writing([&] { file_.write(path, input_->in_file(shape)); });
            });
    }

    void finish(const points& x, mpi_report& report,
                const typename shape_source<Element>::report_writer& write_report) override
    {
        const auto shape = dist::impl::collected(all_, x);
        all_.together(
            [&]
            {
                if (all_.rank() != 0) return;
                const auto marks = held_.held();
                std::vector<char> still(shape.size(), 0);
                for (const auto v : this->fixed) still[static_cast<std::size_t>(v)] = 1;
                written_.emplace(*input_, shape,
                                 [&](std::size_t v, int k)
                                 { return shape_.smoothing ? !still[v] : !(v < marks.size() && marks.test(v, k)); });
                if (!written_->note.empty()) report.run.notes.push_back(written_->note);
                if (!written_->state.simplices) throw no_valid_map(written_->defects(*input_));
                report.after = written_->state;
                write_report(io::impl::volume_outputs(shape_.output, file_, written_->points));
            });
    }

private:
    dist::mesh_piece<Element> dealt(const volume_case<Element>* input) const
    {
        return dist::impl::dealt<Element>(all_, input ? &input->simplices() : nullptr,
                                          input && this->mixed ? &input->parts() : nullptr);
    }

    /// Regions of the cells that were dealt, and labelled faces, of process 0. Collective.
    void keep_labels()
    {
        std::vector<idx> regions;
        all_.together(
            [&]
            {
                if (all_.rank() != 0) return;
                const auto numbers = io::impl::region_numbers(file_);
                std::size_t number = 0;
                for (const auto& block : file_.cells)
                    for (std::size_t c = 0; c < block.size(); ++c, ++number)
                    {
                        const int dimension = io::impl::shape_of(block.kind).dimension;
                        if (dimension == D) regions.push_back(numbers[number]);
                        if (dimension != D - 1 || numbers[number] == 0) continue;
                        auto& face = this->kept.faces.emplace_back();
                        const auto corners = block.cell(c);
                        std::copy(corners.begin(), corners.end(), face.vertices.begin());
                        face.label = numbers[number];
                    }
                if (std::adjacent_find(regions.begin(), regions.end(), std::not_equal_to<>()) == regions.end())
                    regions.clear();
            });
        regions = all_.gathered(regions); // process 0 alone has any
        const auto& owners = this->piece.owners;
        const auto cells = static_cast<std::int64_t>(this->piece.cells.size());
        const std::int64_t before = all_.before(cells);
        if (regions.empty() || cells == 0) return;
        this->first_region = owners.empty() ? before : owners.front();
        const auto end = owners.empty() ? before + cells : owners.back() + 1;
        this->kept.regions.assign(regions.begin() + this->first_region, regions.begin() + end);
    }

    void read_targets(mpi_report& report)
    {
        auto& told = this->notes;
        told = file_.notes;
        if (!file_.turned.empty()) told.push_back(turned_note(file_));
        group_targets targets(file_);
        for (const auto& name : shape_.fixed) targets.fix(name);
        for (const auto& move : shape_.moves) targets.move(move);
        if (auto note = targets.note(); !note.empty()) told.push_back(std::move(note));
        if (shape_.smoothing)
        {
            for (const auto& [v, x] : targets.all()) this->fixed.push_back(v);
            return;
        }
        const auto& mesh = input_->simplices();
        held_ = taut::constraints<Element>(mesh);
        held_by_file held(file_);
        targets.pin(held_, held);
        if (!shape_.pins.empty()) held_.add(held(input_->read_pins(shape_.pins)));
        if (auto note = held.note(); !note.empty()) told.push_back(std::move(note));
        report.pins = held_.pins().size();
        for (const auto& [v, pin] : held_.pins())
            for (int k = 0; k < D; ++k)
                if ((pin.held >> k & 1U) != 0) this->pins.pin(v, k, pin.value[k]);
        for (const auto& s : held_.springs())
            if (s.weight > 0) this->pins.spring(s.vertex, s.target, s.weight);
    }

    const dist::impl::communicator& all_;
    const shape_options& shape_;
    io::volume_file file_; ///< of process 0, as what follows
    std::optional<volume_case<Element>> input_;
    taut::constraints<Element> held_;
    std::optional<written_shape<Element>> written_; ///< while it is written
};

} // namespace

io::volume_file read_whole(const mpi_options& o)
{
    const auto& shape = o.shape;
    check(shape);
    require_half_turns(shape.moves);
    if (names_surface(shape.input))
        throw unsuitable_input(shape.input + ": a surface in space is small enough for one process; use `taut deform`");
    auto file = read_volume_at_rest(shape.input, shape.rest, shape.zone);
    if (shape.smoothing) file.rest.clear();
    require_mesh(file);
    return file;
}

template <class Element>
std::unique_ptr<shape_source<Element>> whole_source(const dist::impl::communicator& all, const mpi_options& o,
                                                    mpi_report& report, io::volume_file file)
{
    return std::make_unique<whole<Element>>(all, o, report, std::move(file));
}

template std::unique_ptr<shape_source<tetrahedron>> whole_source(const dist::impl::communicator&, const mpi_options&,
                                                                 mpi_report&, io::volume_file);
template std::unique_ptr<shape_source<triangle>> whole_source(const dist::impl::communicator&, const mpi_options&,
                                                              mpi_report&, io::volume_file);

} // namespace taut::tools::mpi
