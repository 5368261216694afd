// SPDX-License-Identifier: MIT
// Products, smoothing and transfers for block-sparse matrices with D x D blocks. block_setup.cl, which makes their
// values, follows in one program.
//
// Rows come in slices of C; a slice is as wide as its longest row (sliced ELLPACK), from offsets[slice] to
// offsets[slice + 1] in steps of C. Place p = offsets[slice] + j * C + lane is nonzero j of row slice * C + lane; its
// block entry (r, c) lies at (p - lane) * D * D + (r * D + c) * C + lane, so that one product reads one stream.
// Missing nonzeros have value 0 and name their own row.
// Vectors: component c of vertex v at [c * stride + v]; stride is a multiple of 256 and its padding zero.
//
// Macros: REAL float or double; D block size; K weights a row of an interpolation; C rows a slice; V rows an item; TEAM
// items of the group of invert_dense; GROUP, on CPUs, the most rows an item of galerkin; SHARE, on GPUs, its items a row
// and those of `dense`; ITEMS, on GPUs, those of a group.
// (C, V) = (16, 16): CPUs, where explicit vectors keep the arithmetic wide although the gathers are not; (32, 1): GPUs,
// where a slice is a warp.
//
// check: -DREAL=double -DREAL_IS_DOUBLE=1 -DD=2 -DK=3 -DC=16 -DV=16 -DTEAM=1 -DGROUP=32 -DSHARE=1 -DITEMS=16 -DEPSILON=1e-12
// check: -DREAL=float -DREAL_IS_DOUBLE=0 -DD=3 -DK=4 -DC=16 -DV=16 -DTEAM=1 -DGROUP=32 -DSHARE=1 -DITEMS=16 -DEPSILON=2e-6f
// check: -DREAL=float -DREAL_IS_DOUBLE=0 -DD=2 -DK=3 -DC=32 -DV=1 -DTEAM=256 -DGROUP=1 -DSHARE=16 -DITEMS=128 -DEPSILON=2e-6f
// check: -DREAL=double -DREAL_IS_DOUBLE=1 -DD=3 -DK=4 -DC=32 -DV=1 -DTEAM=256 -DGROUP=1 -DSHARE=16 -DITEMS=128 -DEPSILON=1e-12

#if REAL_IS_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

#define CAT_(a, b) a##b
#define CAT(a, b) CAT_(a, b)
#ifndef UNROLLED
#define UNROLLED _Pragma("unroll") for
#endif
/// A vector of its lanes: a literal of OpenCL C, a constructor of C++.
#ifndef VECTOR
#define VECTOR(T) (T)
#endif
#if V == 1
#define REALV REAL
#define INTV int
#define LOAD(p, i) (p)[i]
#define STORE(v, p, i) (p)[i] = (v)
#define LOAD_INT(p, i) (p)[i]
#define GATHER(p, at) (p)[at]
#define WHERE(test, yes, no) ((test) ? (yes) : (no))
#define WHERE_INT(test, yes, no) ((test) ? (yes) : (no))
#else
#define REALV CAT(REAL, 16)
#define INTV int16
#define LOAD(p, i) (*(__global const REALV*)((p) + (i)))
#define STORE(v, p, i) *(__global REALV*)((p) + (i)) = (v)
#define LOAD_INT(p, i) (*(__global const INTV*)((p) + (i)))
/// Places one after the other: from loads that are not volatile compilers make gathers of the hardware, and those took
/// twice as long (AVX-512, Zen 4).
#define PICK(p, at) (*(volatile __global const REAL*)((p) + (at)))
#define GATHER(p, at)                                                                                                  \
    VECTOR(REALV)                                                                                                      \
    (PICK(p, (at).s0), PICK(p, (at).s1), PICK(p, (at).s2), PICK(p, (at).s3), PICK(p, (at).s4), PICK(p, (at).s5),       \
     PICK(p, (at).s6), PICK(p, (at).s7), PICK(p, (at).s8), PICK(p, (at).s9), PICK(p, (at).sa), PICK(p, (at).sb),       \
     PICK(p, (at).sc), PICK(p, (at).sd), PICK(p, (at).se), PICK(p, (at).sf))
#define WHERE_INT(test, yes, no) select((INTV)(no), (INTV)(yes), test)
#define WHERE(test, yes, no) select((REALV)(no), (REALV)(yes), test)
#endif

