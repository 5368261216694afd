// SPDX-License-Identifier: MIT
// kernels/blas.cl, gather.cl and reduce.cl, for one set of instructions.

#include <taut/impl/core/compute/host/as_host_code.inl>

#define REAL float
#define REAL_IS_DOUBLE 0
namespace of_float
{
#include <taut/impl/core/compute/host/programs/real_vectors.inl>
} // namespace of_float
#undef REAL
#undef REAL_IS_DOUBLE

#define REAL double
#define REAL_IS_DOUBLE 1
namespace of_double
{
#include <taut/impl/core/compute/host/programs/real_vectors.inl>
} // namespace of_double
#undef REAL
#undef REAL_IS_DOUBLE

// As of a device without double precision, for rehearsals of one.
#define REAL float
#define REAL_IS_DOUBLE 0
#define FP64 0
#define L 1
#define V 8
struct vectors_without_double : work_item
{
#include <taut/impl/core/compute/host/kernels/blas.inl>
#include <taut/impl/core/compute/host/kernels/gather.inl>
#include <taut/impl/core/compute/host/kernels/reduce.inl>
};
#include <taut/impl/core/compute/host/kernels/undef.inl>
#undef FP64
#undef L
#undef V

#undef REAL
#undef REAL_IS_DOUBLE

#include <taut/impl/core/compute/host/as_opencl_code.inl>

template <class P>
std::vector<host_kernel> vector_kernels()
{
    return {entry<&P::step_along_float>::make("step_along_float", 4096),
            entry<&P::combine>::make("combine", 512),
            entry<&P::gather_float_2>::make("gather_float_2", 128),
            entry<&P::gather_float_3>::make("gather_float_3", 128),
            entry<&P::dots>::make("dots", 1),
            entry<&P::sums>::make("sums", 1),
            entry<&P::minima>::make("minima", 1),
            entry<&P::limit>::make("limit", 1)};
}

template <class P>
host_program vectors(const char* real)
{
    auto kernels = vector_kernels<P>();
    kernels.push_back(entry<&P::step_along_double>::make("step_along_double", 4096));
    kernels.push_back(entry<&P::gather_double_2>::make("gather_double_2", 128));
    kernels.push_back(entry<&P::gather_double_3>::make("gather_double_3", 128));
    return {{{"REAL", real}, {"FP64", 1}, {"L", 1}, {"V", 8}}, std::move(kernels)};
}

inline std::vector<host_program> vectors_programs()
{
    return {vectors<of_float::vectors>("float"),
            vectors<of_double::vectors>("double"),
            {{{"REAL", "float"}, {"FP64", 0}, {"L", 1}, {"V", 8}}, vector_kernels<vectors_without_double>()}};
}
