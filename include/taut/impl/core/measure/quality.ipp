// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/certify.hpp>
#include <taut/energies.hpp>
#include <taut/impl/core/measure/quality.hpp>
#include <taut/impl/core/measure/singular_values.hpp>
#include <taut/quality.hpp>

namespace taut
{

template <class Element>
quality measure_quality(const mesh<Element>& m, const impl::ideal_elements<Element>& ideal,
                        std::span<const vec<Element::dimension>> x)
{
    constexpr int D = Element::dimension;
    quality q;
    q.flips = certify<D>(m.cells(), x, ideal.measure);
    const std::size_t cells = m.cells().size();
    const auto sums =
        impl::block_sum<impl::quality_sums>(cells,
                                            [&](impl::quality_sums& s, std::size_t c)
                                            {
                                                const auto e = impl::mapped_element(m, ideal, x, c);
                                                s.isometric.add(impl::bounded(energy::isometric{}, e), e.measure);
                                                s.shape.add(impl::bounded(energy::shape{}, e), e.measure);
                                                s.area.add(impl::bounded(energy::area{}, e), e.measure);
                                                s.angular += impl::angular_distortion(m, x, c);
                                                s.rest += e.measure;
                                                s.mapped += std::abs(e.det) * e.measure;
                                            });
    q.isometric = sums.isometric.over(cells, sums.rest);
    q.shape = sums.shape.over(cells, sums.rest);
    q.area = sums.area.over(cells, sums.rest);
    constexpr std::size_t angles = D == 2 ? 3 : 12; // of a cell
    q.angular = sums.angular / static_cast<double>(angles * cells);
    q.scale = D == 2 ? std::sqrt(sums.rest / sums.mapped) : std::cbrt(sums.rest / sums.mapped);

    const auto stretch = impl::block_sum<impl::stretch_sums>(cells,
                                                             [&](impl::stretch_sums& s, std::size_t c)
                                                             {
                                                                 const auto e = impl::mapped_element(m, ideal, x, c);
                                                                 const auto sigma =
                                                                     impl::singular_values<D>(q.scale * e.S);
                                                                 double sum = 0;
                                                                 double volume = 1;
                                                                 for (const double v : sigma)
                                                                 {
                                                                     sum += 1 / (v * v);
                                                                     volume *= v;
                                                                 }
                                                                 s.l2.add(std::sqrt(sum / D));
                                                                 s.linf.add(1 / sigma.back());
                                                                 s.ratio.add(volume);
                                                                 s.total += e.measure * sum / D;
                                                             });
    q.stretch_l2 = stretch.l2.result();
    q.stretch_linf = stretch.linf.result();
    q.area_ratio = stretch.ratio.result();
    q.stretch_l2_total = std::sqrt(stretch.total / sums.rest);
    return q;
}

template quality measure_quality<triangle>(const mesh<triangle>& m, const impl::ideal_elements<triangle>& ideal,
                                           std::span<const vec<triangle::dimension>> x);

template quality measure_quality<tetrahedron>(const mesh<tetrahedron>& m,
                                              const impl::ideal_elements<tetrahedron>& ideal,
                                              std::span<const vec<tetrahedron::dimension>> x);

template <class Element>
quality measure_quality(const mesh<Element>& m, std::span<const vec<Element::dimension>> x)
{
    // In units of the model, so that squares neither overflow nor vanish.
    const double unit = impl::unit_scale(m);
    std::vector<vec<Element::dimension>> scaled(x.begin(), x.end());
    for (auto& p : scaled) p *= unit;
    return measure_quality<Element>(m, impl::ideal_elements<Element>(m, unit), scaled);
}

template quality measure_quality<triangle>(const mesh<triangle>& m, std::span<const vec<triangle::dimension>> x);

template quality measure_quality<tetrahedron>(const mesh<tetrahedron>& m,
                                              std::span<const vec<tetrahedron::dimension>> x);

} // namespace taut
