// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <taut/compute/block_transfer.hpp>
#include <taut/compute/dense_inverse.hpp>

namespace taut
{

struct multigrid_params
{
    double lambda_max = 3;         ///< bound on the spectrum of B^-1 A, B the block diagonal: corners of an element
    double lambda_ratio = 10;      ///< the smoother damps the spectrum from lambda_max / lambda_ratio on
    std::size_t dense_limit = 600; ///< unknowns of a coarsest level that is solved directly

    /// Throws parameter_error with the name of a field outside its domain.
    void validate() const
    {
        if (!(lambda_max > 0)) throw parameter_error("lambda_max", "must be positive");
        if (!(lambda_ratio > 1)) throw parameter_error("lambda_ratio", "must be more than 1");
    }
};

/// A symmetric geometric multigrid V-cycle as a preconditioner of a symmetric positive semi-definite block matrix: two
/// steps of Chebyshev iteration on block-Jacobi before and after each coarse correction, Galerkin matrices, a dense
/// inverse on the coarsest level. Assemble into matrix(), refresh(), then apply() at will; apply() only enqueues.
template <class T>
class multigrid
{
public:
    /// transfers[l]: from level l + 1 to level l; none leaves the smoother and, if it is small, the dense inverse.
    multigrid(block_matrix<T> finest, const std::vector<transfer_weights>& transfers,
              const multigrid_params& params = {})
        : params_(params)
    {
        params.validate();
        levels_.push_back(std::make_unique<level>(std::move(finest)));
        for (const auto& P : transfers)
        {
            const auto& fine = levels_.back()->A;
            auto coarse = std::make_unique<level>(
                block_matrix<T>(fine.queue(), pattern_of_product(fine.pattern(), P), fine.block_size(), fine.form()));
            transfers_.emplace_back(fine, P, coarse->A);
            levels_.push_back(std::move(coarse));
        }
        const auto& last = levels_.back()->A;
        detail::load_block_kernel<T>(dense_, last.queue(), "dense", last.block_size(), last.form());
        // Chebyshev iteration on [lambda_max / ratio, lambda_max] (Saad, Iterative Methods, algorithm 12.1).
        const double low = params.lambda_max / params.lambda_ratio, middle = (params.lambda_max + low) / 2,
                     half = (params.lambda_max - low) / 2, sigma = middle / half;
        const double rho = 1 / (2 * sigma - 1 / sigma);
        first_ = 1 / middle;
        momentum_ = rho / sigma;
        second_ = 2 * rho / half;
    }

    block_matrix<T>& matrix() noexcept { return levels_.front()->A; }
    const block_matrix<T>& matrix(std::size_t l = 0) const { return levels_[l]->A; }
    std::size_t levels() const noexcept { return levels_.size(); }
    bool solves_coarsest() const noexcept { return unknowns_ > 0; }
    /// Launches of one apply().
    std::size_t launches() const noexcept
    {
        const std::size_t last = solves_coarsest() ? (levels() == 1 ? 1 : 2) : (levels() == 1 ? 4 : 4);
        return levels() == 1 ? last : 6 * (levels() - 1) + last;
    }

    /// Makes the matrices of all levels follow the values of matrix(). Waits once to read the coarsest one and once or
    /// twice to write its inverse.
    void refresh()
    {
        levels_[0]->A.invert_diagonal();
        for (std::size_t l = 0; l < transfers_.size(); ++l)
        {
            transfers_[l].refresh(levels_[l]->A, levels_[l + 1]->A);
            levels_[l + 1]->A.invert_diagonal();
        }
        invert_coarsest();
    }

    /// x = M b, M symmetric and positive definite where the matrix sees anything; b and x differ.
    void apply(const device_vector<T>& b, device_vector<T>& x)
    {
        // The smoother's first step on the finest level; restriction makes it on the others.
        if (levels() > 1 || !solves_coarsest()) levels_[0]->A.jacobi(b, first_, levels_[0]->y);
        cycle(0, b, x);
    }

    /// Bytes of the lists of all transfers.
    std::size_t list_bytes() const
    {
        std::size_t sum = 0;
        for (const auto& t : transfers_) sum += t.bytes();
        return sum;
    }

private:
    struct level
    {
        explicit level(block_matrix<T> matrix)
            : A(std::move(matrix)), b(A.vector()), x(A.vector()), y(A.vector()), r(A.vector())
        {
        }
        block_matrix<T> A;
        device_vector<T> b, x, y, r; ///< right side, solution, the smoother's other iterate, residual
    };

