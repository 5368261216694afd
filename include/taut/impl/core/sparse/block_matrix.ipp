// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include <taut/impl/core/compute/host/programs.hpp>
#include <taut/impl/core/compute/kernels/block_setup.hpp>
#include <taut/impl/core/compute/kernels/block_sparse.hpp>
#include <taut/impl/core/core/padded.hpp>
#include <taut/impl/core/sparse/block_matrix.hpp>

namespace taut::impl
{

own_program block_program(scalar_type real, int D, int K, lane_form form)
{
    static const std::string text = std::string(kernels::block_sparse) + kernels::block_setup;
    const bool wide = real == scalar_type::f64;
    return {.text = text,
            .host = host_blocks,
            .settings = {{"REAL", spelling(real)},
                         {"REAL_IS_DOUBLE", wide ? 1 : 0},
                         {"D", D},
                         {"K", K},
                         {"C", form.slice},
                         {"V", form.lanes},
                         {"TEAM", form.team()},
                         {"GROUP", lane_form::product_rows(static_cast<std::size_t>(K))},
                         {"SHARE", lane_form::share},
                         {"ITEMS", form.group()},
                         {"EPSILON", wide ? "1e-12" : "2e-6f"}},
            .real = real};
}

late_kernel transfer_kernel(queue q, const char* name, scalar_type real, int D, int K, lane_form form)
{
    return late_kernel([=]() mutable { return make_kernel(q, block_program(real, D, K, form), name); });
}

late_kernel block_kernel(const queue& q, const char* name, scalar_type real, int D, lane_form form)
{
    return transfer_kernel(q, name, real, D, D + 1, form);
}

block_matrix::block_matrix(taut::queue& q, scalar_type type, block_pattern pattern, int D, lane_form form)
    : shared_(std::make_shared<structure>(q, type, std::move(pattern), D, form)),
      values_(q, type, shared_->places * blocks()),
      inverse_(q, type, inverse_size())
{
    values_.fill(0);
    inverse_.fill(0);
}

void block_matrix::multiply(const device_vector& x, device_vector& y) const
{
    check(x, y);
    product(1, x, 0, x, y);
}

void block_matrix::residual(const device_vector& x, const device_vector& b, device_vector& r) const
{
    check(x, b, r);
    product(-1, x, 1, b, r);
}

void block_matrix::smooth(const device_vector& b, const device_vector& x, const device_vector& before, double now,
                          double past, double scale, device_vector& out) const
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

void block_matrix::jacobi(const device_vector& b, double scale, device_vector& out) const
{
    check(b, out);
    shared_->jacobi(
        items(), {{"stride", pitch()}, {"inverse", inverse()}, {"b", b.data()}, {"scale", scale}, {"out", out.data()}});
}

void block_matrix::invert_diagonal()
{
    if (inverse_.empty())
    {
        inverse_ = real_buffer(shared_->queue, type(), inverse_size());
        inverse_.fill(0);
    }
    shared_->invert(items(), {{"stride", pitch()}, {"offsets", offsets()}, {"A", values_}, {"inverse", inverse_}});
}

std::vector<double> block_matrix::download() const
{
    const auto device = values_.download();
    std::vector<double> host(device.size());
    for (std::size_t at = 0; at < host.size(); ++at) host[at] = device[device_place(at)];
    return host;
}

void block_matrix::upload(std::span<const double> host)
{
    if (host.size() != values_.size()) throw parameter_error("block_matrix.upload", "D * D values a place are needed");
    std::vector<double> device(host.size());
    for (std::size_t at = 0; at < host.size(); ++at) device[device_place(at)] = host[at];
    values_.upload(device);
}

const real_buffer& block_matrix::inverse() const
{
    if (inverse_.empty()) throw parameter_error("block_matrix", "call invert_diagonal() first");
    return inverse_;
}

void block_matrix::product(double a, const device_vector& x, double b, const device_vector& z, device_vector& y) const
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

block_matrix::structure::structure(taut::queue& q, scalar_type real, block_pattern pattern, int size, lane_form lanes)
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

const block_pattern& block_matrix::structure::pattern()
{
    if (host.columns.size() != places) host = {form.slice, rows, offsets.download(), columns.download()};
    return host;
}

block_matrix::block_matrix(std::shared_ptr<structure> shared)
    : shared_(std::move(shared)), values_(shared_->queue, type(), shared_->places * blocks())
{
    values_.fill(0);
}

std::size_t block_matrix::device_place(std::size_t at) const
{
    const std::size_t C = static_cast<std::size_t>(form().slice), place = at / blocks(), lane = place % C;
    return (place - lane) * blocks() + at % blocks() * C + lane;
}

} // namespace taut::impl
