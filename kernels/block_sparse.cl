// SPDX-License-Identifier: MIT
// Products, smoothing and transfers for block-sparse matrices with D x D blocks, and the refresh of their values.
//
// Rows come in slices of C; a slice is as wide as its longest row (sliced ELLPACK), from offsets[slice] to
// offsets[slice + 1] in steps of C. Place p = offsets[slice] + j * C + lane is nonzero j of row slice * C + lane; its
// block entry (r, c) lies at (p - lane) * D * D + (r * D + c) * C + lane, so that one product reads one stream.
// Missing nonzeros have value 0 and name their own row.
// Vectors: component c of vertex v at [c * stride + v]; stride is a multiple of 256 and its padding zero.
//
// Macros: REAL float or double; D block size; C rows a slice; V rows an item. (16, 16): CPUs, where explicit vectors
// keep the arithmetic wide although the gathers are not; (32, 1): GPUs, where a slice is a warp.
//
// check: -DREAL=double -DREAL_IS_DOUBLE=1 -DD=2 -DC=16 -DV=16 -DEPSILON=1e-12
// check: -DREAL=float -DREAL_IS_DOUBLE=0 -DD=3 -DC=16 -DV=16 -DEPSILON=2e-6f
// check: -DREAL=float -DREAL_IS_DOUBLE=0 -DD=2 -DC=32 -DV=1 -DEPSILON=2e-6f
// check: -DREAL=double -DREAL_IS_DOUBLE=1 -DD=3 -DC=32 -DV=1 -DEPSILON=1e-12

#if REAL_IS_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

#define CAT_(a, b) a##b
#define CAT(a, b) CAT_(a, b)
#define UNROLLED _Pragma("unroll") for

#if V == 1
#define REALV REAL
#define INTV int
#define LOAD(p, i) (p)[i]
#define STORE(v, p, i) (p)[i] = (v)
#define GATHER(p, at) (p)[at]
#define WHERE(test, yes, no) ((test) ? (yes) : (no))
#define WHERE_INT(test, yes, no) ((test) ? (yes) : (no))
#else
#define REALV CAT(REAL, 16)
#define INTV int16
#define LOAD(p, i) vload16(0, (p) + (i))
#define STORE(v, p, i) vstore16(v, 0, (p) + (i))
#define GATHER(p, at)                                                                                                  \
    (REALV)((p)[(at).s0], (p)[(at).s1], (p)[(at).s2], (p)[(at).s3], (p)[(at).s4], (p)[(at).s5], (p)[(at).s6],          \
            (p)[(at).s7], (p)[(at).s8], (p)[(at).s9], (p)[(at).sa], (p)[(at).sb], (p)[(at).sc], (p)[(at).sd],          \
            (p)[(at).se], (p)[(at).sf])
#define WHERE_INT(test, yes, no) select((INTV)(no), (INTV)(yes), test)
#define WHERE(test, yes, no) select((REALV)(no), (REALV)(yes), test)
#endif

#define SLICE ((int)get_global_id(0) / (C / V))
#define LANE ((int)get_global_id(0) % (C / V))
#define PACKED (D * (D + 1) / 2)

/// Where entry (r, c) of a packed symmetric block is.
#define PACK(r, c) ((r) <= (c) ? (r) * D - (r) * ((r) - 1) / 2 + (c) - (r) : (c) * D - (c) * ((c) - 1) / 2 + (r) - (c))

/// sum = rows of A x
inline void multiply(const int slice, const int lane, const int stride, __global const int* offsets,
                     __global const int* columns, __global const REAL* A, __global const REAL* x, REALV* sum)
{
    UNROLLED (int c = 0; c < D; ++c) sum[c] = 0;
    const int end = offsets[slice + 1];
    for (int at = offsets[slice]; at < end; at += C)
    {
        const INTV j = LOAD(columns, at + lane);
        REALV xj[D];
        UNROLLED (int c = 0; c < D; ++c) xj[c] = GATHER(x + c * stride, j);
        UNROLLED (int r = 0; r < D; ++r)
            UNROLLED (int c = 0; c < D; ++c) sum[r] += LOAD(A, at * D * D + (r * D + c) * C + lane) * xj[c];
    }
}

/// y = inverse r for packed blocks [entry * stride + row]
inline void invert(const int i, const int stride, __global const REAL* inverse, const REALV* r, REALV* y)
{
    UNROLLED (int k = 0; k < D; ++k)
    {
        y[k] = 0;
        UNROLLED (int c = 0; c < D; ++c) y[k] += LOAD(inverse, PACK(k, c) * stride + i) * r[c];
    }
}

/// y = A x
__kernel void product(const int stride, __global const int* offsets, __global const int* columns,
                      __global const REAL* A, __global const REAL* x, __global REAL* y)
{
    const int slice = SLICE, lane = LANE, i = slice * C + lane;
    REALV sum[D];
    multiply(slice, lane, stride, offsets, columns, A, x, sum);
    UNROLLED (int c = 0; c < D; ++c) STORE(sum[c], y, c * stride + i);
}

