// SPDX-License-Identifier: MIT
// Vector updates: one element an item, in scalar loads and stores of stride 1, which every compiler vectorises.
// Vectors are padded to a multiple of the group size, so there is no bounds test; padding is zero and stays zero.
//
// Macros:
//   REAL   type of the vectors; POINT: type of positions, at least as precise
//   NX     vectors in one linear combination: 2, 4 or 8
//
// check: -DREAL=double -DPOINT=double -DUSES_DOUBLE=1 -DNX=8
// check: -DREAL=float -DPOINT=double -DUSES_DOUBLE=1 -DNX=4
// check: -DREAL=float -DPOINT=float -DUSES_DOUBLE=0 -DNX=2

#if USES_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

/// y = a x
__kernel void scale(const REAL a, __global const REAL* x, __global REAL* y)
{
    const size_t i = get_global_id(0);
    y[i] = a * x[i];
}

/// y = a x + b y
__kernel void axpby(const REAL a, __global const REAL* x, const REAL b, __global REAL* y)
{
    const size_t i = get_global_id(0);
    y[i] = a * x[i] + b * y[i];
}

/// out = x + a d, a step from positions x along a direction d; x and out may be the same buffer.
__kernel void step_along(__global const POINT* x, const POINT a, __global const REAL* d, __global POINT* out)
{
    const size_t i = get_global_id(0);
    out[i] = x[i] + a * d[i];
}

/// out = a0 x0 + a1 x1 + ... over the first NX vectors; the others fill the signature. x0 may be out itself.
__kernel void combine(__global REAL* out, const REAL a0, __global const REAL* x0, const REAL a1,
                      __global const REAL* x1, const REAL a2, __global const REAL* x2, const REAL a3,
                      __global const REAL* x3, const REAL a4, __global const REAL* x4, const REAL a5,
                      __global const REAL* x5, const REAL a6, __global const REAL* x6, const REAL a7,
                      __global const REAL* x7)
{
    const size_t i = get_global_id(0);
    REAL s = a0 * x0[i] + a1 * x1[i];
#if NX > 2
    s += a2 * x2[i] + a3 * x3[i];
#endif
#if NX > 4
    s += a4 * x4[i] + a5 * x5[i];
    s += a6 * x6[i] + a7 * x7[i];
#endif
    out[i] = s;
}
