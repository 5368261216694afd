// SPDX-License-Identifier: MIT
// Products, smoothing and transfers for block-sparse matrices with D x D blocks, and the refresh of their values.
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
#define UNROLLED _Pragma("unroll") for
/// A loop as it stands. On CPUs compilers take longer for copies of it, for vectors and for counts, than these save.
#if V == 1
#define PLAIN for
#else
#define PLAIN _Pragma("clang loop vectorize(disable) interleave(disable) unroll(disable)") for
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
    (REALV)(PICK(p, (at).s0), PICK(p, (at).s1), PICK(p, (at).s2), PICK(p, (at).s3), PICK(p, (at).s4),                  \
            PICK(p, (at).s5), PICK(p, (at).s6), PICK(p, (at).s7), PICK(p, (at).s8), PICK(p, (at).s9),                  \
            PICK(p, (at).sa), PICK(p, (at).sb), PICK(p, (at).sc), PICK(p, (at).sd), PICK(p, (at).se),                  \
            PICK(p, (at).sf))
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

/// The sum of a list of element blocks. Slot: where entry 0 is; entries are `cells` apart. NONE ends a lane's list; the
/// complement of a slot stands for the transposed block. Diagonal blocks hold their upper triangle.
#define NONE 0x7fffffff
inline REALV entries(__global const REAL* blocks, const INTV from, const INTV none)
{
    const REALV value = GATHER(blocks, from);
#if V > 1 && REAL_IS_DOUBLE
    return select(value, (REALV)0, convert_long16(none));
#else
    return WHERE(none, (REALV)0, value);
#endif
}

/// Values from element blocks, a slice of rows an item. The lists of the diagonal belong to rows, the others to C places
/// at a time.
__kernel void assemble(const int cells, __global const int* offsets, __global const int* diagonal_offsets,
                       __global const int* diagonal_slots, __global const int* slot_offsets,
                       __global const int* slots, __global const REAL* blocks, __global REAL* A)
{
    const int slice = SLICE, lane = LANE;
    if (offsets[slice] == offsets[slice + 1]) return;
    REALV sum[D * D];
    UNROLLED (int e = 0; e < PACKED; ++e) sum[e] = 0;
    for (int at = diagonal_offsets[slice]; at < diagonal_offsets[slice + 1]; at += C)
    {
        const INTV s = LOAD_INT(diagonal_slots, at + lane), none = s == NONE, from = WHERE_INT(none, (INTV)0, s);
        UNROLLED (int e = 0; e < PACKED; ++e) sum[e] += entries(blocks, from + e * cells, none);
    }
    UNROLLED (int r = 0; r < D; ++r)
        UNROLLED (int c = 0; c < D; ++c)
            STORE(sum[PACK(r, c)], A, offsets[slice] * D * D + (r * D + c) * C + lane);

    for (int place = offsets[slice] + C; place < offsets[slice + 1]; place += C)
    {
        UNROLLED (int e = 0; e < D * D; ++e) sum[e] = 0;
        for (int at = slot_offsets[place / C]; at < slot_offsets[place / C + 1]; at += C)
        {
            const INTV s = LOAD_INT(slots, at + lane), none = s == NONE, below = s < 0;
            const INTV from = WHERE_INT(none, (INTV)0, WHERE_INT(below, ~s, s));
            UNROLLED (int r = 0; r < D; ++r)
                UNROLLED (int c = 0; c < D; ++c)
                {
                    const INTV entry = WHERE_INT(below, (INTV)((c * D + r) * cells), (INTV)((r * D + c) * cells));
                    sum[r * D + c] += entries(blocks, from + entry, none);
                }
        }
        UNROLLED (int e = 0; e < D * D; ++e) STORE(sum[e], A, place * D * D + e * C + lane);
    }
}

