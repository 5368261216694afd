// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <taut/impl/compute/kernels/block_sparse.hpp>
#include <taut/impl/compute/lane_form.hpp>
#include <taut/impl/compute/program/few_functions.hpp>
#include <taut/impl/compute/vector_space.hpp>
#include <taut/impl/sparse/block_pattern.hpp>

namespace taut::impl
{

/// Options of kernels/block_sparse.cl for D x D blocks and interpolations of K weights per row.
inline std::string block_options(scalar_type real, int D, int K, lane_form form)
{
    const bool wide = real == scalar_type::f64;
    return few_functions +
           ("-DREAL=" + std::string(spelling(real)) + " -DREAL_IS_DOUBLE=" + (wide ? "1" : "0") +
            " -DD=" + std::to_string(D) + " -DK=" + std::to_string(K) + " -DC=" + std::to_string(form.slice) +
            " -DV=" + std::to_string(form.lanes) + " -DTEAM=" + std::to_string(form.team()) +
            " -DGROUP=" + std::to_string(lane_form::product_rows(static_cast<std::size_t>(K))) +
            " -DSHARE=" + std::to_string(lane_form::share) + " -DITEMS=" + std::to_string(form.group()) +
            " -DEPSILON=" + (wide ? "1e-12" : "2e-6f"));
}

inline late_kernel transfer_kernel(queue q, const char* name, scalar_type real, int D, int K, lane_form form)
{
    return late_kernel([=]() mutable
                       { return kernel(q, kernels::block_sparse, name, block_options(real, D, K, form), real); });
}

/// A kernel that knows no interpolation: of the program that those of simplices with D + 1 corners are in.
inline late_kernel block_kernel(const queue& q, const char* name, scalar_type real, int D, lane_form form)
{
    return transfer_kernel(q, name, real, D, D + 1, form);
}

/// Says that matrices of simplices will be needed, some time before they are.
inline void expect_block_kernels(const queue& q, scalar_type real, int D)
{
    q.state()->cache.expect(kernels::block_sparse, block_options(real, D, D + 1, lane_form::for_device(q.device())));
}

/// A square block-sparse matrix on a device, with D x D blocks of float or double, and the inverses of its diagonal
/// blocks. Vectors have component c of row v at [c * stride() + v] and zeros as padding; make one with vector(). Values
/// are 0 until they are assembled, refreshed or uploaded. Nothing waits but upload, download and construction.
class block_matrix
{
public:
    block_matrix(taut::queue& q, scalar_type type, block_pattern pattern, int D)
        : block_matrix(q, type, std::move(pattern), D, lane_form::for_device(q.device()))
    {
    }
    /// The pattern has form.slice rows per slice. Throws parameter_error.
    block_matrix(taut::queue& q, scalar_type type, block_pattern pattern, int D, lane_form form)
        : shared_(std::make_shared<structure>(q, type, std::move(pattern), D, form)),
          values_(q, type, shared_->places * blocks()),
          inverse_(q, type, inverse_size())
    {
        values_.fill(0);
        inverse_.fill(0);
    }

    /// Another matrix of this pattern; it shares the lists and has its own values, 0 so far. Its diagonal has no
    /// inverses until invert_diagonal().
    block_matrix like() const { return block_matrix(shared_); }

    scalar_type type() const noexcept { return shared_->type; }
    int block_size() const noexcept { return shared_->D; }
    lane_form form() const noexcept { return shared_->form; }
    std::size_t rows() const noexcept { return shared_->rows; }
    std::size_t stride() const noexcept { return shared_->stride; }
    taut::queue& queue() const noexcept { return shared_->queue; }

    /// Waits to read it back after forget_pattern().
    const block_pattern& pattern() const { return shared_->pattern(); }
    /// Frees the host's copy of the pattern.
    void forget_pattern() { shared_->host = {}; }

    /// The zero vector of the space that the matrix acts on: D * stride() numbers.
    device_vector vector() const { return {shared_->queue, type(), d() * stride()}; }

    /// y = A x; x and y differ.
    void multiply(const device_vector& x, device_vector& y) const
    {
        check(x, y);
        product(1, x, 0, x, y);
    }
    /// r = b - A x; r may be b, not x.
    void residual(const device_vector& x, const device_vector& b, device_vector& r) const
    {
        check(x, b, r);
        product(-1, x, 1, b, r);
    }
    /// out = now x + past before + scale B^-1 (b - A x) with B the block diagonal; out may be before, not x.
    void smooth(const device_vector& b, const device_vector& x, const device_vector& before, double now, double past,
                double scale, device_vector& out) const
    {
        check(b, x, before, out);
        shared_->smooth(items(), {{"stride", pitch()},
                                  {"offsets", offsets()},
                                  {"columns", columns()},
                                  {"A", values_},
                                  {"inverse", inverse()},
                                  {"b", b.data()},
                                  {"x", x.data()},
                                  {"before", before.data()},
                                  {"now", now},
                                  {"past", past},
                                  {"scale", scale},
                                  {"out", out.data()}});
    }
    /// out = scale B^-1 b
    void jacobi(const device_vector& b, double scale, device_vector& out) const
    {
        check(b, out);
        shared_->jacobi(
            items(),
            {{"stride", pitch()}, {"inverse", inverse()}, {"b", b.data()}, {"scale", scale}, {"out", out.data()}});
    }

