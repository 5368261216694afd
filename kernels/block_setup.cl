// SPDX-License-Identifier: MIT
// Values of block-sparse matrices: assembly, Galerkin products, and inverses of diagonal blocks and of dense matrices.
// It follows block_sparse.cl, which has the layout and the macros, in one program.
//
// after: block_sparse.cl
// check: -DREAL=double -DREAL_IS_DOUBLE=1 -DD=2 -DK=3 -DC=16 -DV=16 -DTEAM=1 -DGROUP=32 -DSHARE=1 -DITEMS=16 -DEPSILON=1e-12
// check: -DREAL=float -DREAL_IS_DOUBLE=0 -DD=3 -DK=4 -DC=16 -DV=16 -DTEAM=1 -DGROUP=32 -DSHARE=1 -DITEMS=16 -DEPSILON=2e-6f
// check: -DREAL=float -DREAL_IS_DOUBLE=0 -DD=2 -DK=3 -DC=32 -DV=1 -DTEAM=256 -DGROUP=1 -DSHARE=16 -DITEMS=128 -DEPSILON=2e-6f
// check: -DREAL=double -DREAL_IS_DOUBLE=1 -DD=3 -DK=4 -DC=32 -DV=1 -DTEAM=256 -DGROUP=1 -DSHARE=16 -DITEMS=128 -DEPSILON=1e-12

/// A loop as it stands. On CPUs compilers take longer for copies of it, for vectors and for counts, than these save.
#ifndef PLAIN
#if V == 1
#define PLAIN for
#else
#define PLAIN _Pragma("clang loop vectorize(disable) interleave(disable) unroll(disable)") for
#endif
#endif

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

/// Memory of an item that may be too large for a thread's stack.
#ifndef SCRATCH
#define SCRATCH(T, name, n) T name[n]
#endif
/// Entry e of the block at hand of galerkin, 0 beyond it.
#define ENTRY(e) ((e) < D * D ? PICK(fine, at * D * D + (e) * C + lane) : (REAL)0)

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
    SCRATCH(REAL4, sums, (GROUP + 1) * COLOURS * QUADS);
    REAL4 product[COLOURS * QUADS];
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
                REAL4 block[QUADS];
                UNROLLED (int q = 0; q < QUADS; ++q)
                    block[q] = VECTOR(REAL4)(ENTRY(4 * q), ENTRY(4 * q + 1), ENTRY(4 * q + 2), ENTRY(4 * q + 3));
                UNROLLED (int l = 0; l < K; ++l)
                {
                    const int c = code >> 8 * l & 255;
                    touched[c / 64] |= (ulong)1 << c % 64;
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
                for (ulong some = touched[w]; some; some ^= (ulong)1 << HIGHEST(some))
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