#if V == 1
/// Of row I of P' A P the nonzeros whose numbers are `part` and on, SHARE apart: an item has a nonzero in registers and
/// goes through all products of the row, of which neighbours read the same. transpose: for each coarse row the places in
/// `weights` of its column of P, ended by -1. A row of P without weights has no columns; in others, places without a
/// weight repeat a column.
inline void product_places(const int I, const int part, const int rows, const int fine_stride,
                           __global const int* transpose_offsets, __global const int* transpose,
                           __global const int* prolongation, __global const REAL* weights,
                           __global const int* fine_offsets, __global const int* fine_columns,
                           __global const REAL* fine, __global const int* offsets, __global const int* columns,
                           __global REAL* coarse)
{
    const int slice = I / C, lane = I % C, start = offsets[slice], stop = offsets[slice + 1];
    const int terms_end = I < rows ? transpose_offsets[slice + 1] : 0;
    for (int place = start + part * C; place < stop; place += SHARE * C)
    {
        const int J = columns[place + lane];
        const bool padding = J == I && place > start;
        REAL sum[D * D];
        UNROLLED (int e = 0; e < D * D; ++e) sum[e] = 0;
        for (int t = transpose_offsets[slice] + lane; t < terms_end; t += C)
        {
            const int term = transpose[t];
            if (term < 0 || padding) break;
            const REAL left = weights[term];
            int i = term;
            UNROLLED (int k = 1; k < K; ++k) i -= term >= k * fine_stride ? fine_stride : 0;
            const int fine_lane = i % C;
            const int first = fine_offsets[i / C], end = fine_offsets[i / C + 1];
            for (int at = first; at < end; at += C)
            {
                const int j = fine_columns[at + fine_lane];
                if (j == i && at > first) break;
                REAL right = 0;
                UNROLLED (int l = 0; l < K; ++l)
                    right += prolongation[l * fine_stride + j] == J ? weights[l * fine_stride + j] : 0;
                if (right == 0) continue;
                right *= left;
                UNROLLED (int e = 0; e < D * D; ++e) sum[e] += right * fine[at * D * D + e * C + fine_lane];
            }
        }
        UNROLLED (int e = 0; e < D * D; ++e) coarse[place * D * D + e * C + lane] = sum[e];
    }
}
#else
/// Row I = slice * C + lane of P' A P, term by term. transpose: for each coarse row the places in `weights` of its column
/// of P, ended by -1. A row of P without weights has no columns; in others, places without a weight repeat a column,
/// which saves a branch.
inline void product_row(const int slice, const int lane, const int rows, const int fine_stride,
                        __global const int* transpose_offsets, __global const int* transpose,
                        __global const int* prolongation, __global const REAL* weights,
                        __global const int* fine_offsets, __global const int* fine_columns, __global const REAL* fine,
                        __global const int* offsets, __global const int* columns, __global REAL* coarse)
{
    const int start = offsets[slice], stop = offsets[slice + 1];
    __global REAL* row = coarse + start * D * D + lane;
    for (int j = 0; start + j * C < stop; ++j)
        UNROLLED (int e = 0; e < D * D; ++e) row[j * C * D * D + e * C] = 0;
    if (slice * C + lane >= rows) return;
    for (int t = transpose_offsets[slice] + lane; t < transpose_offsets[slice + 1]; t += C)
    {
        const int term = transpose[t];
        if (term < 0) break;
        const REAL left = weights[term];
        int i = term;
        UNROLLED (int k = 1; k < K; ++k) i -= term >= k * fine_stride ? fine_stride : 0;
        const int fine_lane = i % C;
        const int first = fine_offsets[i / C], end = fine_offsets[i / C + 1];
        for (int at = first; at < end; at += C)
        {
            const int j = fine_columns[at + fine_lane];
            if (j == i && at > first) break;
            REAL block[D * D];
            UNROLLED (int e = 0; e < D * D; ++e) block[e] = left * fine[at * D * D + e * C + fine_lane];
            REAL right[K];
            bool none = true;
            UNROLLED (int l = 0; l < K; ++l)
            {
                right[l] = weights[l * fine_stride + j];
                none = none && right[l] == 0;
            }
            if (none) continue;
            UNROLLED (int l = 0; l < K; ++l)
            {
                const int J = prolongation[l * fine_stride + j];
                int number = 0;
                while (columns[start + number * C + lane] != J) ++number;
                __global REAL* sum = row + number * C * D * D;
                UNROLLED (int e = 0; e < D * D; ++e) sum[e * C] += right[l] * block[e];
            }
        }
    }
}
#endif

