// SPDX-License-Identifier: MIT
// Sums, for each vertex, what the corners of its cells contribute: no atomics, so the order of additions is fixed.
//
// contributions[(corner * D + c) * cells + cell] is component c of a corner of a cell; a slot is the place
// corner * D * cells + cell, so that component c of it lies c * cells further on.
//
// Macros: REAL float or double; D components; W slots a vertex in the first step.
//
// check: -DREAL=double -DREAL_IS_DOUBLE=1 -DD=2 -DW=8
// check: -DREAL=float -DREAL_IS_DOUBLE=0 -DD=3 -DW=28

#if REAL_IS_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

/// The first W slots of each vertex, in columns: slots[j * vertices + v], -1 for none. A fixed count without branches is
/// what compilers vectorise; the slots of neighbouring vertices are neighbours.
__kernel void gather(const int vertices, const int cells, __global const int* restrict slots,
                     __global const REAL* restrict contributions, __global REAL* restrict out)
{
    const int v = (int)get_global_id(0);
    REAL sum[D];
#pragma unroll
    for (int c = 0; c < D; ++c) sum[c] = 0;
#pragma unroll
    for (int j = 0; j < W; ++j)
    {
        const int slot = slots[j * vertices + v];
        const int place = max(slot, 0);
#pragma unroll
        for (int c = 0; c < D; ++c)
        {
            const REAL value = contributions[place + c * cells];
            sum[c] += slot < 0 ? (REAL)0 : value;
        }
    }
#pragma unroll
    for (int c = 0; c < D; ++c) out[c * vertices + v] = sum[c];
}

/// The rest of the few vertices with more than W slots: rows of slots from offsets[i] to offsets[i + 1], added to what
/// the first step left at vertex which[i].
__kernel void gather_rest(const int vertices, const int cells, const int rows, __global const int* restrict which,
                          __global const int* restrict offsets, __global const int* restrict slots,
                          __global const REAL* restrict contributions, __global REAL* restrict out)
{
    const int i = (int)get_global_id(0);
    if (i >= rows) return;
    const int v = which[i];
    for (int c = 0; c < D; ++c)
    {
        REAL sum = out[c * vertices + v];
        for (int k = offsets[i]; k < offsets[i + 1]; ++k) sum += contributions[slots[k] + c * cells];
        out[c * vertices + v] = sum;
    }
}
