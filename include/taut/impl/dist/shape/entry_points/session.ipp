// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <taut/dist.hpp>

#include <taut/impl/dist/shape/shape_body.hpp>

namespace taut::dist
{

template <class Element>
session<Element>::session(MPI_Comm comm, const mesh_piece<Element>& piece, const deform_params<Element>& params)
{
    const impl::communicator all(comm);
    all.guarded([&] { body_ = std::make_unique<impl::shape_body<Element>>(all, piece, params); });
}
template <class Element>
session<Element>::~session() = default;
template <class Element>
session<Element>::session(session&&) noexcept = default;
template <class Element>
session<Element>& session<Element>::operator=(session&&) noexcept = default;

template <class Element>
session<Element>& session<Element>::constrain(const constraints<Element>& wanted)
{
    body_->mesh_part().all.guarded([&] { body_->constrain(wanted); });
    return *this;
}

template <class Element>
result<Element> session<Element>::solve(const run_limits& limits)
{
    body_->mesh_part().all.together([&] { limits.validate(); });
    result<Element> r;
    body_->mesh_part().all.guarded(
        [&]
        {
            r.report = body_->solve(limits);
            if (r.report.flips) r.x = body_->answer();
        });
    return r;
}

} // namespace taut::dist