/// Values of the coarse matrix P' A P. On GPUs SHARE items do a row. On CPUs one does a group of `size` rows, and sums row i
/// of A P once for all of its rows that fine row i goes to. Nonzeros of a row are told apart by the colours of their
/// columns, `count` in all; where those of a row do not differ, its own colour has the flag CLASH, and it is summed term
/// by term. codes: the colours of the columns of each row of P, a byte each; column_weights: its weights, four places.
/// visits: of each group the slices of fine rows that go to it, and a bit for each lane that does.
__kernel void galerkin(const int rows, const int fine_stride, const int size, const int count,
                       __global const int* transpose_offsets, __global const int* transpose,
                       __global const int* prolongation, __global const REAL* weights,
                       __global const REAL* column_weights, __global const int* codes, __global const int* colours,
                       __global const int* visit_offsets, __global const int* visits, __global const int* fine_offsets,
                       __global const int* fine_columns, __global const REAL* fine, __global const int* offsets,
                       __global const int* columns, __global REAL* coarse)
{
#if V == 1
    const int I = (int)get_global_id(0) / SHARE;
    if (I / C * C < rows)
        product_places(I, (int)get_global_id(0) % SHARE, rows, fine_stride, transpose_offsets, transpose, prolongation,
                       weights, fine_offsets, fine_columns, fine, offsets, columns, coarse);
#else
    const int group = (int)get_global_id(0), begin = group * size, pitch = count * QUADS;
    // Of rows of P' A P, the last for what goes elsewhere, and of a row of A P. Rows are not a power of two apart.
    REAL4 sums[(GROUP + 1) * COLOURS * QUADS], product[COLOURS * QUADS];
    for (int p = 0; p < (size + 1) * pitch; ++p) sums[p] = 0;
    for (int p = 0; p < pitch; ++p) product[p] = 0;

    for (int v = visit_offsets[group]; v < visit_offsets[group + 1]; v += 2)
    {
        const int slice = visits[v], first = fine_offsets[slice], end = fine_offsets[slice + 1];
        for (int lane = 0; lane < C; ++lane)
        {
            if (!(visits[v + 1] >> lane & 1)) continue;
            const int i = slice * C + lane;
            ulong touched[COLOURS / 64] = {0};
            for (int at = first; at < end; at += C)
            {
                const int j = fine_columns[at + lane], code = codes[j];
                const REAL4 right = *(__global const REAL4*)(column_weights + 4 * j);
                REAL4 block[QUADS] = {0};
                UNROLLED (int e = 0; e < D * D; ++e) ((REAL*)block)[e] = PICK(fine, at * D * D + e * C + lane);
                UNROLLED (int l = 0; l < K; ++l)
                {
                    const int c = code >> 8 * l & 255;
                    touched[c / 64] |= 1UL << c % 64;
                    UNROLLED (int q = 0; q < QUADS; ++q)
                        product[c * QUADS + q] += ((const REAL*)&right)[l] * block[q];
                }
            }
            REAL4* to[K];
            REAL left[K];
            UNROLLED (int k = 0; k < K; ++k)
            {
                const int r = prolongation[k * fine_stride + i] - begin;
                const bool here = (uint)r < (uint)size;
                to[k] = sums + (here ? r : size) * pitch;
                left[k] = here ? weights[k * fine_stride + i] : 0;
            }
            UNROLLED (int w = 0; w < COLOURS / 64; ++w)
                for (ulong some = touched[w]; some; some ^= 1UL << HIGHEST(some))
                {
                    const int p = (64 * w + HIGHEST(some)) * QUADS;
                    UNROLLED (int q = 0; q < QUADS; ++q)
                    {
                        const REAL4 part = product[p + q];
                        product[p + q] = 0;
                        UNROLLED (int k = 0; k < K; ++k) to[k][p + q] += left[k] * part;
                    }
                }
        }
    }

    for (int r = 0; r < size && begin + r < rows; ++r)
    {
        const int I = begin + r, slice = I / C, lane = I % C, start = offsets[slice];
        if (colours[I] >= CLASH)
        {
            product_row(slice, lane, rows, fine_stride, transpose_offsets, transpose, prolongation, weights,
                        fine_offsets, fine_columns, fine, offsets, columns, coarse);
            continue;
        }
        for (int at = start; at < offsets[slice + 1]; at += C)
        {
            const int J = columns[at + lane], c = colours[J] % CLASH;
            const bool none = J == I && at > start;
            UNROLLED (int e = 0; e < D * D; ++e)
                coarse[at * D * D + e * C + lane] = none ? 0 : ((const REAL*)(sums + r * pitch))[4 * c * QUADS + e];
        }
    }
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

/// The inverse X of a semi-definite matrix of `size` rows with rows `pitch` apart, by one group of TEAM items. numbers:
/// the unknowns of row r are D * numbers[r] and on, or none for -1. work has size + 2 rows.
///
/// The matrix is scaled to a unit diagonal and shifted, so that directions which it does not see get a large, finite
/// answer. Elimination turns rows into those of L^-1 place by place: A = L d L', X = sum of (row / sqrt d)' (row / sqrt
/// d), which is semi-definite as computed. A pivot that is not well positive takes its unknown out.
///
/// Where the sum of all entries between equal components is nothing but rounding, the matrix does not see a translation.
/// It is made stiff against that, as what the shift would answer there is noise, and large.
#if TEAM > 1
#define SYNC barrier(CLK_GLOBAL_MEM_FENCE)
/// Items that go along a row together, for loads of neighbours.
#define WIDE 32
#else
#define SYNC
#define WIDE 1
#endif
#define TALL (TEAM / WIDE)
__kernel void invert_dense(const int rows, const int size, const int pitch, const REAL shift,
                           __global const int* offsets, __global const int* columns, __global const REAL* A,
                           __global const int* numbers, __global REAL* work, __global REAL* X)
{
    const int item = (int)get_local_id(0), along = item % WIDE, down = item / WIDE;
    __global REAL* scale = work + size * pitch;
    __global REAL* root = scale + pitch;
    PLAIN (int k = item * V; k < (size + 2) * pitch; k += TEAM * V) STORE((REALV)0, work, k);
    SYNC;
    PLAIN (int r = item; r < rows; r += TEAM)
    {
        if (numbers[r] < 0) continue;
        const int first = offsets[r / C] + r % C;
        PLAIN (int at = first; at < offsets[r / C + 1]; at += C)
        {
            if (columns[at] == r && at > first) break;
            const int to = numbers[columns[at]];
            if (to < 0) continue;
            __global const REAL* block = A + (at - r % C) * D * D + r % C;
            UNROLLED (int k = 0; k < D; ++k)
                UNROLLED (int l = 0; l < D; ++l)
                    work[(numbers[r] * D + k) * pitch + to * D + l] = block[(k * D + l) * C];
        }
    }
    SYNC;
    PLAIN (int i = item; i < size; i += TEAM)
    {
        root[i] = 0;
        PLAIN (int j = i % D; j < size; j += D) root[i] += work[i * pitch + j];
    }
    SYNC;
    REAL stiff[D]; // 1 / trace of a component that nothing holds; 0 for others
    UNROLLED (int c = 0; c < D; ++c)
    {
        REAL sum = 0, trace = 0;
        PLAIN (int i = c; i < size; i += D)
        {
            sum += root[i];
            trace += work[i * pitch + i];
        }
        stiff[c] = fabs(sum) <= 10 * EPSILON * trace && trace > 0 && trace < INFINITY ? 1 / trace : 0;
    }
    PLAIN (int i = item; i < size; i += TEAM) scale[i] = work[i * pitch + i] > 0 ? 1 / sqrt(work[i * pitch + i]) : 0;
    SYNC;
    PLAIN (int i = down; i < size; i += TALL)
        PLAIN (int j = along; j < size; j += WIDE)
        {
            REAL a = scale[i] * scale[j] > 0 ? work[i * pitch + j] * (scale[i] * scale[j]) : 0;
            if (scale[i] * scale[j] > 0 && i % D == j % D) a += stiff[i % D] / (scale[i] * scale[j]);
            work[i * pitch + j] = a + (i == j ? shift : 0);
        }
    PLAIN (int k = 0; k < size; ++k)
    {
        SYNC;
        __global REAL* row = work + k * pitch;
        const REAL pivot = row[k];
        const bool good = pivot > (REAL)0.1 * shift && pivot < INFINITY;
        if (item == 0) root[k] = good ? 1 / sqrt(pivot) : 0;
        PLAIN (int i = k + 1 + down; i < size; i += TALL)
        {
            __global REAL* other = work + i * pitch;
            const REAL f = good ? other[k] / pivot : 0;
            if (good)
                PLAIN (int j = along * V; j < pitch; j += WIDE * V)
                    if (TEAM == 1 || j != k) STORE(LOAD(other, j) - f * LOAD(row, j), other, j);
            if (TEAM == 1) other[k] = -f;
        }
#if TEAM > 1
        // Items that share a row have all read its factor.
        SYNC;
        for (int i = k + 1 + item; i < size; i += TEAM) work[i * pitch + k] = good ? -work[i * pitch + k] / pivot : 0;
#endif
    }
    SYNC;
    PLAIN (int k = down; k < size; k += TALL)
    {
        __global REAL* row = work + k * pitch;
        PLAIN (int j = along; j < pitch; j += WIDE)
            row[j] = root[k] > 0 && j <= k ? (j == k ? 1 : row[j]) * (root[k] * scale[j]) : 0;
    }
    SYNC;
    PLAIN (int i = down; i < size; i += TALL)
        PLAIN (int j = along * V; j < pitch; j += WIDE * V)
        {
            REALV sum = 0;
            PLAIN (int k = i; k < size; ++k) sum += work[k * pitch + i] * LOAD(work, k * pitch + j);
            STORE(sum, X, i * pitch + j);
        }
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
