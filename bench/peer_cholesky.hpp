// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <span>
#include <stdexcept>
#include <vector>

#include <cholmod.h>

#include "peer_problem.hpp"

namespace bench::peer
{

/// A CHOLMOD session: one thread, sparse matrices by reference, supernodal factors.
class cholmod
{
public:
    cholmod()
    {
        cholmod_start(&common_);
        common_.supernodal = CHOLMOD_SUPERNODAL;
        common_.print = 0;
    }
    ~cholmod() { cholmod_finish(&common_); }
    cholmod(const cholmod&) = delete;
    cholmod& operator=(const cholmod&) = delete;

    cholmod_common* get() { return &common_; }

private:
    cholmod_common common_;
};

/// A lower triangle as CHOLMOD sees it; value may be null.
inline cholmod_sparse view(int n, int* column, int* row, double* value)
{
    cholmod_sparse a{};
    a.nrow = a.ncol = static_cast<std::size_t>(n);
    a.nzmax = static_cast<std::size_t>(column[n]);
    a.p = column;
    a.i = row;
    a.x = value;
    a.stype = -1;
    a.itype = CHOLMOD_INT;
    a.xtype = value ? CHOLMOD_REAL : CHOLMOD_PATTERN;
    a.sorted = a.packed = 1;
    return a;
}

/// The new number of each vertex of a graph (lower triangle by columns) for little fill: the better of AMD and METIS.
inline std::vector<int> fill_reducing_rank(int n, std::vector<int> column, std::vector<int> row)
{
    cholmod session;
    session.get()->nmethods = 2; // the default would take METIS only where AMD does badly; it pays on all but the least
    session.get()->method[0].ordering = CHOLMOD_AMD;
    session.get()->method[1].ordering = CHOLMOD_METIS;
    auto a = view(n, column.data(), row.data(), nullptr);
    cholmod_factor* symbolic = cholmod_analyze(&a, session.get());
    if (!symbolic) throw std::runtime_error("cholmod_analyze failed");
    std::vector<int> rank(static_cast<std::size_t>(n));
    for (int k = 0; k < n; ++k) rank[static_cast<std::size_t>(static_cast<const int*>(symbolic->Perm)[k])] = k;
    cholmod_free_factor(&symbolic, session.get());
    return rank;
}

/// Supernodal factors of matrices with one pattern, whose numbering is already good: analysed once.
class cholesky
{
public:
    /// column, row, value outlive this.
    cholesky(std::vector<int>& column, std::vector<int>& row, std::vector<double>& value)
        : matrix_(view(static_cast<int>(column.size()) - 1, column.data(), row.data(), value.data()))
    {
        session_.get()->nmethods = 1;
        session_.get()->method[0].ordering = CHOLMOD_NATURAL;
        factor_ = cholmod_analyze(&matrix_, session_.get());
        if (!factor_) throw std::runtime_error("cholmod_analyze failed");
    }
    ~cholesky()
    {
        cholmod_free_factor(&factor_, session_.get());
        cholmod_free_dense(&solution_, session_.get());
        cholmod_free_dense(&first_, session_.get());
        cholmod_free_dense(&second_, session_.get());
    }
    cholesky(const cholesky&) = delete;
    cholesky& operator=(const cholesky&) = delete;

    /// False if the matrix is not positive definite.
    bool factorize()
    {
        cholmod_factorize(&matrix_, factor_, session_.get());
        if (session_.get()->status < CHOLMOD_OK) throw std::runtime_error("cholmod_factorize: out of memory");
        return session_.get()->status == CHOLMOD_OK;
    }

    /// Solves for the columns of b, one after the other.
    std::span<const double> solve(std::vector<double>& b)
    {
        cholmod_dense rhs{};
        rhs.nrow = rhs.d = matrix_.nrow;
        rhs.ncol = b.size() / rhs.nrow;
        rhs.nzmax = b.size();
        rhs.x = b.data();
        rhs.xtype = CHOLMOD_REAL;
        if (!cholmod_solve2(CHOLMOD_A, factor_, &rhs, nullptr, &solution_, nullptr, &first_, &second_, session_.get()))
            throw std::runtime_error("cholmod_solve failed");
        return {static_cast<const double*>(solution_->x), b.size()};
    }

private:
    cholmod session_;
    cholmod_sparse matrix_;
    cholmod_factor* factor_ = nullptr;
    cholmod_dense *solution_ = nullptr, *first_ = nullptr, *second_ = nullptr;
};

} // namespace bench::peer
