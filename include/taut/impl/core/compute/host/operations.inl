// SPDX-License-Identifier: MIT
// The operations on rows for one instruction set: included once a set, in a namespace of its own that has `bytes`, the
// size of its vectors, with the set as the compiler's target. So nothing else is included here.

// Vectors. A half has as many numbers as a vector has doubles.
typedef float vf __attribute__((vector_size(bytes)));
typedef double vd __attribute__((vector_size(bytes)));
typedef std::int32_t vi __attribute__((vector_size(bytes)));
typedef std::uint32_t vu __attribute__((vector_size(bytes)));
typedef std::int64_t vl __attribute__((vector_size(bytes)));
typedef float hf __attribute__((vector_size(bytes / 2)));
typedef std::int32_t hi __attribute__((vector_size(bytes / 2)));

/// A number or a vector anywhere in memory, whatever was there before.
template <class T>
TAUT_INLINE T get(const char* from)
{
    T x;
    std::memcpy(&x, from, sizeof x);
    return x;
}
template <class T>
TAUT_INLINE void put(char* to, T x)
{
    std::memcpy(to, &x, sizeof x);
}

/// d = F of the other rows, all vectors of as many numbers.
template <class F, class D, class... A>
struct map
{
    static void run(const row_operation& o, const row_frame& f) { run(o, f, std::index_sequence_for<A...>()); }

private:
    static constexpr std::ptrdiff_t lanes = sizeof(D) / sizeof(D{}[0]);
    template <class T>
    static constexpr std::ptrdiff_t size = sizeof(T);

    template <std::size_t... K>
    TAUT_INLINE static void run(const row_operation& o, const row_frame& f, std::index_sequence<K...>)
    {
        char* const d = f.rows[o.rows[0]];
        const char* const a[] = {f.rows[o.rows[K + 1]]...};
        const std::ptrdiff_t n = f.padded;
        for (std::ptrdiff_t i = 0; i < n; i += 4 * lanes)
        {
#pragma GCC unroll 4
            for (std::ptrdiff_t k = i; k < i + 4 * lanes; k += lanes)
                put<D>(d + k * (size<D> / lanes), F::of(get<A>(a[K] + k * (size<A> / lanes))...));
        }
    }
};

/// d = F of the other rows, one number after the other.
template <class F, class T, std::size_t... K>
void each(const row_operation& o, const row_frame& f)
{
    char* const d = f.rows[o.rows[0]];
    const char* const a[] = {f.rows[o.rows[K]]...};
    constexpr std::ptrdiff_t size = sizeof(T);
    for (std::ptrdiff_t i = 0; i < f.padded; ++i) put<T>(d + i * size, F::of(get<T>(a[K - 1] + i * size)...));
}

#define TAUT_ROW_1(NAME, X)                                                                                            \
    struct NAME                                                                                                        \
    {                                                                                                                  \
        template <class V>                                                                                             \
        TAUT_INLINE static auto of(V a)                                                                                \
        {                                                                                                              \
            return X;                                                                                                  \
        }                                                                                                              \
    };
#define TAUT_ROW_2(NAME, X)                                                                                            \
    struct NAME                                                                                                        \
    {                                                                                                                  \
        template <class V>                                                                                             \
        TAUT_INLINE static auto of(V a, V b)                                                                           \
        {                                                                                                              \
            return X;                                                                                                  \
        }                                                                                                              \
    };

TAUT_ROW_1(same, a)
TAUT_ROW_1(negative, -a)
TAUT_ROW_2(sum, a + b)
TAUT_ROW_2(difference, a - b)
TAUT_ROW_2(product, a* b)
TAUT_ROW_2(quotient, a / b)
TAUT_ROW_2(both, a& b)
TAUT_ROW_2(either, a | b)
TAUT_ROW_1(inverse, ~a)

