// SPDX-License-Identifier: MIT
// What kernels/*.cl need of OpenCL C, for C++ compilers with vector extensions (GCC, Clang). Included inside of a
// namespace, once for each instruction set; machine_bytes is then the size of its registers.

using ulong = std::uint64_t;
using uint = std::uint32_t;
using ushort = std::uint16_t;
using uchar = std::uint8_t;

// Compilers count what they inline, and leave vectors in memory where it is much.
#define TAUT_INLINE __attribute__((always_inline)) inline
#define TAUT_LANES [&](int k) __attribute__((always_inline))

/// Storage of N lanes. Registers of the machine: GCC takes wider vectors apart into single numbers for comparisons and
/// choices.
template <class T, int N>
struct registers
{
    static constexpr int lanes = N * int(sizeof(T)) < machine_bytes ? N : machine_bytes / int(sizeof(T));
    static constexpr int count = N / lanes;
    typedef T type __attribute__((vector_size(lanes * sizeof(T)), may_alias));
};
template <class T>
struct registers<T, 2>
{
    static constexpr int lanes = 1, count = 2;
    using type = T;
};
template <class T>
struct registers<T, 3>
{
    static constexpr int lanes = 1, count = 3;
    using type = T;
};

template <class T, int N>
struct vec;

template <class T, int N>
struct named_lanes;
template <class T>
struct named_lanes<T, 2>
{
    union
    {
        T h[2];
        T at[2];
        struct
        {
            T x, y;
        };
    };
};
template <class T>
struct named_lanes<T, 3>
{
    union
    {
        T h[3];
        T at[3];
        struct
        {
            T x, y, z;
        };
    };
};
template <class T>
struct named_lanes<T, 4>
{
    union
    {
        typename registers<T, 4>::type h[registers<T, 4>::count];
        T at[4];
        struct
        {
            T x, y, z, w;
        };
    };
};
template <class T>
struct named_lanes<T, 8>
{
    union
    {
        typename registers<T, 8>::type h[registers<T, 8>::count];
        T at[8];
        struct
        {
            T s0, s1, s2, s3, s4, s5, s6, s7;
        };
    };
};
template <class T>
struct named_lanes<T, 16>
{
    union
    {
        typename registers<T, 16>::type h[registers<T, 16>::count];
        T at[16];
        struct
        {
            T s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, sa, sb, sc, sd, se, sf;
        };
        struct
        {
            vec<T, 8> lo, hi;
        };
    };
};

template <class A>
concept number = std::is_arithmetic_v<A>;

/// A vector of OpenCL C.
template <class T, int N>
struct __attribute__((may_alias)) vec : named_lanes<T, N>
{
    using part = typename registers<T, N>::type;
    using mask = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;
    using mask_part = typename registers<mask, N>::type;
    static constexpr int parts = registers<T, N>::count, width = registers<T, N>::lanes;

    vec() = default;
    template <number A>
    TAUT_INLINE vec(A a)
    {
        const T t = static_cast<T>(a);
        for (int k = 0; k < parts; ++k) this->h[k] = t - part{};
    }
    template <number... A>
        requires(sizeof...(A) == N)
    TAUT_INLINE vec(A... a)
    {
        const T all[N] = {static_cast<T>(a)...};
        fill(all, std::make_index_sequence<std::size_t(width)>());
    }

    template <class F>
    TAUT_INLINE static vec each(F f)
    {
        vec r;
        for (int k = 0; k < parts; ++k) r.h[k] = f(k);
        return r;
    }

#define TAUT_BOTH(OP)                                                                                                  \
    TAUT_INLINE friend vec operator OP(const vec& a, const vec& b)                                                     \
    {                                                                                                                  \
        return each(TAUT_LANES { return a.h[k] OP b.h[k]; });                                                          \
    }                                                                                                                  \
    template <number A>                                                                                                \
    TAUT_INLINE friend vec operator OP(const vec& a, A b)                                                              \
    {                                                                                                                  \
        const T t = static_cast<T>(b);                                                                                 \
        return each(TAUT_LANES { return a.h[k] OP t; });                                                               \
    }                                                                                                                  \
    template <number A>                                                                                                \
    TAUT_INLINE friend vec operator OP(A a, const vec& b)                                                              \
    {                                                                                                                  \
        const T t = static_cast<T>(a);                                                                                 \
        return each(TAUT_LANES { return t OP b.h[k]; });                                                               \
    }                                                                                                                  \
    template <class A>                                                                                                 \
    TAUT_INLINE vec& operator OP##=(const A& b)                                                                        \
    {                                                                                                                  \
        return *this = *this OP b;                                                                                     \
    }
    TAUT_BOTH(+)
    TAUT_BOTH(-)
    TAUT_BOTH(*)
    TAUT_BOTH(/)
    TAUT_BOTH(&)
    TAUT_BOTH(|)
#undef TAUT_BOTH
    TAUT_INLINE vec operator-() const
    {
        return each(TAUT_LANES { return -this->h[k]; });
    }
    TAUT_INLINE vec operator~() const
    {
        return each(TAUT_LANES { return ~this->h[k]; });
    }
#define TAUT_COMPARED(OP)                                                                                              \
    TAUT_INLINE friend vec<mask, N> operator OP(const vec& a, const vec& b)                                            \
    {                                                                                                                  \
        return vec<mask, N>::each(TAUT_LANES { return mask_part(a.h[k] OP b.h[k]); });                                 \
    }                                                                                                                  \
    template <number A>                                                                                                \
    TAUT_INLINE friend vec<mask, N> operator OP(const vec& a, A b)                                                     \
    {                                                                                                                  \
        return a OP vec(b);                                                                                            \
    }
    TAUT_COMPARED(<)
    TAUT_COMPARED(<=)
    TAUT_COMPARED(>)
    TAUT_COMPARED(>=)
    TAUT_COMPARED(==)
    TAUT_COMPARED(!=)
#undef TAUT_COMPARED
    TAUT_INLINE vec<mask, N> operator!() const
    {
        return *this == 0;
    }
    TAUT_INLINE friend vec<mask, N> operator&&(const vec& a, const vec& b)
    {
        return (a != 0) & (b != 0);
    }

private:
    template <std::size_t... I>
    TAUT_INLINE void fill(const T* all, std::index_sequence<I...>)
    {
        for (int k = 0; k < parts; ++k)
        {
            if constexpr (width == 1)
                this->h[k] = all[k];
            else
                this->h[k] = part{all[std::size_t(k * width) + I]...};
        }
    }
};