/// r = b - A x; r may be b.
__kernel void residual(const int stride, __global const int* offsets, __global const int* columns,
                       __global const REAL* A, __global const REAL* x, __global const REAL* b, __global REAL* r)
{
    const int slice = SLICE, lane = LANE, i = slice * C + lane;
    REALV sum[D];
    multiply(slice, lane, stride, offsets, columns, A, x, sum);
    UNROLLED (int c = 0; c < D; ++c) STORE(LOAD(b, c * stride + i) - sum[c], r, c * stride + i);
}

/// One step of a polynomial smoother: out = now x + past before + scale inverse (b - A x). out may be before, not x.
__kernel void smooth(const int stride, __global const int* offsets, __global const int* columns,
                     __global const REAL* A, __global const REAL* inverse, __global const REAL* b,
                     __global const REAL* x, __global const REAL* before, const REAL now, const REAL past,
                     const REAL scale, __global REAL* out)
{
    const int slice = SLICE, lane = LANE, i = slice * C + lane;
    REALV r[D], d[D];
    multiply(slice, lane, stride, offsets, columns, A, x, r);
    UNROLLED (int c = 0; c < D; ++c) r[c] = LOAD(b, c * stride + i) - r[c];
    invert(i, stride, inverse, r, d);
    UNROLLED (int c = 0; c < D; ++c)
        STORE(now * LOAD(x, c * stride + i) + past * LOAD(before, c * stride + i) + scale * d[c], out, c * stride + i);
}

/// out = scale inverse b
__kernel void jacobi(const int stride, __global const REAL* inverse, __global const REAL* b, const REAL scale,
                     __global REAL* out)
{
    const int i = SLICE * C + LANE;
    REALV r[D], d[D];
    UNROLLED (int c = 0; c < D; ++c) r[c] = LOAD(b, c * stride + i);
    invert(i, stride, inverse, r, d);
    UNROLLED (int c = 0; c < D; ++c) STORE(scale * d[c], out, c * stride + i);
}

/// Inverses of the diagonal blocks (nonzero 0 of each row), packed. The factorization L d L' keeps each pivot above
/// EPSILON traces, so semi-definite blocks stay finite; a block without a positive trace has inverse 0.
__kernel void invert_blocks(const int stride, __global const int* offsets, __global const REAL* A,
                            __global REAL* inverse)
{
    const int slice = SLICE, lane = LANE, i = slice * C + lane;
    // Slices of padding alone hold no blocks; their inverses stay as they are, 0.
    if (offsets[slice] == offsets[slice + 1]) return;
    const int at = offsets[slice] * D * D + lane;
    REALV L[D][D], d[D], inv[D][D], trace = 0;
    UNROLLED (int r = 0; r < D; ++r) trace += LOAD(A, at + (r * D + r) * C);
    const REALV least = WHERE(trace > 0, EPSILON * trace, (REALV)1);
    UNROLLED (int c = 0; c < D; ++c)
    {
        d[c] = LOAD(A, at + (c * D + c) * C);
        UNROLLED (int k = 0; k < c; ++k) d[c] -= L[c][k] * L[c][k] * d[k];
        d[c] = fmax(d[c], least);
        UNROLLED (int r = c + 1; r < D; ++r)
        {
            L[r][c] = LOAD(A, at + (r * D + c) * C);
            UNROLLED (int k = 0; k < c; ++k) L[r][c] -= L[r][k] * L[c][k] * d[k];
            L[r][c] /= d[c];
        }
    }
    // inv = L^-1, from which the inverse is inv' d^-1 inv.
    UNROLLED (int c = 0; c < D; ++c)
        UNROLLED (int r = 0; r < D; ++r)
        {
            inv[r][c] = r == c ? 1 : 0;
            UNROLLED (int k = c; k < r; ++k) inv[r][c] -= L[r][k] * inv[k][c];
        }
    UNROLLED (int r = 0; r < D; ++r)
        UNROLLED (int c = r; c < D; ++c)
        {
            REALV sum = 0;
            UNROLLED (int k = c; k < D; ++k) sum += inv[k][r] * inv[k][c] / d[k];
            STORE(WHERE(trace > 0, sum, (REALV)0), inverse, PACK(r, c) * stride + i);
        }
}

