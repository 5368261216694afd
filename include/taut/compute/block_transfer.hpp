// SPDX-License-Identifier: MIT
#pragma once

#include <numeric>

#include <taut/compute/block_sparse.hpp>

namespace taut
{

/// Between a fine and a coarse block matrix: interpolation P, restriction P' and the values of P' A P, each one launch
/// through lists made once. Weights are T.
template <class T>
class block_transfer
{
public:
    /// The coarse matrix has the pattern pattern_of_product(fine.pattern(), P).
    block_transfer(const block_matrix<T>& fine, const transfer_weights& P, const block_matrix<T>& coarse)
        : queue_(fine.queue()),
          form_(fine.form()),
          fine_stride_(static_cast<index>(fine.stride())),
          stride_(static_cast<index>(coarse.stride()))
    {
        if (P.columns.size() != fine.rows() || P.weights.size() != fine.rows() || P.coarse != coarse.rows())
            throw parameter_error("transfer_weights", "does not fit the matrices");
        const auto t = P.transpose();
        make_prolongation(P);
        make_restriction(P, t);
        make_galerkin(fine, P, t, coarse);
        const int D = fine.block_size();
        detail::load_block_kernel<T>(prolong_, queue_, "prolong", D, form_);
        detail::load_block_kernel<T>(restrict_, queue_, "restrict_residual", D, form_);
        detail::load_block_kernel<T>(galerkin_, queue_, "galerkin", D, form_);
    }

    /// x += P coarse
    void prolong(const device_vector<T>& coarse, device_vector<T>& x) const
    {
        prolong_(form_.items(static_cast<std::size_t>(fine_stride_)), fine_stride_, stride_, columns_, weights_,
                 coarse.data(), x.data());
    }
    /// b = P' r and x = scale B^-1 b, with B the block diagonal of the coarse matrix
    void restrict_residual(const device_vector<T>& r, const block_matrix<T>& coarse, double scale, device_vector<T>& b,
                           device_vector<T>& x) const
    {
        restrict_(form_.items(static_cast<std::size_t>(stride_)), fine_stride_, stride_, row_offsets_, rows_,
                  row_weights_, r.data(), coarse.inverse(), T(scale), b.data(), x.data());
    }
    /// coarse = P' fine P. The diagonal is not inverted.
    void refresh(const block_matrix<T>& fine, block_matrix<T>& coarse) const
    {
        galerkin_(form_.items(static_cast<std::size_t>(slices_ * form_.slice)), slices_, term_offsets_, terms_,
                  term_weights_, targets_, fine.values(), coarse.values());
    }

