// SPDX-License-Identifier: MIT
#pragma once

#include <taut/dist.hpp>

#include <vector>

#include <taut/impl/dist/shape/certify_part.hpp>

namespace taut::dist
{

template <class Element>
certificate check(MPI_Comm comm, const mesh_piece<Element>& piece)
{
    constexpr int D = Element::dimension;
    const impl::communicator all(comm);
    const impl::petsc_scope petsc;
    certificate found;
    all.guarded(
        [&]
        {
            const impl::part<Element> p(all, piece);
            std::vector<double> x;
            for (const vec3& point : p.points)
                for (int k = 0; k < D; ++k) x.push_back(point[k]);
            found = impl::certify_part(p, x, {});
        });
    return found;
}

} // namespace taut::dist