#define SLICE ((int)get_global_id(0) / (C / V))
#define LANE ((int)get_global_id(0) % (C / V))
#define PACKED (D * (D + 1) / 2)
#if K > 3
#define COLOURS 256
#else
#define COLOURS 64
#endif
#define CLASH 256
#define REAL4 CAT(REAL, 4)
#define QUADS ((D * D + 3) / 4)
/// The number of the highest bit.
#define HIGHEST(bits) (63 - (int)clz((ulong)(bits)))

/// Where entry (r, c) of a packed symmetric block is.
#define PACK(r, c) ((r) <= (c) ? (r) * D - (r) * ((r) - 1) / 2 + (c) - (r) : (c) * D - (c) * ((c) - 1) / 2 + (r) - (c))

/// out = the rows of x that `at` names, lane by lane.
#if V == 1
inline void gather(const int stride, __global const int* at, __global const REAL* x, REALV* out)
{
    UNROLLED (int c = 0; c < D; ++c) out[c] = x[c * stride + *at];
}
#elif defined(WHOLE_VECTORS) // C++: what reads a vector waits for lanes that were written one by one
inline __attribute__((always_inline)) void gather(const int stride, __global const int* at, __global const REAL* x,
                                                  REALV* out)
{
    UNROLLED (int c = 0; c < D; ++c)
    {
        __global const REAL* const p = x + c * stride;
        out[c] = VECTOR(REALV)(PICK(p, (uint)at[0]), PICK(p, (uint)at[1]), PICK(p, (uint)at[2]), PICK(p, (uint)at[3]),
                               PICK(p, (uint)at[4]), PICK(p, (uint)at[5]), PICK(p, (uint)at[6]), PICK(p, (uint)at[7]),
                               PICK(p, (uint)at[8]), PICK(p, (uint)at[9]), PICK(p, (uint)at[10]),
                               PICK(p, (uint)at[11]), PICK(p, (uint)at[12]), PICK(p, (uint)at[13]),
                               PICK(p, (uint)at[14]), PICK(p, (uint)at[15]));
    }
}
#else
#define LANE_OF(s, k)                                                                                                  \
    {                                                                                                                  \
        const uint j = ((volatile __global const uint*)at)[k];                                                         \
        UNROLLED (int c = 0; c < D; ++c) out[c].s = PICK(x + c * stride, j);                                           \
    }
inline __attribute__((always_inline)) void gather(const int stride, __global const int* at, __global const REAL* x,
                                                  REALV* out)
{
    // clang-format off
    LANE_OF(s0, 0) LANE_OF(s1, 1) LANE_OF(s2, 2) LANE_OF(s3, 3) LANE_OF(s4, 4) LANE_OF(s5, 5) LANE_OF(s6, 6)
    LANE_OF(s7, 7) LANE_OF(s8, 8) LANE_OF(s9, 9) LANE_OF(sa, 10) LANE_OF(sb, 11) LANE_OF(sc, 12) LANE_OF(sd, 13)
    LANE_OF(se, 14) LANE_OF(sf, 15)
    // clang-format on
}
#endif