// Functions of the host's library.
TAUT_ROW_1(floor_of, std::floor(a))
TAUT_ROW_1(exp_of, std::exp(a))
TAUT_ROW_1(log_of, std::log(a))
TAUT_ROW_1(sin_of, std::sin(a))
TAUT_ROW_1(cos_of, std::cos(a))
TAUT_ROW_1(tan_of, std::tan(a))
TAUT_ROW_1(atan_of, std::atan(a))
TAUT_ROW_2(pow_of, std::pow(a, b))

// Integers wrap; a division without a result gives any.
TAUT_ROW_2(integer_quotient, b == 0 ? 0 : b == -1 ? static_cast<V>(0u - static_cast<std::uint32_t>(a)) : a / b)
TAUT_ROW_2(integer_rest, b == 0 || b == -1 ? 0 : a % b)

/// Of a comparison: -1 where it holds, of 4 bytes.
template <class V>
TAUT_INLINE auto mask(V m)
{
    if constexpr (sizeof(m[0]) == 8)
        return __builtin_convertvector(m, hi);
    else
        return m;
}
TAUT_ROW_2(less, mask(a < b))
TAUT_ROW_2(less_equal, mask(a <= b))
TAUT_ROW_2(equal, mask(a == b))
TAUT_ROW_2(not_equal, mask(a != b))

struct choice
{
    TAUT_INLINE static vi of(vi m, vi a, vi b) { return (m & a) | (~m & b); }
    TAUT_INLINE static vl of(hi m, vl a, vl b)
    {
        const vl w = __builtin_convertvector(m, vl);
        return (w & a) | (~w & b);
    }
};

template <class To>
struct cast
{
    template <class V>
    TAUT_INLINE static To of(V a)
    {
        return __builtin_convertvector(a, To);
    }
};
template <class To>
struct cast_mask
{
    TAUT_INLINE static To of(auto m) { return __builtin_convertvector(-m, To); }
};
TAUT_ROW_1(nonzero, mask(a != V{}))

struct absolute
{
    TAUT_INLINE static vi of(vi a) { return a & 0x7fffffff; }
    TAUT_INLINE static vl of(vl a) { return a & 0x7fffffffffffffff; }
};

// In the assembler's words, for std::sqrt sets errno and no compiler then takes a vector.
#if defined(__x86_64__)
#define TAUT_ROW_SQRT(SSE, NEON)                                                                                       \
    if constexpr (bytes == 16)                                                                                         \
        __asm__(SSE " {%0, %0|%0, %0}" : "+x"(a));                                                                     \
    else                                                                                                               \
        __asm__("v" SSE " {%0, %0|%0, %0}" : "+v"(a));
#elif defined(__aarch64__)
#define TAUT_ROW_SQRT(SSE, NEON) __asm__("fsqrt %0" NEON ", %0" NEON : "+w"(a));
#else
#define TAUT_ROW_SQRT(SSE, NEON)                                                                                       \
    for (std::size_t k = 0; k < sizeof a / sizeof a[0]; ++k) a[k] = std::sqrt(a[k]);
#endif
struct square_root
{
    TAUT_INLINE static vf of(vf a)
    {
        TAUT_ROW_SQRT("sqrtps", ".4s")
        return a;
    }
    TAUT_INLINE static vd of(vd a)
    {
        TAUT_ROW_SQRT("sqrtpd", ".2d")
        return a;
    }
};
#undef TAUT_ROW_SQRT