/// Masks come from comparisons: all bits of a lane are equal.
template <class T, int N>
TAUT_INLINE vec<T, N> select(const vec<T, N>& no, const vec<T, N>& yes, const vec<typename vec<T, N>::mask, N>& test)
{
    using part = typename vec<T, N>::part;
    using mask_part = typename vec<T, N>::mask_part;
    return vec<T, N>::each(
        TAUT_LANES { return part((mask_part(yes.h[k]) & test.h[k]) | (mask_part(no.h[k]) & ~test.h[k])); });
}

// A number that is none gives way to the other one.
template <class T, int N>
TAUT_INLINE vec<T, N> fmax(const vec<T, N>& a, const vec<T, N>& b)
{
    return select(select(b, a, a > b), a, b != b);
}
template <class T, int N>
TAUT_INLINE vec<T, N> fmin(const vec<T, N>& a, const vec<T, N>& b)
{
    return select(select(b, a, a < b), a, b != b);
}
template <class T>
    requires std::is_floating_point_v<T> T fmax(T a, T b)
    {
        return a > b || b != b ? a : b;
    }
template <class T>
    requires std::is_floating_point_v<T> T fmin(T a, T b)
    {
        return a < b || b != b ? a : b;
    }
template <class T>
TAUT_INLINE T max(const T& a, const T& b)
{
    if constexpr (number<T>)
        return a < b ? b : a;
    else
        return select(b, a, a > b);
}
template <class T>
TAUT_INLINE T min(const T& a, const T& b)
{
    return b < a ? b : a;
}
template <class T>
TAUT_INLINE T clamp(const T& x, const T& low, const T& high)
{
    if constexpr (number<T>)
        return fmin(fmax(x, low), high);
    else
    {
        T r;
        for (int k = 0; k < T::parts; ++k) r.h[k] = clamp(x.h[k], low.h[k], high.h[k]);
        return r;
    }
}

#define TAUT_EACH_LANE(NAME, VALUE)                                                                                    \
    inline float NAME(float x)                                                                                         \
    {                                                                                                                  \
        return VALUE;                                                                                                  \
    }                                                                                                                  \
    inline double NAME(double x)                                                                                       \
    {                                                                                                                  \
        return VALUE;                                                                                                  \
    }                                                                                                                  \
    template <class T, int N>                                                                                          \
    vec<T, N> NAME(const vec<T, N>& a)                                                                                 \
    {                                                                                                                  \
        vec<T, N> r;                                                                                                   \
        for (int k = 0; k < N; ++k) r.at[k] = NAME(a.at[k]);                                                           \
        return r;                                                                                                      \
    }
TAUT_EACH_LANE(floor, std::floor(x))
TAUT_EACH_LANE(sqrt, std::sqrt(x))
TAUT_EACH_LANE(rsqrt, 1 / std::sqrt(x))
TAUT_EACH_LANE(log, std::log(x))
#undef TAUT_EACH_LANE
inline float fabs(float x)
{
    return std::fabs(x);
}
inline double fabs(double x)
{
    return std::fabs(x);
}
template <class T, int N>
TAUT_INLINE vec<T, N> fabs(const vec<T, N>& a)
{
    return select(a, -a, a < 0);
}
template <class T>
bool isfinite(T x)
{
    return x - x == 0;
}
template <class T, int N>
TAUT_INLINE auto isless(const vec<T, N>& a, const vec<T, N>& b)
{
    return a < b;
}
template <class T, int N>
TAUT_INLINE auto isnan(const vec<T, N>& a)
{
    return a != a;
}
inline ulong clz(ulong x)
{
    return static_cast<ulong>(__builtin_clzll(x));
}
inline float as_float(int x)
{
    return __builtin_bit_cast(float, x);
}
inline int as_int(float x)
{
    return __builtin_bit_cast(int, x);
}

