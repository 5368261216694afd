// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <taut/impl/core/compute/vector_space.hpp>
#include <taut/impl/core/objective/element_arrays.hpp>
#include <taut/impl/core/objective/relaxation_kernels.hpp>
#include <taut/impl/core/objective/relaxation_schedule.hpp>

namespace taut::impl
{

/// Parameters of a vertex relaxation: the threshold for bad elements, and limits.
struct relaxation_params
{
    double threshold = 7.5;  ///< an element is bad if its density is above this many times that of the identity
    double above_mean = 4.0; ///< and above this many times the mean density of the map
    int sweeps = 4;          ///< moves a vertex
};

/// Result of a relaxation.
struct relaxation_result
{
    std::size_t elements = 0; ///< bad ones, before
    std::size_t vertices = 0; ///< that had their turns: the free ones of the bad elements
    int sweeps = 0;
    double worst = 0; ///< largest density, before
};

/// Moves the vertices of the few worst elements of a map, each by a Newton step of its own star with all others fixed,
/// so that one sliver does not cap the step of a solver that moves all at once (docs/explanation/numerics.md,
/// "Vertex relaxation").
///
/// Vertices move colour by colour: no two that move at once share an element. A vertex goes to the best of several
/// multiples of its step, and only if its star's energy falls; so the energy of the map can only fall, and no element
/// flips: det is affine along the step of one vertex, and positive at both ends. Pinned vertices and all others keep
/// their positions bit for bit. The same input gives the same output.
///
/// Costs an evaluation of the energy and one wait; and, if there are bad elements, four short launches per colour and
/// sweep. Device memory: a number per cell; while elements are bad, 4 indices per entry (an element at a moving vertex)
/// and 11 numbers (14 in space) an entry of the widest colour.
template <class Element>
class vertex_relaxation
{
public:
    static constexpr int D = Element::dimension;
    using kernels = relaxation_kernels<Element>;
    using arrays = element_arrays<Element>;
    using params = relaxation_params;
    using result = relaxation_result;

    /// Makes kernels and arrays of its own.
    vertex_relaxation(queue q, std::shared_ptr<const layout<Element>> mesh_layout, const any_energy& energy,
                      energy::weighting weights, const real_types& types = {})
        : vertex_relaxation(q, mesh_layout, std::make_shared<const kernels>(q, energy, types),
                            std::make_shared<const arrays>(q, types.vector, *mesh_layout, weights, energy))
    {
    }

    /// Shares kernels with other meshes, and arrays with other evaluations of this mesh. still: one flag per vertex in
    /// the user's numbers, or none; these are not moved, as they have constraints besides the energy.
    vertex_relaxation(queue q, std::shared_ptr<const layout<Element>> mesh_layout,
                      std::shared_ptr<const kernels> shared_kernels, std::shared_ptr<const arrays> shared_arrays,
                      const std::vector<bool>& still = {});

    /// Replaces the flags of vertices that are not moved, as in the constructor.
    void keep_still(const std::vector<bool>& still) { scheduler_ = relaxation_scheduler<Element>(*layout_, still); }

    /// Relaxes x, coordinates as in layout.hpp. A map of infinite energy is not changed.
    result operator()(device_vector& x, const params& how = {});

    /// Launches every kernel once, so that the driver compiles them. x is not changed.
    void warm_up(device_vector& x);

private:
    static constexpr std::size_t step = taut::impl::layout<Element>::step;

    scalar_type type() const { return arrays_->weight.type(); }
    std::size_t cell_count() const { return static_cast<std::size_t>(layout_->cell_count); }

    /// The cells with a larger density.
    std::vector<idx> above(double limit) const;

    void run(const relaxation_schedule& s, int sweeps, device_vector& x);

    /// Reserves room for n numbers, and for half as many more if it has to grow.
    void require(real_buffer& b, std::size_t n)
    {
        if (b.size() < n) b = real_buffer(queue_, type(), n + n / 2);
    }