/// As device_functions.hpp has it.
struct cube_root
{
    TAUT_INLINE static vf of(vf x)
    {
        const vi sign = (vi)x & std::numeric_limits<std::int32_t>::min();
        const vf a = (vf)absolute::of((vi)x);
        const vi tiny = (vi)(a < 0x1p-100f);
        const vf s = (vf)choice::of(tiny, (vi)(a * 0x1p+24f), (vi)a);
        vf r = (vf)(0x54a1f28c - __builtin_convertvector(__builtin_convertvector((vi)s, vf) * (1.0f / 3), vi));
        const vf h = 1 - (s * r) * (r * r);
        r = r + r * h * (1.0f / 3 + h * (2.0f / 9 + h * (14.0f / 81)));
        const vf y = s * (r * r), z = y - (y * y * y - s) * (r * r) * (1.0f / 3);
        const vi w = choice::of(tiny, (vi)(z * 0x1p-8f), (vi)z) | sign;
        return (vf)choice::of((vi)(a > 0) & (vi)(a < __builtin_inff()), w, (vi)x);
    }
    TAUT_INLINE static vd of(vd x)
    {
        const vl sign = (vl)x & std::numeric_limits<std::int64_t>::min();
        const vd a = (vd)absolute::of((vl)x);
        const hi tiny = mask(a < 0x1p-1000);
        const vd s = (vd)choice::of(tiny, (vl)(a * 0x1p+54), (vl)a);
        const hf third = __builtin_convertvector(__builtin_convertvector((vl)s >> 32, hi), hf) * (1.0f / 3);
        vd r = (vd)(__builtin_convertvector(0x553ee8fc - __builtin_convertvector(third, hi), vl) << 32);
        for (int k = 0; k < 2; ++k)
        {
            const vd h = 1 - (s * r) * (r * r);
            r = r + r * h * (1.0 / 3 + h * (2.0 / 9 + h * (14.0 / 81)));
        }
        const vd y = s * (r * r), z = y - (y * y * y - s) * (r * r) * (1.0 / 3);
        const vl w = choice::of(tiny, (vl)(z * 0x1p-18), (vl)z) | sign;
        return (vd)choice::of(mask(a > 0) & mask(a < __builtin_inf()), w, (vl)x);
    }
};
struct third_root // NaN where x < 0, but not of -0
{
    TAUT_INLINE static vf of(vf x)
    {
        return (vf)choice::of((vi)(x < 0), (vi)(vf{} + __builtin_nanf("")), (vi)cube_root::of(x));
    }
    TAUT_INLINE static vd of(vd x)
    {
        return (vd)choice::of(mask(x < 0), (vl)(vd{} + __builtin_nan("")), (vl)cube_root::of(x));
    }
};

/// x = a I b, then x O c. Products and sums stand in one expression, so that the compiler may contract them.
template <class I, int O>
struct pair
{
    template <class V>
    TAUT_INLINE static V of(V a, V b, V c)
    {
        constexpr bool contracts = std::is_same_v<I, product>;
        if constexpr (O == row_code::times)
            return I::of(a, b) * c;
        else if constexpr (O == row_code::plus)
            return contracts ? a * b + c : I::of(a, b) + c;
        else if constexpr (O == row_code::minus)
            return contracts ? a * b - c : I::of(a, b) - c;
        else
            return contracts ? c - a * b : c - I::of(a, b);
    }
};
/// (a I b) O (c J e).
template <class I, class J, int O>
struct join
{
    template <class V>
    TAUT_INLINE static V of(V a, V b, V c, V e)
    {
        if constexpr (std::is_same_v<I, product>)
            return pair<I, O>::of(a, b, J::of(c, e));
        else
            return pair < J, O == row_code::minus ? row_code::from : O > ::of(c, e, I::of(a, b));
    }
};

// Memory: a place that is not ours is not touched.
template <class T>
struct memory
{
    static constexpr std::ptrdiff_t size = sizeof(T);

    /// Where rows[k] is an argument, and rows[k + 1] the uniform to add to the index, if any.
    static char* place(const row_operation& o, const row_frame& f, std::size_t k, std::ptrdiff_t index)
    {
        const int offset = o.rows[k + 1];
        return f.memory[o.rows[k]] +
               size *
                   (index + (offset < 0 ? 0 : static_cast<std::int32_t>(f.uniforms[static_cast<std::size_t>(offset)])));
    }
    TAUT_INLINE static T at(const char* from, std::ptrdiff_t i) { return get<T>(from + size * i); }
    TAUT_INLINE static std::int32_t integer(const char* from, std::ptrdiff_t i)
    {
        return get<std::int32_t>(from + 4 * i);
    }

