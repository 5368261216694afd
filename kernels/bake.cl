// SPDX-License-Identifier: MIT
// Textures of one atlas made for another one. Places in the new atlas are in texels: the centre of texel (i, j) is
// (i + 0.5, j + 0.5); places in the old one are in texels of the old texture. CHANNELS: of both textures. Numbers of
// the old one have old_bytes bytes: 4 are floats; others stand for values by a table of CHANNELS each, one number a
// channel, or with a palette one a texel.
//
// check: -DUNUSED

/// A vector of its lanes: a literal of OpenCL C, a constructor of C++.
#ifndef VECTOR
#define VECTOR(T) (T)
#endif

#ifndef CHANNELS
#define CHANNELS 4
#endif

/// A triangle that is nearest to a point of the plane: the weights of its corners there.
typedef struct
{
    int triangle;
    float squared_distance;
    float3 weights;
} nearest_place;

static float dot2(const float2 a, const float2 b)
{
    return a.x * b.x + a.y * b.y;
}

static float dot3(const float3 a, const float3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static float3 cross3(const float3 a, const float3 b)
{
    return VECTOR(float3)(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static float cross2(const float2 a, const float2 b)
{
    return a.x * b.y - a.y * b.x;
}

/// The place of the segment from a along d that is nearest to the origin, from 0 to 1.
static float along_segment(const float2 a, const float2 d)
{
    const float square = dot2(d, d);
    return square > 0 ? clamp(-dot2(a, d) / square, 0.0f, 1.0f) : 0.0f;
}

/// Keeps the nearer of a place and the triangle t (6 numbers); of two at one distance the first stays.
static void keep_nearer(nearest_place* place, const int f, __global const float* t, const float2 p)
{
    const float2 a = vload2(0, t) - p, b = vload2(1, t) - p, c = vload2(2, t) - p;
    const float u = cross2(b, c), v = cross2(c, a), w = cross2(a, b), det = u + v + w;
    if (det != 0 && u * det >= 0 && v * det >= 0 && w * det >= 0)
    {
        if (place->squared_distance > 0)
        {
            place->triangle = f;
            place->squared_distance = 0;
            place->weights = VECTOR(float3)(u, v, w) / det;
        }
        return;
    }
    const float s0 = along_segment(a, b - a), s1 = along_segment(b, c - b), s2 = along_segment(c, a - c);
    const float2 q0 = a + s0 * (b - a), q1 = b + s1 * (c - b), q2 = c + s2 * (a - c);
    const float d0 = dot2(q0, q0), d1 = dot2(q1, q1), d2 = dot2(q2, q2);
    const float least = fmin(d0, fmin(d1, d2));
    if (!(least < place->squared_distance)) return;
    place->triangle = f;
    place->squared_distance = least;
    place->weights = d0 == least   ? VECTOR(float3)(1 - s0, s0, 0)
                     : d1 == least ? VECTOR(float3)(0, 1 - s1, s1)
                                   : VECTOR(float3)(s2, 0, 1 - s2);
}

/// Number of the texel at x along a side of n. wrap: 0 the border goes on, 1 the texture repeats, 2 as mirrored copies
static int wrapped(const int x, const int n, const int wrap)
{
    if (wrap == 0) return max(0, min(x, n - 1));
    const int period = wrap * n, rest = x % period, r = rest < 0 ? rest + period : rest;
    return r < n ? r : period - 1 - r;
}

/// The old texture as the kernel reads it.
typedef struct
{
    __global const float* texels;
    __global const float* table;
    int bytes, palette, width, height, nearest, wrap_u, wrap_v;
} old_texture;

/// Channel c of texel `at`.
static float channel_of(const old_texture* old, const size_t at, const int c)
{
    if (old->bytes == 4) return old->texels[CHANNELS * at + c];
    const size_t k = old->palette ? at : CHANNELS * at + c;
    const size_t number = old->bytes == 1 ? ((__global const uchar*)old->texels)[k] : ((__global const ushort*)old->texels)[k];
    return old->table[CHANNELS * number + c];
}

static void add_texel(float* value, const old_texture* old, const int i, const int j, const float weight)
{
    const size_t at = (size_t)wrapped(j, old->height, old->wrap_v) * old->width + wrapped(i, old->width, old->wrap_u);
    for (int c = 0; c < CHANNELS; ++c) value[c] += weight * channel_of(old, at, c);
}

/// Adds the old texture at p.
static void add_sample(float* value, const old_texture* old, const float2 p)
{
    if (old->nearest)
    {
        add_texel(value, old, (int)floor(p.x), (int)floor(p.y), 1);
        return;
    }
    const float2 low = floor(p - 0.5f), r = p - 0.5f - low;
    const int i = (int)low.x, j = (int)low.y;
    add_texel(value, old, i, j, (1 - r.x) * (1 - r.y));
    add_texel(value, old, i + 1, j, r.x * (1 - r.y));
    add_texel(value, old, i, j + 1, (1 - r.x) * r.y);
    add_texel(value, old, i + 1, j + 1, r.x * r.y);
}

static float3 interpolated3(__global const float* corners, const float3 w)
{
    return w.x * vload3(0, corners) + w.y * vload3(1, corners) + w.z * vload3(2, corners);
}

static float3 first3(const float4 a)
{
    return VECTOR(float3)(a.x, a.y, a.z);
}

static float3 interpolated_tangent(__global const float* corners, const float3 w)
{
    return w.x * first3(vload4(0, corners)) + w.y * first3(vload4(1, corners)) + w.z * first3(vload4(2, corners));
}

static float2 rotated(const float2 x, const float2 by)
{
    return VECTOR(float2)(by.x * x.x - by.y * x.y, by.y * x.x + by.x * x.y);
}

/// A normal of the old tangent space, stored as (x + 1) / 2, in the new one; or a direction across it, whose third
/// number says something else. old, next: tangents, 12 numbers a triangle; turns: cosine and sine by which a direction
/// is rotated before and after
static void turn_normal(float* value, const int across, const float3 w, __global const float* normals,
                        __global const float* old, __global const float* next, const float green, const float4 turns)
{
    const float2 stored =
        rotated(VECTOR(float2)(2 * value[0] - 1, green * (2 * value[1] - 1)), VECTOR(float2)(turns.x, turns.y));
    const float3 n = interpolated3(normals, w);
    const float3 t = interpolated_tangent(old, w), b = old[3] * cross3(n, t);
    const float3 world = stored.x * t + stored.y * b + (across ? 0 : 2 * value[2] - 1) * n;
    const float3 s = interpolated_tangent(next, w), c = next[3] * cross3(n, s);
    // Cramer's rule for x s + y c + z n = world
    const float3 cn = cross3(c, n), ns = cross3(n, s), sc = cross3(s, c);
    const float det = dot3(s, cn);
    const float side = det < 0 ? -1.0f : 1.0f;
    const float3 turned = side * VECTOR(float3)(dot3(world, cn), dot3(world, ns), across ? 0 : dot3(world, sc));
    const float size = sqrt(dot3(turned, turned));
    const float3 unit = size > 0 ? turned / size : across ? VECTOR(float3)(1, 0, 0) : VECTOR(float3)(0, 0, 1);
    const float2 made = rotated(VECTOR(float2)(unit.x, unit.y), VECTOR(float2)(turns.z, turns.w));
    value[0] = 0.5f * made.x + 0.5f;
    value[1] = 0.5f * green * made.y + 0.5f;
    if (!across) value[2] = 0.5f * unit.z + 0.5f;
}

/// Texels of rows first_row .. first_row + rows - 1 of the new texture: the mean of samples x samples places in each.
/// Triangles near tile k are items[starts[k]] .. items[starts[k + 1] - 1]. A place in no triangle has the value at the
/// nearest place of one, if that is at most `reach` away. covered: 1 where the centre is in a triangle, 2 where it is
/// near to one, 0 elsewhere.
/// source: 0 the old texture at `old_uv`, 1 the numbers `values` of corners, 2 the old texture as normals, 3 as directions
__kernel void bake_texels(const int width, const int first_row, const int rows, const int tile, const int tiles_across,
                          const int samples, const float reach, __global const int* restrict starts,
                          __global const int* restrict items, __global const float* restrict uv, const int source,
                          __global const float* restrict old_uv, __global const float* restrict old_texels,
                          __global const float* restrict old_table, const int old_bytes, const int palette, const int old_width, const int old_height,
                          const int nearest, const int wrap_u, const int wrap_v,
                          __global const float* restrict values, __global const float* restrict normals,
                          __global const float* restrict old_tangents, __global const float* restrict new_tangents,
                          const float green, const float turn_x, const float turn_y, const float after_x,
                          const float after_y, __global float* restrict texels, __global int* restrict covered)
{
    const int at = (int)get_global_id(0), i = at % width, row = at / width, j = first_row + row;
    if (row >= rows) return;
    const int k = j / tile * tiles_across + i / tile, first = starts[k], last = starts[k + 1];
    const old_texture old = {old_texels, old_table, old_bytes, palette, old_width, old_height, nearest, wrap_u, wrap_v};
    float sum[CHANNELS];
    for (int c = 0; c < CHANNELS; ++c) sum[c] = 0;
    int count = 0, inside = 0;
    for (int s = 0; s < samples * samples; ++s)
    {
        const float2 p = VECTOR(float2)(i + (s % samples + 0.5f) / samples, j + (s / samples + 0.5f) / samples);
        nearest_place place = {-1, reach * reach, (float3)(0)};
        for (int n = first; n < last && place.squared_distance > 0; ++n) keep_nearer(&place, items[n], uv + 6 * items[n], p);
        const int f = place.triangle;
        if (f < 0) continue;
        float value[CHANNELS];
        for (int c = 0; c < CHANNELS; ++c) value[c] = 0;
        const float3 w = place.weights;
        if (source == 1)
            for (int c = 0; c < CHANNELS; ++c)
                value[c] = w.x * values[(3 * f) * CHANNELS + c] + w.y * values[(3 * f + 1) * CHANNELS + c] +
                           w.z * values[(3 * f + 2) * CHANNELS + c];
        else
            add_sample(value, &old,
                       w.x * vload2(3 * f, old_uv) + w.y * vload2(3 * f + 1, old_uv) + w.z * vload2(3 * f + 2, old_uv));
#if CHANNELS >= 3
        if (source >= 2)
            turn_normal(value, source == 3, w, normals + 9 * f, old_tangents + 12 * f, new_tangents + 12 * f, green,
                        VECTOR(float4)(turn_x, turn_y, after_x, after_y));
#endif
        for (int c = 0; c < CHANNELS; ++c) sum[c] += value[c];
        ++count;
        inside += place.squared_distance == 0;
    }
    for (int c = 0; c < CHANNELS; ++c) texels[CHANNELS * (size_t)at + c] = count > 0 ? sum[c] / count : 0;
    covered[at] = count == 0 ? 0 : inside > 0 ? 1 : 2;
}
