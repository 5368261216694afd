// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <taut/dist.hpp>
#include <taut/impl/core/energy/characteristic_gradient.hpp>
#include <taut/impl/core/energy/characteristic_value.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/impl/dist/processes/fixed_sum.hpp>
#include <taut/impl/dist/processes/part.hpp>
#include <taut/impl/dist/shape/local_elements.hpp>
#include <taut/mesh.hpp>

namespace taut::dist::impl
{

/// The elements of a part at rest, in lengths of the run: those of the serial library, so that its energies are these.
template <class Element>
class rest_model
{
public:
    static constexpr int D = Element::dimension;
    using layout = taut::impl::layout<Element>;

    double lengths = 1;              ///< lengths of the run by those of the caller; a power of two
    double gradient_scale = 1;       ///< as characteristic_gradient() has it for the whole mesh
    element_model<Element> model;    ///< the weights of all
    std::vector<double> measure;     ///< of the cells here
    std::vector<double> weights;     ///< of the cells here
    std::shared_ptr<const layout> l; ///< null where there are no cells

    /// Collective. Throws mesh_error.
    rest_model(const part<Element>& p, const deform_params<Element>& params)
        : model{params.energy,
                taut::impl::types_of(params.precision == precision::automatic ? precision::fp64 : params.precision)}
    {
        double largest = 0;
        for (const vec3& x : p.points) largest = std::max({largest, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
        largest = p.all.most(largest);
        const double unit = largest > 0 ? std::ldexp(1.0, std::clamp(-std::ilogb(largest), -1000, 1000)) : 1.0;
        const bool regular = params.regular;
        std::unique_ptr<mesh<Element>> m;
        std::unique_ptr<taut::impl::ideal_elements<Element>> ideal;
        p.all.together([&] { m = local_mesh(p, unit, regular); });
        if (!regular) p.all.together([&] { ideal = at_rest(p, m.get()); });
        const double whole = regular ? total(p, sizes(p, unit)) : total(p, ideal ? ideal->measure : empty_);
        if (regular && !p.all.any(!p.edges.empty()))
        {
            if (m) ideal = regular_ones(m->cells().size(), whole / static_cast<double>(p.cells));
        }
        else if (regular)
        {
            p.all.together(
                [&]
                {
                    if (m)
                        ideal = std::make_unique<taut::impl::ideal_elements<Element>>(
                            taut::impl::elements_with_edges<Element>(std::span(p.edges), 1.0, "edges"));
                });
            resize(ideal.get(), whole / total(p, ideal ? ideal->measure : empty_));
        }
        const double scale = layout::usual_scale(static_cast<double>(p.cells), whole);
        lengths = unit * scale;
        p.all.together(
            [&]
            {
                if (!m) return;
                l = std::make_shared<const layout>(*m, taut::impl::identity_order(*m), static_cast<idx>(p.own), *ideal,
                                                   scale);
                measure.assign(l->measure.begin(), l->measure.begin() + l->cell_count);
                weights =
                    params.weights == energy::weighting::uniform ? std::vector<double>(measure.size(), 1.0) : measure;
                for (std::size_t c = 0; c < p.weights.size(); ++c) weights[c] *= p.weights[c];
            });
        model.total = total(p, weights);
        set_gradient_scale(p);
    }

private:
    /// Cells that this process counts.
    double total(const part<Element>& p, const std::vector<double>& of_cells) const
    {
        shared_sums sum(1);
        for (std::size_t c = 0; c < of_cells.size(); ++c)
            if (p.counted[c]) sum[0].add(of_cells[c]);
        return sum.totals(p.all)[0];
    }

    /// Measures of cells, inverted or not.
    static std::vector<double> sizes(const part<Element>& p, double unit)
    {
        std::vector<double> all;
        for (const auto& c : p.corners)
        {
            typename Element::mapped_corners x;
            for (std::size_t k = 0; k < x.size(); ++k) x[k] = vec<D>(unit * p.points[static_cast<std::size_t>(c[k])]);
            all.push_back(std::abs(Element::determinant(x)) * Element::measure_factor);
        }
        return all;
    }

    /// Throws mesh_error as deform() of one process does, in the numbers of the caller.
    static std::unique_ptr<mesh<Element>> local_mesh(const part<Element>& p, double unit, bool regular)
    {
        if (p.corners.empty()) return nullptr;
        auto points = p.points;
        for (vec3& x : points) x *= unit;
        if constexpr (D == 2)
            if (!taut::impl::is_planar(points))
                throw parameter_error("mesh", "a surface in space has no shape in the plane");
        auto m = std::make_unique<mesh<Element>>(std::move(points), p.corners);
        auto found = check(
            *m, {.referenced = false, .connected = false, .open = false, .one_boundary = false, .no_handles = false});
        std::erase_if(found,
                      [&](const taut::mesh_finding& f)
                      {
                          const bool shape =
                              f.fault == mesh_error::degenerate_cell || f.fault == mesh_error::inverted_cell;
                          // A part ends anywhere.
                          return f.fault == mesh_error::non_manifold_vertex || (shape && regular) ||
                                 (!shape && !p.owners.empty()); // parts share facets
                      });
        if (!found.empty()) refuse(p, found.front());
        return m;
    }

    static std::unique_ptr<taut::impl::ideal_elements<Element>> at_rest(const part<Element>& p, const mesh<Element>* m)
    {
        if (!m) return nullptr;
        try
        {
            return std::make_unique<taut::impl::ideal_elements<Element>>(*m);
        }
        catch (const mesh_error& e)
        {
            refuse(p, {e.fault(), e.ids(), e.what()});
        }
    }

    [[noreturn]] static void refuse(const part<Element>& p, const taut::mesh_finding& found)
    {
        const bool of_vertices = found.fault == mesh_error::non_manifold_facet || found.fault == mesh_error::non_finite;
        std::vector<idx> ids; // beyond 32 bits they are cut
        for (const idx i : found.ids)
            ids.push_back(static_cast<idx>(of_vertices ? p.ids[static_cast<std::size_t>(i)]
                                                       : p.cell_ids[static_cast<std::size_t>(i)]));
        throw mesh_error(taut::impl::describe<Element>(found.fault, std::move(ids)));
    }

    static std::unique_ptr<taut::impl::ideal_elements<Element>> regular_ones(std::size_t count, double each)
    {
        const mat<D> W = taut::impl::regular_ideal<Element>();
        double one = Element::measure_factor;
        for (int k = 0; k < D; ++k) one *= W[k][k];
        const double edge = std::pow(each / one, 1.0 / D);
        return std::make_unique<taut::impl::ideal_elements<Element>>(
            std::vector<mat<D>>(count, taut::impl::invert_upper(W) / edge), std::vector<double>(count, each));
    }

    /// Multiplies measures by a factor.
    static void resize(taut::impl::ideal_elements<Element>* ideal, double factor)
    {
        if (!ideal) return;
        for (auto& inverse : ideal->inverse) inverse /= std::pow(factor, 1.0 / D);
        for (double& m : ideal->measure) m *= factor;
    }

    /// 2 lambda |l|, where l_v = sum over cells at v of w_c |grad phi_v|, as characteristic_gradient().
    void set_gradient_scale(const part<Element>& p)
    {
        std::vector<double> at_vertex(p.own, 0.0);
        for (std::size_t c = 0; c < weights.size(); ++c)
        {
            const auto add = [&](std::size_t k, const vec<D>& gradient)
            {
                if (const idx v = p.corners[c][k]; p.owns(v))
                    at_vertex[static_cast<std::size_t>(v)] += weights[c] * glm::length(gradient);
            };
            vec<D> sum(0.0);
            for (int k = 0; k < D; ++k)
            {
                vec<D> row(0.0);
                for (int column = k; column < D; ++column)
                    row[column] =
                        l->inverse[static_cast<std::size_t>(column * (column + 1) / 2 + k) * l->cell_stride + c];
                sum += row;
                add(static_cast<std::size_t>(k) + 1, row);
            }
            add(0, sum);
        }
        shared_sums squares(1);
        for (const double x : at_vertex) squares[0].add(x * x);
        gradient_scale = 2 * taut::impl::stiffness<D>(model.energy) * std::sqrt(squares.totals(p.all)[0]) / model.total;
    }

    std::vector<double> empty_;
};

} // namespace taut::dist::impl