template <class To, class T, int N>
TAUT_INLINE vec<To, N> convert(const vec<T, N>& a)
{
    if constexpr (std::is_same_v<To, T>)
        return a;
    else
    {
        // As many lanes of the one as a register of the other has.
        constexpr int step = registers<To, N>::lanes;
        typedef T some __attribute__((vector_size(step * sizeof(T)), may_alias));
        vec<To, N> r;
        for (int k = 0; k < vec<To, N>::parts; ++k)
        {
            some from;
            __builtin_memcpy(&from, a.at + k * step, sizeof from);
            r.h[k] = __builtin_convertvector(from, typename registers<To, N>::type);
        }
        return r;
    }
}

#define TAUT_TYPES(T, C, N) using T##N = vec<C, N>;
#define TAUT_CONVERSION(T, C, N)                                                                                       \
    template <class A>                                                                                                 \
    TAUT_INLINE T##N convert_##T##N(const vec<A, N>& a)                                                                \
    {                                                                                                                  \
        return convert<C>(a);                                                                                          \
    }
#define TAUT_MEMORY(N)                                                                                                 \
    template <class T>                                                                                                 \
    TAUT_INLINE vec<T, N> vload##N(std::size_t i, const T* p)                                                          \
    {                                                                                                                  \
        vec<T, N> r;                                                                                                   \
        __builtin_memcpy(&r, p + N * i, N * sizeof(T));                                                                \
        return r;                                                                                                      \
    }                                                                                                                  \
    template <class T>                                                                                                 \
    TAUT_INLINE void vstore##N(const vec<T, N>& a, std::size_t i, T* p)                                                \
    {                                                                                                                  \
        __builtin_memcpy(p + N * i, &a, N * sizeof(T));                                                                \
    }                                                                                                                  \
    TAUT_TYPES(float, float, N)                                                                                        \
    TAUT_TYPES(double, double, N)                                                                                      \
    TAUT_TYPES(int, std::int32_t, N)                                                                                   \
    TAUT_TYPES(long, std::int64_t, N)
TAUT_MEMORY(2)
TAUT_MEMORY(3)
TAUT_MEMORY(4)
TAUT_MEMORY(8)
TAUT_MEMORY(16)
#define TAUT_CONVERSIONS(N)                                                                                            \
    TAUT_CONVERSION(float, float, N)                                                                                   \
    TAUT_CONVERSION(double, double, N)                                                                                 \
    TAUT_CONVERSION(int, std::int32_t, N)                                                                              \
    TAUT_CONVERSION(long, std::int64_t, N)
TAUT_CONVERSIONS(8)
TAUT_CONVERSIONS(16)
#undef TAUT_CONVERSIONS
#undef TAUT_MEMORY
#undef TAUT_CONVERSION
#undef TAUT_TYPES

/// One work-item, alone in its group; a program is derived from it, with its kernels as members.
struct work_item
{
    std::size_t id = 0;
    const host_call* call = nullptr;

    std::size_t get_global_id(int) const { return id; }
    std::size_t get_group_id(int) const { return id; }
    std::size_t get_local_id(int) const { return 0; }
    std::size_t get_num_groups(int) const { return call->items; }

    /// Calls recorded function number k for the indices first, first + step, ... below last, which come last.
    template <class... A>
    void call_part(std::size_t k, A... a) const
    {
        const host_argument all[] = {a...};
        constexpr std::size_t n = sizeof...(A) - 3;
        const row_launch launch(*call->parts[k].rows, std::span(all, n));
        launch.run(static_cast<idx>(all[n].bits), static_cast<idx>(all[n + 1].bits), static_cast<idx>(all[n + 2].bits));
    }
};

/// A member function of a work-item as a kernel.
template <auto F>
struct entry;
template <class Program, class... A, void (Program::*F)(A...)>
struct entry<F>
{
    static void run(const host_call& call, std::size_t begin, std::size_t end)
    {
        run(call, begin, end, std::index_sequence_for<A...>());
    }
    static host_kernel make(const char* name, std::size_t grain)
    {
        std::uint64_t memory = 0, bit = 1;
        ((memory |= std::is_pointer_v<A> ? bit : 0, bit <<= 1), ...);
        return {name, run, sizeof...(A), memory, grain};
    }

private:
    template <std::size_t... I>
    static void run(const host_call& call, std::size_t begin, std::size_t end, std::index_sequence<I...>)
    {
        Program item;
        item.call = &call;
        const std::tuple<A...> values(value<A>(call.arguments[I])...);
        for (item.id = begin; item.id < end; ++item.id) (item.*F)(std::get<I>(values)...);
    }
    template <class T>
    static T value(const void* from)
    {
        T x;
        __builtin_memcpy(&x, from, sizeof x);
        return x;
    }
};

#undef TAUT_INLINE
#undef TAUT_LANES