/// sum = rows of A x
inline void multiply(const int slice, const int lane, const int stride, __global const int* offsets,
                     __global const int* columns, __global const REAL* A, __global const REAL* x, REALV* sum)
{
    REALV s[D]; // in registers, which memory behind a pointer is not
    UNROLLED (int c = 0; c < D; ++c) s[c] = 0;
    const int end = offsets[slice + 1];
    for (int at = offsets[slice]; at < end; at += C)
    {
        REALV xj[D];
        gather(stride, columns + at + lane, x, xj);
        UNROLLED (int r = 0; r < D; ++r)
            UNROLLED (int c = 0; c < D; ++c) s[r] += LOAD(A, at * D * D + (r * D + c) * C + lane) * xj[c];
    }
    UNROLLED (int c = 0; c < D; ++c) sum[c] = s[c];
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

/// y = a A x + b z; z may be y, and is not read for b = 0.
__kernel void product(const int stride, __global const int* offsets, __global const int* columns,
                      __global const REAL* A, const REAL a, __global const REAL* x, const REAL b,
                      __global const REAL* z, __global REAL* y)
{
    const int slice = SLICE, lane = LANE, i = slice * C + lane;
    REALV sum[D];
    multiply(slice, lane, stride, offsets, columns, A, x, sum);
    if (b == 0)
        UNROLLED (int c = 0; c < D; ++c) STORE(a * sum[c], y, c * stride + i);
    else
        UNROLLED (int c = 0; c < D; ++c) STORE(a * sum[c] + b * LOAD(z, c * stride + i), y, c * stride + i);
}

inline void smooth_rows(const int slice, const int lane, const int stride, __global const int* offsets,
                        __global const int* columns, __global const REAL* A, __global const REAL* inverse,
                        __global const REAL* b, __global const REAL* x, __global const REAL* before, const REAL now,
                        const REAL past, const REAL scale, __global REAL* out)
{
    const int i = slice * C + lane;
    REALV r[D], d[D];
    multiply(slice, lane, stride, offsets, columns, A, x, r);
    UNROLLED (int c = 0; c < D; ++c) r[c] = LOAD(b, c * stride + i) - r[c];
    invert(i, stride, inverse, r, d);
    UNROLLED (int c = 0; c < D; ++c)
        STORE(now * LOAD(x, c * stride + i) + past * LOAD(before, c * stride + i) + scale * d[c], out, c * stride + i);
}

/// One step of a polynomial smoother: out = now x + past before + scale inverse (b - A x). out may be before, not x.
__kernel void smooth(const int stride, __global const int* offsets, __global const int* columns,
                     __global const REAL* A, __global const REAL* inverse, __global const REAL* b,
                     __global const REAL* x, __global const REAL* before, const REAL now, const REAL past,
                     const REAL scale, __global REAL* out)
{
    smooth_rows(SLICE, LANE, stride, offsets, columns, A, inverse, b, x, before, now, past, scale, out);
}

inline void first_step(const int i, const int stride, __global const REAL* inverse, __global const REAL* b,
                       const REAL scale, __global REAL* out)
{
    REALV r[D], d[D];
    UNROLLED (int c = 0; c < D; ++c) r[c] = LOAD(b, c * stride + i);
    invert(i, stride, inverse, r, d);
    UNROLLED (int c = 0; c < D; ++c) STORE(scale * d[c], out, c * stride + i);
}

/// out = scale inverse b
__kernel void jacobi(const int stride, __global const REAL* inverse, __global const REAL* b, const REAL scale,
                     __global REAL* out)
{
    first_step(SLICE * C + LANE, stride, inverse, b, scale, out);
}

/// The sum of a list of element blocks. Slot: where entry 0 is; entries are `cells` apart. NONE ends a lane's list; the
/// complement of a slot stands for the transposed block. Diagonal blocks hold their upper triangle.
#define NONE 0x7fffffff
inline __attribute__((always_inline)) REALV entries(__global const REAL* blocks, const INTV from, const INTV none)
{
    const REALV value = GATHER(blocks, from);
#if V > 1 && REAL_IS_DOUBLE
    return select(value, (REALV)0, convert_long16(none));
#else
    return WHERE(none, (REALV)0, value);
#endif
}

/// b = P' r, and the smoother's first step from zero: x = scale inverse b. transpose: see galerkin.
__kernel void restrict_residual(const int fine_stride, const int stride, __global const int* offsets,
                                __global const int* transpose, __global const REAL* weights, __global const REAL* r,
                                __global const REAL* inverse, const REAL scale, __global REAL* b, __global REAL* x)
{
    const int slice = SLICE, lane = LANE, i = slice * C + lane;
    REALV sum[D], d[D];
    UNROLLED (int c = 0; c < D; ++c) sum[c] = 0;
    const int end = offsets[slice + 1];
    for (int at = offsets[slice]; at < end; at += C)
    {
        const INTV term = LOAD_INT(transpose, at + lane), none = term < 0, place = WHERE_INT(none, (INTV)0, term);
        const REALV w = entries(weights, place, none);
        INTV row = place;
        UNROLLED (int k = 1; k < K; ++k) row -= WHERE_INT(place >= k * fine_stride, (INTV)fine_stride, (INTV)0);
        UNROLLED (int c = 0; c < D; ++c) sum[c] += w * GATHER(r + c * fine_stride, row);
    }
    invert(i, stride, inverse, sum, d);
    UNROLLED (int c = 0; c < D; ++c)
    {
        STORE(sum[c], b, c * stride + i);
        STORE(scale * d[c], x, c * stride + i);
    }
}

inline void prolong_rows(const int i, const int stride, const int coarse_stride, __global const int* columns,
                         __global const REAL* weights, __global const REAL* coarse, __global REAL* x)
{
    REALV sum[D];
    UNROLLED (int c = 0; c < D; ++c) sum[c] = LOAD(x, c * stride + i);
    UNROLLED (int k = 0; k < K; ++k)
    {
        REALV xj[D];
        gather(coarse_stride, columns + k * stride + i, coarse, xj);
        const REALV w = LOAD(weights, k * stride + i);
        UNROLLED (int c = 0; c < D; ++c) sum[c] += w * xj[c];
    }
    UNROLLED (int c = 0; c < D; ++c) STORE(sum[c], x, c * stride + i);
}

/// x += P coarse: columns and weights at [k * stride + row].
__kernel void prolong(const int stride, const int coarse_stride, __global const int* columns,
                      __global const REAL* weights, __global const REAL* coarse, __global REAL* x)
{
    prolong_rows(SLICE * C + LANE, stride, coarse_stride, columns, weights, coarse, x);
}

#if V > 1
inline void dense_rows(const int first, const int size, const int pitch, __global const int* at,
                       __global const REAL* inverse, __global const REAL* b, __global REAL* x)
{
    REALV even = 0, odd = 0;
    int k = 0;
    for (; k + 1 < size; k += 2)
    {
        even += LOAD(inverse, k * pitch + first) * b[at[k]];
        odd += LOAD(inverse, (k + 1) * pitch + first) * b[at[k + 1]];
    }
    if (k < size) even += LOAD(inverse, k * pitch + first) * b[at[k]];
    const REALV sum = even + odd;
    const REAL* s = (const REAL*)&sum;
    for (int v = 0; v < V; ++v)
        if (first + v < size) x[at[first + v]] = s[v];
}
#endif

/// x = inverse b with a dense symmetric matrix of `size` rows, padded to `pitch`; unknown k is number at[k] of a vector.
/// On GPUs SHARE items do a row.
__kernel void dense(const int size, const int pitch, __global const int* at, __global const REAL* inverse,
                    __global const REAL* b, __global REAL* x)
{
#if V == 1
    __local REAL parts[ITEMS];
    const int row = (int)get_global_id(0) / SHARE, part = (int)get_global_id(0) % SHARE;
    const int item = (int)get_local_id(0);
    REAL sum = 0;
    if (row < size)
        for (int k = part; k < size; k += SHARE) sum += inverse[row * pitch + k] * b[at[k]];
    parts[item] = sum;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (part > 0 || row >= size) return;
    UNROLLED (int k = 1; k < SHARE; ++k) sum += parts[item + k];
    x[at[row]] = sum;
#else
    const int first = SLICE * C + LANE;
    if (first < pitch) dense_rows(first, size, pitch, at, inverse, b, x);
#endif
}

#if V > 1
/// The whole cycle of the two coarsest levels, by one item: a handful of launches would take longer than the work.
__kernel void small_cycle(const int rows, const int stride, const int coarse_stride, const int size, const int pitch,
                          const REAL first, const REAL momentum, const REAL second, __global const int* offsets,
                          __global const int* columns, __global const REAL* A, __global const REAL* inverse,
                          __global const int* prolongation, __global const REAL* weights, __global const int* at,
                          __global const REAL* dense_inverse, __global const REAL* b, __global REAL* coarse_b,
                          __global REAL* coarse_x, __global REAL* y, __global REAL* x)
{
    const REAL now = 1 + momentum;
    for (int i = 0; i < rows; i += V) first_step(i, stride, inverse, b, first, y);
    for (int i = 0; i < rows; i += V)
        smooth_rows(i / C, 0, stride, offsets, columns, A, inverse, b, y, y, now, 0, second, x);

    for (int k = 0; k < D * coarse_stride; k += V) STORE((REALV)0, coarse_b, k);
    for (int i = 0; i < rows; i += V)
    {
        REALV sum[D];
        REALV r[D];
        multiply(i / C, 0, stride, offsets, columns, A, x, sum);
        UNROLLED (int c = 0; c < D; ++c) r[c] = LOAD(b, c * stride + i) - sum[c];
        for (int v = 0; v < V && i + v < rows; ++v)
            for (int l = 0; l < K; ++l)
            {
                const int place = l * stride + i + v;
                UNROLLED (int c = 0; c < D; ++c)
                    coarse_b[c * coarse_stride + prolongation[place]] += weights[place] * ((const REAL*)&r[c])[v];
            }
    }
    for (int k = 0; k < pitch; k += V) dense_rows(k, size, pitch, at, dense_inverse, coarse_b, coarse_x);
    for (int i = 0; i < rows; i += V) prolong_rows(i, stride, coarse_stride, prolongation, weights, coarse_x, x);

    for (int i = 0; i < rows; i += V)
        smooth_rows(i / C, 0, stride, offsets, columns, A, inverse, b, x, x, 1, 0, first, y);
    for (int i = 0; i < rows; i += V)
        smooth_rows(i / C, 0, stride, offsets, columns, A, inverse, b, y, x, now, -momentum, second, x);
}
#endif