    static void load(const row_operation& o, const row_frame& f)
    {
        char* const d = f.rows[o.rows[0]];
        const char* const a = place(o, f, 1, f.first);
        for (std::ptrdiff_t i = 0; i < f.padded; ++i) put(d + size * i, at(a, f.step * std::min(i, f.n - 1)));
    }
    static void store(const row_operation& o, const row_frame& f)
    {
        const char* const a = f.rows[o.rows[0]];
        char* const d = place(o, f, 1, f.first);
        for (std::ptrdiff_t i = 0; i < f.n; ++i) put(d + size * f.step * i, at(a, i));
    }
    static void gather(const row_operation& o, const row_frame& f)
    {
        char* const d = f.rows[o.rows[0]];
        const char *const index = f.rows[o.rows[1]], *const a = place(o, f, 2, 0);
        for (std::ptrdiff_t i = 0; i < f.padded; i += 2)
        {
            const T x = at(a, integer(index, i)), y = at(a, integer(index, i + 1));
            put(d + size * i, x);
            put(d + size * (i + 1), y);
        }
    }
    static void masked(const row_operation& o, const row_frame& f)
    {
        char* const d = f.rows[o.rows[0]];
        const char *const index = f.rows[o.rows[1]], *const m = f.rows[o.rows[4]], *const a = place(o, f, 2, 0);
        for (std::ptrdiff_t i = 0; i < f.padded; ++i)
            put(d + size * i, integer(m, i) ? at(a, integer(index, i)) : T(0));
    }
    static void scatter(const row_operation& o, const row_frame& f)
    {
        const char *const a = f.rows[o.rows[0]], *const index = f.rows[o.rows[1]];
        char* const d = f.memory[o.rows[2]];
        for (std::ptrdiff_t i = 0; i < f.n; ++i) put(d + size * integer(index, i), at(a, i));
    }
    /// The sum of summand over counter = begin, ..., end - 1; the body runs until none is left.
    static void loop(const row_operation& o, const row_frame& f)
    {
        char *const sum = f.rows[o.rows[0]], *const counter = f.rows[o.rows[4]], *const active = f.rows[o.rows[5]];
        const char *const begin = f.rows[o.rows[1]], *const end = f.rows[o.rows[2]], *const summand = f.rows[o.rows[3]];
        const char* const around = o.rows[6] < 0 ? nullptr : f.rows[o.rows[6]];
        for (std::ptrdiff_t i = 0; i < f.padded; ++i) put(sum + size * i, T(0));
        for (std::uint32_t k = 0;; ++k)
        {
            std::int32_t some = 0;
            for (std::ptrdiff_t i = 0; i < f.padded; ++i)
            {
                const std::int32_t from = integer(begin, i), to = integer(end, i);
                const auto count = static_cast<std::uint32_t>(to) - static_cast<std::uint32_t>(from);
                const std::int32_t on = -std::int32_t{from < to && k < count} & (around ? integer(around, i) : -1);
                put(counter + 4 * i, static_cast<std::uint32_t>(from) + k);
                put(active + 4 * i, on);
                some |= on;
            }
            if (!some) break;
            run_rows(&o + 1, &o + 1 + o.body, f);
            for (std::ptrdiff_t i = 0; i < f.padded; ++i)
                if (integer(active, i)) put(sum + size * i, plus(at(sum, i), at(summand, i)));
        }
    }
    static T plus(T a, T b)
    {
        if constexpr (std::is_same_v<T, std::int32_t>)
            return static_cast<T>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
        else
            return a + b;
    }
};

inline void index(const row_operation& o, const row_frame& f)
{
    char* const d = f.rows[o.rows[0]];
    const auto first = static_cast<std::int32_t>(f.uniforms[static_cast<std::size_t>(o.rows[1])]) + f.first;
    for (std::ptrdiff_t i = 0; i < f.padded; ++i)
        put(d + 4 * i, static_cast<std::int32_t>(first + f.step * std::min(i, f.n - 1)));
}

#undef TAUT_ROW_1
#undef TAUT_ROW_2
