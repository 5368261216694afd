// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/compute/kernel.hpp>
#include <taut/impl/core/compute/lane_form.hpp>
#include <taut/impl/core/compute/program/own_program.hpp>
#include <taut/impl/core/compute/queue_state.hpp>
#include <taut/impl/core/compute/vector_space.hpp>
#include <taut/impl/core/sparse/block_pattern.hpp>

namespace taut::impl
{

/// The program of all kernels on matrices, kernels/block_sparse.cl and block_setup.cl, for D x D blocks and
/// interpolations of K weights per row.
own_program block_program(scalar_type real, int D, int K, lane_form form);

late_kernel transfer_kernel(queue q, const char* name, scalar_type real, int D, int K, lane_form form);

/// A kernel that knows no interpolation: of the program that those of simplices with D + 1 corners are in.
late_kernel block_kernel(const queue& q, const char* name, scalar_type real, int D, lane_form form);

/// Says that matrices of simplices will be needed, some time before they are.
inline void expect_block_kernels(const queue& q, scalar_type real, int D)
{
    state_of(q)->commands->expect(block_program(real, D, D + 1, lane_form::for_device(q.device())));
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
    block_matrix(taut::queue& q, scalar_type type, block_pattern pattern, int D, lane_form form);

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
    void multiply(const device_vector& x, device_vector& y) const;
    /// r = b - A x; r may be b, not x.
    void residual(const device_vector& x, const device_vector& b, device_vector& r) const;
    /// out = now x + past before + scale B^-1 (b - A x) with B the block diagonal; out may be before, not x.
    void smooth(const device_vector& b, const device_vector& x, const device_vector& before, double now, double past,
                double scale, device_vector& out) const;
    /// out = scale B^-1 b
    void jacobi(const device_vector& b, double scale, device_vector& out) const;

    /// Inverts the diagonal blocks; call it after the values have changed. Pivots are kept above a small multiple of
    /// the trace, and a block without a positive trace gets inverse 0, so that fixed rows stay 0.
    void invert_diagonal();

    /// Values by place of the pattern, D * D numbers per block, by rows.
    std::vector<double> download() const;
    void upload(std::span<const double> host);

    real_buffer& values() noexcept { return values_; }
    const real_buffer& values() const noexcept { return values_; }
    /// Packed inverses of the diagonal blocks. Throws parameter_error before they exist.
    const real_buffer& inverse() const;
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
    void product(double a, const device_vector& x, double b, const device_vector& z, device_vector& y) const;

    /// Data shared by matrices of one pattern.
    struct structure
    {
        structure(taut::queue& q, scalar_type real, block_pattern pattern, int size, lane_form lanes);

        const block_pattern& pattern();

        taut::queue queue;
        scalar_type type;
        int D;
        lane_form form;
        std::size_t rows, stride, places;
        block_pattern host;
        buffer<idx> offsets, columns;
        impl::late_kernel product, smooth, jacobi, invert;
    };

    explicit block_matrix(std::shared_ptr<structure> shared);

    std::size_t d() const { return static_cast<std::size_t>(shared_->D); }
    std::size_t blocks() const { return d() * d(); }
    std::size_t inverse_size() const { return stride() * d() * (d() + 1) / 2; }
    idx pitch() const { return static_cast<idx>(stride()); }
    range items() const { return form().items(stride()); }

    /// Device index of entry at % (D * D) of the block at / (D * D).
    std::size_t device_place(std::size_t at) const;

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