/// Values from element blocks: the blocks of C places at a time, each the sum of its list of slots. Slot
/// pair * D * D * cells + cell, or its complement where the transposed block counts, or NONE.
#define NONE 0x7fffffff
__kernel void assemble(const int slices, const int cells, __global const int* offsets, __global const int* slots,
                       __global const REAL* blocks, __global REAL* A)
{
    const int slice = SLICE, lane = LANE;
    if (slice >= slices) return;
    REALV sum[D * D];
    UNROLLED (int e = 0; e < D * D; ++e) sum[e] = 0;
    const int end = offsets[slice + 1];
    for (int at = offsets[slice]; at < end; at += C)
    {
        const INTV s = LOAD(slots, at + lane);
        const INTV from = WHERE_INT(s == NONE, (INTV)0, WHERE_INT(s < 0, ~s, s));
        UNROLLED (int r = 0; r < D; ++r)
            UNROLLED (int c = 0; c < D; ++c)
            {
                const INTV entry = WHERE_INT(s < 0, (INTV)((c * D + r) * cells), (INTV)((r * D + c) * cells));
                const REALV value = GATHER(blocks, from + entry);
#if V > 1 && REAL_IS_DOUBLE
                sum[r * D + c] += WHERE(convert_long16(s == NONE), (REALV)0, value);
#else
                sum[r * D + c] += WHERE(s == NONE, (REALV)0, value);
#endif
            }
    }
    UNROLLED (int e = 0; e < D * D; ++e) STORE(sum[e], A, slice * C * D * D + e * C + lane);
}

/// Values of the coarse matrix P' A P: block by block, the sum of its list of fine blocks with weights. targets: where
/// each block goes, -1 for none; lists of like length share a slice.
__kernel void galerkin(const int slices, __global const int* offsets, __global const int* places,
                       __global const REAL* weights, __global const int* targets, __global const REAL* fine,
                       __global REAL* coarse)
{
    const int slice = SLICE, lane = LANE;
    if (slice >= slices) return;
    REALV sum[D * D];
    UNROLLED (int e = 0; e < D * D; ++e) sum[e] = 0;
    const int end = offsets[slice + 1];
    for (int at = offsets[slice]; at < end; at += C)
    {
        const INTV from = LOAD(places, at + lane);
        const REALV w = LOAD(weights, at + lane);
        UNROLLED (int e = 0; e < D * D; ++e) sum[e] += w * GATHER(fine, from + e * C);
    }
    for (int e = 0; e < D * D; ++e)
    {
        REAL s[V];
        STORE(sum[e], s, 0);
        for (int v = 0; v < V; ++v)
        {
            const int target = targets[slice * C + lane + v];
            if (target >= 0) coarse[target + e * C] = s[v];
        }
    }
}

/// b = P' r, and the smoother's first step from zero: x = scale inverse b.
__kernel void restrict_residual(const int fine_stride, const int stride, __global const int* offsets,
                                __global const int* rows, __global const REAL* weights, __global const REAL* r,
                                __global const REAL* inverse, const REAL scale, __global REAL* b, __global REAL* x)
{
    const int slice = SLICE, lane = LANE, i = slice * C + lane;
    REALV sum[D], d[D];
    UNROLLED (int c = 0; c < D; ++c) sum[c] = 0;
    const int end = offsets[slice + 1];
    for (int at = offsets[slice]; at < end; at += C)
    {
        const INTV from = LOAD(rows, at + lane);
        const REALV w = LOAD(weights, at + lane);
        UNROLLED (int c = 0; c < D; ++c) sum[c] += w * GATHER(r + c * fine_stride, from);
    }
    invert(i, stride, inverse, sum, d);
    UNROLLED (int c = 0; c < D; ++c)
    {
        STORE(sum[c], b, c * stride + i);
        STORE(scale * d[c], x, c * stride + i);
    }
}

/// x += P coarse, three weights a row: columns and weights at [k * stride + row].
__kernel void prolong(const int stride, const int coarse_stride, __global const int* columns,
                      __global const REAL* weights, __global const REAL* coarse, __global REAL* x)
{
    const int i = SLICE * C + LANE;
    REALV sum[D];
    UNROLLED (int c = 0; c < D; ++c) sum[c] = LOAD(x, c * stride + i);
    UNROLLED (int k = 0; k < 3; ++k)
    {
        const INTV j = LOAD(columns, k * stride + i);
        const REALV w = LOAD(weights, k * stride + i);
        UNROLLED (int c = 0; c < D; ++c) sum[c] += w * GATHER(coarse + c * coarse_stride, j);
    }
    UNROLLED (int c = 0; c < D; ++c) STORE(sum[c], x, c * stride + i);
}

/// x = inverse b with a dense symmetric matrix of `size` rows, padded to `pitch`; unknown k is number at[k] of a vector.
__kernel void dense(const int size, const int pitch, __global const int* at, __global const REAL* inverse,
                    __global const REAL* b, __global REAL* x)
{
    const int first = SLICE * C + LANE;
    if (first >= pitch) return;
    REALV even = 0, odd = 0;
    int k = 0;
    for (; k + 1 < size; k += 2)
    {
        even += LOAD(inverse, k * pitch + first) * b[at[k]];
        odd += LOAD(inverse, (k + 1) * pitch + first) * b[at[k + 1]];
    }
    if (k < size) even += LOAD(inverse, k * pitch + first) * b[at[k]];
    REAL s[V];
    STORE(even + odd, s, 0);
    for (int v = 0; v < V; ++v)
        if (first + v < size) x[at[first + v]] = s[v];
}