    queue queue_;
    std::shared_ptr<const layout<Element>> layout_;
    std::shared_ptr<const kernels> kernels_;
    std::shared_ptr<const arrays> arrays_;
    relaxation_scheduler<Element> scheduler_;
    reductions reductions_;
    real_buffer densities_;
    real_buffer steps_, numbers_; ///< steps of one colour; the terms, and then the trial values
    real_buffer::numbers host_;   ///< a copy of the densities
};

template <class Element>
vertex_relaxation<Element>::vertex_relaxation(queue q, std::shared_ptr<const layout<Element>> mesh_layout,
                                              std::shared_ptr<const kernels> shared_kernels,
                                              std::shared_ptr<const arrays> shared_arrays,
                                              const std::vector<bool>& still)
    : queue_(std::move(q)),
      layout_(std::move(mesh_layout)),
      kernels_(std::move(shared_kernels)),
      arrays_(std::move(shared_arrays)),
      scheduler_(*layout_, still),
      reductions_(queue_),
      densities_(queue_, type(), layout_->cell_stride)
{
}

template <class Element>
auto vertex_relaxation<Element>::operator()(device_vector& x, const params& how) -> result
{
    kernels_->densities({layout_->cell_stride, step}, arrays_->with(x.data(), {{"minus_density", densities_}}));
    const auto least = reductions_.minimum(densities_, cell_count());
    const auto mean = reductions_.dot(densities_, arrays_->weight, cell_count());
    host_ = real_buffer::numbers(type(), cell_count());
    densities_.begin_download(host_);
    try
    {
        reductions_.fetch();
    }
    catch (...)
    {
        state_of(queue_)->commands->settle(); // host_ may go, and the driver may still be writing to it
        throw;
    }

    result r{.worst = -reductions_.value(least)};
    const double limit = std::max(how.threshold * kernels_->rest, -how.above_mean * reductions_.value(mean));
    if (!(r.worst > limit) || !std::isfinite(limit) || how.sweeps < 1) return r;

    const auto cells = above(limit);
    const auto schedule = scheduler_(*layout_, cells);
    r.elements = cells.size();
    r.vertices = static_cast<std::size_t>(schedule.rows);
    r.sweeps = schedule.rows > 0 ? how.sweeps : 0;
    run(schedule, r.sweeps, x);
    return r;
}

template <class Element>
void vertex_relaxation<Element>::warm_up(device_vector& x)
{
    params none;
    none.sweeps = 0;
    (*this)(x, none);
    if (layout_->free_count == 0) return;
    // A colour of no rows launches nothing, so a vertex has to move; it moves on a copy.
    device_vector copy(queue_, x.data().type(), x.size());
    copy.data().copy_from(x.data());
    const idx cell[] = {layout_->vertex_corners.items.front() / idx(Element::corners)};
    run(scheduler_(*layout_, cell), 1, copy);
    queue_.finish();
}

template <class Element>
std::vector<idx> vertex_relaxation<Element>::above(double limit) const
{
    std::vector<idx> cells;
    for (std::size_t c = 0; c < host_.size(); ++c)
        if (-host_[c] > limit) cells.push_back(static_cast<idx>(c));
    return cells;
}

template <class Element>
void vertex_relaxation<Element>::run(const relaxation_schedule& s, int sweeps, device_vector& x)
{
    const auto wide = static_cast<std::size_t>(s.widest);
    require(steps_, kernels::step_count * wide);
    require(numbers_, std::max(kernels::term_count, kernels::trials) * wide);
    const buffer<idx> lists(queue_, s.lists);
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (const auto& c : s.colours)
        {
            const auto rows = static_cast<std::size_t>(c.rows), entries = static_cast<std::size_t>(c.entries);
            const auto part = [&](std::initializer_list<named_argument> more)
            {
                std::vector<named_argument> all = more;
                all.insert(all.end(), {{"lists", lists},
                                       {"first_entry", c.first_entry},
                                       {"first_row", c.first_row},
                                       {"list_stride", s.stride},
                                       {"stride", s.widest}});
                return all;
            };
            const auto of_elements = [&](std::initializer_list<named_argument> more)
            {
                auto all = part(more);
                const auto inputs = arrays_->with(x.data(), {});
                all.insert(all.end(), inputs.begin(), inputs.end());
                return all;
            };
            kernels_->terms(entries, of_elements({{"terms", numbers_}}));
            kernels_->steps(rows, part({{"terms", numbers_}, {"steps", steps_}}));
            kernels_->tries(kernels::trials * entries,
                            of_elements({{"steps", steps_}, {"values", numbers_}, {"entries", c.entries}}));
            kernels_->moves(rows, part({{"steps", steps_},
                                        {"values", numbers_},
                                        {"x", x.data()},
                                        {"vertex_stride", arrays_->vertex_stride}}));
        }
}

// Compiled once, with the bodies.
extern template struct relaxation_kernels<triangle>;
extern template class vertex_relaxation<triangle>;

} // namespace taut::impl