    /// On entry y holds the smoother's first step from zero.
    void cycle(std::size_t l, const device_vector<T>& b, device_vector<T>& x)
    {
        level& here = *levels_[l];
        const bool last = l + 1 == levels();
        if (last && solves_coarsest())
        {
            if (l == 0) x.data().fill(0); // rows that the inverse leaves out; elsewhere x is our own and zero
            const auto form = here.A.form();
            dense_(form.items(pitch_), static_cast<index>(unknowns_), static_cast<index>(pitch_), at_, inverse_,
                   b.data(), x.data());
            return;
        }
        here.A.smooth(b, here.y, here.y, 1 + momentum_, 0, second_, x);
        if (!last)
        {
            level& coarse = *levels_[l + 1];
            here.A.residual(x, b, here.r);
            transfers_[l].restrict_residual(here.r, coarse.A, first_, coarse.b, coarse.y);
            cycle(l + 1, coarse.b, coarse.x);
            transfers_[l].prolong(coarse.x, x);
        }
        here.A.smooth(b, x, x, 1, 0, first_, here.y);
        here.A.smooth(b, here.y, x, 1 + momentum_, -momentum_, second_, x);
    }

    void invert_coarsest()
    {
        const auto& A = levels_.back()->A;
        const std::size_t D = static_cast<std::size_t>(A.block_size()), n = A.rows();
        constexpr std::size_t most_rows = 20000; // kept rows may be many and nearly all fixed
        unknowns_ = 0;
        if (n > most_rows) return;
        const auto values = A.download();
        const auto& p = A.pattern();
        // Numbers of the rows with a diagonal; fixed rows have none.
        std::vector<index> number(n, -1), at;
        std::vector<std::size_t> active;
        for (std::size_t r = 0; r < n; ++r)
        {
            bool positive = true;
            for (std::size_t c = 0; c < D; ++c)
                positive = positive && values[static_cast<std::size_t>(p.offsets[r]) * D * D + c * D + c] > 0;
            if (!positive) continue;
            number[r] = static_cast<index>(active.size());
            active.push_back(r);
        }
        const std::size_t m = D * active.size();
        if (m == 0 || m > params_.dense_limit) return;
        std::vector<double> full(m * m, 0.0);
        for (const std::size_t r : active)
            for (std::size_t c = 0; c < D; ++c)
            {
                at.push_back(static_cast<index>(c * A.stride() + r));
                const auto i = static_cast<std::size_t>(number[r]) * D + c;
                for (std::size_t j = 0; j < p.length(r); ++j)
                {
                    const index column = number[static_cast<std::size_t>(p.row(r)[j])];
                    if (column < 0) continue;
                    const std::size_t k = (static_cast<std::size_t>(p.offsets[r]) + j) * D * D + c * D;
                    for (std::size_t e = 0; e < D; ++e)
                        full[i * m + static_cast<std::size_t>(column) * D + e] = values[k + e];
                }
            }
        const auto inverse = detail::dense_inverse(std::move(full), m, std::is_same_v<T, double> ? 1e-8 : 1e-4);
        pitch_ = padded(m, static_cast<std::size_t>(A.form().slice));
        std::vector<T> rows(m * pitch_, T(0));
        for (std::size_t i = 0; i < m; ++i)
            for (std::size_t j = 0; j < m; ++j) rows[i * pitch_ + j] = T(inverse[i * m + j]);
        auto& q = A.queue();
        if (inverse_.size() != rows.size()) inverse_ = buffer<T>(q, rows.size());
        inverse_.upload(rows);
        if (at != host_at_)
        {
            at_ = buffer<index>(q, at);
            host_at_ = std::move(at);
            levels_.back()->x.data().fill(0); // rows that were solved for before
        }
        unknowns_ = m;
    }

    multigrid_params params_;
    std::vector<std::unique_ptr<level>> levels_;
    std::vector<block_transfer<T>> transfers_;
    double first_, momentum_, second_;
    std::size_t unknowns_ = 0, pitch_ = 0;
    std::vector<index> host_at_;
    buffer<index> at_;
    buffer<T> inverse_;
    using in = const buffer<T>;
    typed_kernel<index, index, const buffer<index>, in, in, buffer<T>> dense_;
};

/// Removes the influence of fixed rows: coarse vertices that are fixed get no weight, so no correction reaches or
/// leaves them. fixed: a flag a coarse row.
inline void drop_fixed(transfer_weights& P, std::span<const char> fixed)
{
    for (std::size_t i = 0; i < P.columns.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            if (fixed[static_cast<std::size_t>(P.columns[i][k])]) P.weights[i][k] = 0;
}

} // namespace taut
