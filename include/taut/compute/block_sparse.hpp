// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <taut/compute/block_pattern.hpp>
#include <taut/compute/detail/kernels/block_sparse.hpp>
#include <taut/compute/sliced_lists.hpp>
#include <taut/compute/vector_space.hpp>

namespace taut
{

namespace detail
{

/// A kernel of kernels/block_sparse.cl for D x D blocks of T.
template <class T, class... Args>
void load_block_kernel(typed_kernel<Args...>& kernel, queue& q, const char* name, int D, lane_form form)
{
    const bool wide = std::is_same_v<T, double>;
    kernel = {q, kernels::block_sparse, name,
              std::string("-DREAL=") + cl_name<T>() + " -DREAL_IS_DOUBLE=" + (wide ? "1" : "0") +
                  " -DD=" + std::to_string(D) + " -DC=" + std::to_string(form.slice) +
                  " -DV=" + std::to_string(form.lanes) + " -DEPSILON=" + (wide ? "1e-12" : "2e-6f")};
}

} // namespace detail

/// A square block-sparse matrix on a device, with D x D blocks of T, and the inverses of its diagonal blocks. Vectors
/// have component c of row v at [c * stride() + v] and zeros as padding; make one with vector(). Values are 0 until
/// they are assembled, refreshed or uploaded. Nothing waits but upload, download and construction.
template <class T>
class block_matrix
{
public:
    block_matrix(taut::queue& q, block_pattern pattern, int D)
        : block_matrix(q, std::move(pattern), D, lane_form::for_device(q.device()))
    {
    }
    block_matrix(taut::queue& q, block_pattern pattern, int D, lane_form form)
        : queue_(q),
          pattern_(std::move(pattern)),
          D_(D),
          form_(form),
          stride_(padded(std::max<std::size_t>(pattern_.rows(), 1), 256)),
          lists_(pattern_.rows(), stride_, form.slice, [this](std::size_t r) { return pattern_.length(r); }),
          values_(q, lists_.size() * blocks()),
          inverse_(q, stride_ * d() * (d() + 1) / 2)
    {
        if (D < 2 || D > 3) throw parameter_error("D", "must be 2 or 3");
        if (lists_.size() * blocks() > static_cast<std::size_t>(std::numeric_limits<index>::max()))
            throw parameter_error("block_matrix", "more than 2^31 values");
        std::vector<index> columns(lists_.size());
        const auto C = static_cast<std::size_t>(form.slice);
        for (std::size_t r = 0; r < stride_; ++r)
        {
            const std::size_t n = r < pattern_.rows() ? pattern_.length(r) : 0;
            const auto width = static_cast<std::size_t>(lists_.offsets[r / C + 1] - lists_.offsets[r / C]) / C;
            for (std::size_t j = 0; j < width; ++j)
                columns[lists_.place(r, j)] = j < n ? pattern_.row(r)[j] : static_cast<index>(r);
        }
        offsets_ = buffer<index>(q, lists_.offsets);
        columns_ = buffer<index>(q, columns);
        values_.fill(0);
        inverse_.fill(0);
        detail::load_block_kernel<T>(product_, q, "product", D, form);
        detail::load_block_kernel<T>(residual_, q, "residual", D, form);
        detail::load_block_kernel<T>(smooth_, q, "smooth", D, form);
        detail::load_block_kernel<T>(jacobi_, q, "jacobi", D, form);
        detail::load_block_kernel<T>(invert_, q, "invert_blocks", D, form);
    }

    int block_size() const noexcept { return D_; }
    lane_form form() const noexcept { return form_; }
    std::size_t rows() const noexcept { return pattern_.rows(); }
    std::size_t stride() const noexcept { return stride_; }
    const block_pattern& pattern() const noexcept { return pattern_; }
    const sliced_lists& lists() const noexcept { return lists_; }
    taut::queue& queue() const noexcept { return queue_; }

    /// The zero vector of the space that the matrix acts on: D * stride() numbers.
    device_vector<T> vector() const { return {queue_, d() * stride_}; }