    /// Bytes of the lists.
    std::size_t bytes() const
    {
        return columns_.bytes() + weights_.bytes() + rows_.bytes() + row_weights_.bytes() + terms_.bytes() +
               term_weights_.bytes() + targets_.bytes();
    }

private:
    void make_prolongation(const transfer_weights& P)
    {
        const auto stride = static_cast<std::size_t>(fine_stride_);
        std::vector<index> columns(3 * stride, 0);
        std::vector<T> weights(3 * stride, T(0));
        for (std::size_t i = 0; i < P.columns.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
                columns[k * stride + i] = P.columns[i][k], weights[k * stride + i] = T(P.weights[i][k]);
        columns_ = buffer<index>(queue_, columns);
        weights_ = buffer<T>(queue_, weights);
    }

    void make_restriction(const transfer_weights& P, const transfer_weights::transposed& t)
    {
        const sliced_lists lists(P.coarse, static_cast<std::size_t>(stride_), form_.slice,
                                 [&](std::size_t J) { return t.offsets[J + 1] - t.offsets[J]; });
        std::vector<index> rows(lists.size(), 0);
        std::vector<T> weights(lists.size(), T(0));
        for (std::size_t J = 0; J < P.coarse; ++J)
            for (index k = t.offsets[J]; k < t.offsets[J + 1]; ++k)
            {
                const auto from = static_cast<std::size_t>(t.places[static_cast<std::size_t>(k)]);
                const std::size_t at = lists.place(J, static_cast<std::size_t>(k - t.offsets[J]));
                rows[at] = static_cast<index>(from / 3);
                weights[at] = T(P.weights[from / 3][from % 3]);
            }
        row_offsets_ = buffer<index>(queue_, lists.offsets);
        rows_ = buffer<index>(queue_, rows);
        row_weights_ = buffer<T>(queue_, weights);
    }

    void make_galerkin(const block_matrix<T>& fine, const transfer_weights& P, const transfer_weights::transposed& t,
                       const block_matrix<T>& coarse)
    {
        const auto& pattern = coarse.pattern();
        const std::size_t n = pattern.columns.size(), C = static_cast<std::size_t>(form_.slice);
        // Number in the pattern of each column of the row at hand.
        std::vector<index> number(P.coarse, -1), length(n, 0), order(padded(n, C), -1);
        const auto each = [&](const auto& visit)
        {
            for (std::size_t I = 0; I < P.coarse; ++I)
            {
                for (index k = pattern.offsets[I]; k < pattern.offsets[I + 1]; ++k)
                    number[static_cast<std::size_t>(pattern.columns[static_cast<std::size_t>(k)])] = k;
                visit_terms(fine.pattern(), P, t, I,
                            [&](std::size_t i, std::size_t j, double w, index J)
                            { visit(static_cast<std::size_t>(number[static_cast<std::size_t>(J)]), i, j, w); });
            }
        };
        each([&](std::size_t k, std::size_t, std::size_t, double) { ++length[k]; });

        // Lists of like length share a slice, within windows that keep their neighbourhood.
        constexpr std::size_t window = 4096;
        std::iota(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(n), 0);
        for (std::size_t first = 0; first < n; first += window)
            std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(first),
                             order.begin() + static_cast<std::ptrdiff_t>(std::min(first + window, n)),
                             [&](index a, index b)
                             { return length[static_cast<std::size_t>(a)] > length[static_cast<std::size_t>(b)]; });
        const sliced_lists lists(n, order.size(), form_.slice,
                                 [&](std::size_t r) { return length[static_cast<std::size_t>(order[r])]; });
        std::vector<index> rank(n), terms(lists.size(), 0), targets(order.size(), -1);
        for (std::size_t r = 0; r < n; ++r) rank[static_cast<std::size_t>(order[r])] = static_cast<index>(r);
        std::vector<T> weights(lists.size(), T(0));
        std::fill(length.begin(), length.end(), 0);
        each(
            [&](std::size_t k, std::size_t i, std::size_t j, double w)
            {
                const std::size_t at =
                    lists.place(static_cast<std::size_t>(rank[k]), static_cast<std::size_t>(length[k]++));
                terms[at] = static_cast<index>(fine.value_place(i, j));
                weights[at] = T(w);
            });
        for (std::size_t I = 0; I < P.coarse; ++I)
            for (std::size_t j = 0; j < pattern.length(I); ++j)
                targets[static_cast<std::size_t>(rank[static_cast<std::size_t>(pattern.offsets[I]) + j])] =
                    static_cast<index>(coarse.value_place(I, j));
        slices_ = static_cast<index>(order.size() / C);
        term_offsets_ = buffer<index>(queue_, lists.offsets);
        terms_ = buffer<index>(queue_, terms);
        term_weights_ = buffer<T>(queue_, weights);
        targets_ = buffer<index>(queue_, targets);
    }

    mutable queue queue_;
    lane_form form_;
    index fine_stride_, stride_, slices_ = 0;
    buffer<index> columns_, row_offsets_, rows_, term_offsets_, terms_, targets_;
    buffer<T> weights_, row_weights_, term_weights_;
    using in = const buffer<T>;
    using list = const buffer<index>;
    typed_kernel<index, index, list, in, in, buffer<T>> prolong_;
    typed_kernel<index, index, list, list, in, in, in, T, buffer<T>, buffer<T>> restrict_;
    typed_kernel<index, list, list, in, list, in, buffer<T>> galerkin_;
};

} // namespace taut
