// SPDX-License-Identifier: MIT
#include "direct_solver.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "peer_cholesky.hpp"

namespace bench
{

namespace
{

class cholmod_solver final : public direct_solver
{
public:
    cholmod_solver(const taut::block_rows<3>& pattern, const std::vector<bool>& free) : rank_(free.size(), -1)
    {
        int n = 0;
        for (std::size_t v = 0; v < free.size(); ++v)
            if (free[v]) rank_[v] = n++;
        auto [offsets, rows] = lower(pattern, n);
        const auto better = peer::fill_reducing_rank(n, std::move(offsets), std::move(rows));
        for (int& r : rank_)
            if (r >= 0) r = better[static_cast<std::size_t>(r)];

        const auto [first, below] = lower(pattern, n);
        column_.push_back(0);
        for (int c = 0; c < n; ++c)
            for (int j = 0; j < 3; ++j)
            {
                for (int k = first[static_cast<std::size_t>(c)]; k < first[static_cast<std::size_t>(c) + 1]; ++k)
                    for (int i = k == first[static_cast<std::size_t>(c)] ? j : 0; i < 3; ++i)
                        row_.push_back(3 * below[static_cast<std::size_t>(k)] + i);
                column_.push_back(static_cast<int>(row_.size()));
            }
        value_.resize(row_.size());
        b_.resize(column_.size() - 1);
        factor_.emplace(column_, row_, value_);
    }

    bool factorize(const taut::block_rows<3>& m) override
    {
        for (std::size_t v = 0; v < rank_.size(); ++v)
            for (taut::idx k = m.offsets[v]; k < m.offsets[v + 1]; ++k)
            {
                const int r = rank_[static_cast<std::size_t>(m.columns[static_cast<std::size_t>(k)])], c = rank_[v];
                if (r < 0 || c < 0 || r < c) continue;
                const auto& block = m.blocks[static_cast<std::size_t>(k)]; // of row v and column r: its transpose
                for (int j = 0; j < 3; ++j)
                {
                    const auto begin = row_.begin() + column_[static_cast<std::size_t>(3 * c + j)],
                               end = row_.begin() + column_[static_cast<std::size_t>(3 * c + j) + 1];
                    const int from = r == c ? j : 0;
                    auto at = static_cast<std::size_t>(std::lower_bound(begin, end, 3 * r + from) - row_.begin());
                    for (int i = from; i < 3; ++i) value_[at++] = block[i][j];
                }
            }
        return factor_->factorize();
    }

    void solve(std::span<const taut::vec3> b, std::span<taut::vec3> d) override
    {
        for (std::size_t v = 0; v < rank_.size(); ++v)
            for (int k = 0; k < 3; ++k)
                if (rank_[v] >= 0) b_[static_cast<std::size_t>(3 * rank_[v] + k)] = b[v][k];
        const auto x = factor_->solve(b_);
        for (std::size_t v = 0; v < rank_.size(); ++v)
            for (int k = 0; k < 3; ++k) d[v][k] = rank_[v] < 0 ? 0 : x[static_cast<std::size_t>(3 * rank_[v] + k)];
    }

private:
    /// The lower triangle of the free part by columns, in the numbers of rank_.
    std::pair<std::vector<int>, std::vector<int>> lower(const taut::block_rows<3>& m, int n) const
    {
        std::vector<std::vector<int>> columns(static_cast<std::size_t>(n));
        for (std::size_t v = 0; v < rank_.size(); ++v)
            for (taut::idx k = m.offsets[v]; rank_[v] >= 0 && k < m.offsets[v + 1]; ++k)
                if (const int r = rank_[static_cast<std::size_t>(m.columns[static_cast<std::size_t>(k)])];
                    r >= rank_[v])
                    columns[static_cast<std::size_t>(rank_[v])].push_back(r);
        std::pair<std::vector<int>, std::vector<int>> result;
        result.first.push_back(0);
        for (auto& c : columns)
        {
            std::sort(c.begin(), c.end());
            result.second.insert(result.second.end(), c.begin(), c.end());
            result.first.push_back(static_cast<int>(result.second.size()));
        }
        return result;
    }

    std::vector<int> rank_; ///< of each vertex in the factor, or -1
    std::vector<int> column_, row_;
    std::vector<double> value_, b_;
    std::optional<peer::cholesky> factor_;
};

} // namespace

std::unique_ptr<direct_solver> make_direct_solver(const taut::block_rows<3>& pattern, const std::vector<bool>& free)
{
    return std::make_unique<cholmod_solver>(pattern, free);
}

} // namespace bench