    /// y = A x; x and y differ.
    void multiply(const device_vector<T>& x, device_vector<T>& y) const
    {
        check(x, y);
        product_(items(), pitch(), offsets_, columns_, values_, x.data(), y.data());
    }
    /// r = b - A x; r may be b, not x.
    void residual(const device_vector<T>& x, const device_vector<T>& b, device_vector<T>& r) const
    {
        check(x, b, r);
        residual_(items(), pitch(), offsets_, columns_, values_, x.data(), b.data(), r.data());
    }
    /// out = now x + past before + scale B^-1 (b - A x) with B the block diagonal; out may be before, not x.
    void smooth(const device_vector<T>& b, const device_vector<T>& x, const device_vector<T>& before, double now,
                double past, double scale, device_vector<T>& out) const
    {
        check(b, x, before, out);
        smooth_(items(), pitch(), offsets_, columns_, values_, inverse_, b.data(), x.data(), before.data(), T(now),
                T(past), T(scale), out.data());
    }
    /// out = scale B^-1 b
    void jacobi(const device_vector<T>& b, double scale, device_vector<T>& out) const
    {
        check(b, out);
        jacobi_(items(), pitch(), inverse_, b.data(), T(scale), out.data());
    }

    /// Inverts the diagonal blocks; call it after the values have changed. Pivots are kept above a small multiple of
    /// the trace, and a block without a positive trace gets inverse 0, so that fixed rows stay 0.
    void invert_diagonal() { invert_(items(), pitch(), offsets_, values_, inverse_); }

    /// Values in the order of the pattern, D * D numbers a block, by rows.
    std::vector<T> download() const
    {
        const auto device = values_.download();
        std::vector<T> host(pattern_.columns.size() * blocks());
        each_block([&](std::size_t k, std::size_t e, std::size_t at) { host[k * blocks() + e] = device[at]; });
        return host;
    }
    void upload(std::span<const T> host)
    {
        if (host.size() != pattern_.columns.size() * blocks())
            throw parameter_error("block_matrix.upload", "D * D values a block are needed");
        std::vector<T> device(values_.size(), T(0));
        each_block([&](std::size_t k, std::size_t e, std::size_t at) { device[at] = host[k * blocks() + e]; });
        values_.upload(device);
    }

    /// Where entry 0 of nonzero j of row r is in values(); entry e is e * form().slice further on.
    std::size_t value_place(std::size_t r, std::size_t j) const
    {
        const std::size_t C = static_cast<std::size_t>(form_.slice), p = lists_.place(r, j);
        return p / C * C * blocks() + p % C;
    }
    buffer<T>& values() noexcept { return values_; }
    const buffer<T>& values() const noexcept { return values_; }
    const buffer<T>& inverse() const noexcept { return inverse_; }

    /// What one product must move: values, columns, the vector read once and the result written.
    std::size_t product_bytes() const { return values_.bytes() + columns_.bytes() + 2 * d() * stride_ * sizeof(T); }

private:
    std::size_t d() const { return static_cast<std::size_t>(D_); }
    std::size_t blocks() const { return d() * d(); }
    index pitch() const { return static_cast<index>(stride_); }
    range items() const { return form_.items(stride_); }

    template <class... Vectors>
    void check(const Vectors&... v) const
    {
        if (((v.padded_size() < d() * stride_) || ...))
            throw parameter_error("block_matrix", "vectors of " + std::to_string(d() * stride_) + " are needed");
    }
    template <class F>
    void each_block(const F& f) const
    {
        for (std::size_t r = 0; r < rows(); ++r)
            for (std::size_t j = 0; j < pattern_.length(r); ++j)
                for (std::size_t e = 0; e < blocks(); ++e)
                    f(static_cast<std::size_t>(pattern_.offsets[r]) + j, e,
                      value_place(r, j) + e * static_cast<std::size_t>(form_.slice));
    }

    mutable taut::queue queue_;
    block_pattern pattern_;
    int D_;
    lane_form form_;
    std::size_t stride_;
    sliced_lists lists_;
    buffer<T> values_, inverse_;
    buffer<index> offsets_, columns_;
    using in = const buffer<T>;
    using list = const buffer<index>;
    typed_kernel<index, list, list, in, in, buffer<T>> product_;
    typed_kernel<index, list, list, in, in, in, buffer<T>> residual_;
    typed_kernel<index, list, list, in, in, in, in, in, T, T, T, buffer<T>> smooth_;
    typed_kernel<index, in, in, T, buffer<T>> jacobi_;
    typed_kernel<index, list, in, buffer<T>> invert_;
};

} // namespace taut
