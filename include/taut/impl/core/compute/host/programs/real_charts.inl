// SPDX-License-Identifier: MIT
// Newton's method on charts for one REAL, in the form that CPUs have.

#define TEAM 1
#define EPSILON (REAL_IS_DOUBLE ? REAL(1e-11) : REAL(1e-5f))
struct charts : work_item
{
    // The recorded functions, by their order in own_program::parts.
    template <class... A>
    void element_gradient(A... a)
    {
        call_part(0, a...);
    }
    template <class... A>
    void element_first_flip(A... a)
    {
        call_part(1, a...);
    }
    template <class... A>
    void element_along(A... a)
    {
        call_part(2, a...);
    }
    template <class... A>
    void element_hessian(A... a)
    {
        call_part(3, a...);
    }
#include <taut/impl/core/compute/host/kernels/charts.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef EPSILON