    /// Inverts the diagonal blocks; call it after the values have changed. Pivots are kept above a small multiple of
    /// the trace, and a block without a positive trace gets inverse 0, so that fixed rows stay 0.
    void invert_diagonal()
    {
        if (inverse_.empty())
        {
            inverse_ = real_buffer(shared_->queue, type(), inverse_size());
            inverse_.fill(0);
        }
        shared_->invert(items(), {{"stride", pitch()}, {"offsets", offsets()}, {"A", values_}, {"inverse", inverse_}});
    }

    /// Values by place of the pattern, D * D numbers per block, by rows.
    std::vector<double> download() const
    {
        const auto device = values_.download();
        std::vector<double> host(device.size());
        for (std::size_t at = 0; at < host.size(); ++at) host[at] = device[device_place(at)];
        return host;
    }
    void upload(std::span<const double> host)
    {
        if (host.size() != values_.size())
            throw parameter_error("block_matrix.upload", "D * D values a place are needed");
        std::vector<double> device(host.size());
        for (std::size_t at = 0; at < host.size(); ++at) device[device_place(at)] = host[at];
        values_.upload(device);
    }

    real_buffer& values() noexcept { return values_; }
    const real_buffer& values() const noexcept { return values_; }
    /// Packed inverses of the diagonal blocks. Throws parameter_error before they exist.
    const real_buffer& inverse() const
    {
        if (inverse_.empty()) throw parameter_error("block_matrix", "call invert_diagonal() first");
        return inverse_;
    }
    const buffer<idx>& offsets() const noexcept { return shared_->offsets; }
    const buffer<idx>& columns() const noexcept { return shared_->columns; }

    /// Bytes that one product moves: values, columns, the vector read once and the result written.
    std::size_t product_bytes() const
    {
        return values_.bytes() + columns().bytes() + 2 * d() * stride() * size_of(type());
    }
    /// Bytes on the device: values, inverses, and the lists that like() shares.
    std::size_t bytes() const { return values_.bytes() + inverse_.bytes() + offsets().bytes() + columns().bytes(); }

private:
    /// y = a A x + b z
    void product(double a, const device_vector& x, double b, const device_vector& z, device_vector& y) const
    {
        shared_->product(items(), {{"stride", pitch()},
                                   {"offsets", offsets()},
                                   {"columns", columns()},
                                   {"A", values_},
                                   {"a", a},
                                   {"x", x.data()},
                                   {"b", b},
                                   {"z", z.data()},
                                   {"y", y.data()}});
    }

    /// Data shared by matrices of one pattern.
    struct structure
    {
        structure(taut::queue& q, scalar_type real, block_pattern pattern, int size, lane_form lanes)
            : queue(q),
              type(real),
              D(size),
              form(lanes),
              rows(pattern.rows()),
              stride(padded(std::max<std::size_t>(pattern.rows(), 1), 256)),
              places(pattern.columns.size()),
              host(std::move(pattern))
        {
            if (D < 2 || D > 3) throw parameter_error("D", "must be 2 or 3");
            if (host.slice != form.slice) throw parameter_error("pattern", "has other slices than the device wants");
            if (places * static_cast<std::size_t>(D * D) > static_cast<std::size_t>(std::numeric_limits<idx>::max()))
                throw size_error("block_matrix", "more than 2^31 values");
            offsets = buffer<idx>(q, host.offsets);
            columns = buffer<idx>(q, host.columns);
            product = impl::block_kernel(q, "product", type, D, form);
            smooth = impl::block_kernel(q, "smooth", type, D, form);
            jacobi = impl::block_kernel(q, "jacobi", type, D, form);
            invert = impl::block_kernel(q, "invert_blocks", type, D, form);
        }

        const block_pattern& pattern()
        {
            if (host.columns.size() != places) host = {form.slice, rows, offsets.download(), columns.download()};
            return host;
        }

        taut::queue queue;
        scalar_type type;
        int D;
        lane_form form;
        std::size_t rows, stride, places;
        block_pattern host;
        buffer<idx> offsets, columns;
        impl::late_kernel product, smooth, jacobi, invert;
    };

    explicit block_matrix(std::shared_ptr<structure> shared)
        : shared_(std::move(shared)), values_(shared_->queue, type(), shared_->places * blocks())
    {
        values_.fill(0);
    }

    std::size_t d() const { return static_cast<std::size_t>(shared_->D); }
    std::size_t blocks() const { return d() * d(); }
    std::size_t inverse_size() const { return stride() * d() * (d() + 1) / 2; }
    idx pitch() const { return static_cast<idx>(stride()); }
    range items() const { return form().items(stride()); }

    /// Device index of entry at % (D * D) of the block at / (D * D).
    std::size_t device_place(std::size_t at) const
    {
        const std::size_t C = static_cast<std::size_t>(form().slice), place = at / blocks(), lane = place % C;
        return (place - lane) * blocks() + at % blocks() * C + lane;
    }

    template <class... Vectors>
    void check(const Vectors&... v) const
    {
        if (((v.padded_size() < d() * stride()) || ...))
            throw parameter_error("block_matrix", "vectors of " + std::to_string(d() * stride()) + " are needed");
    }

    std::shared_ptr<structure> shared_;
    real_buffer values_, inverse_;
};

} // namespace taut::impl
