// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include <taut/impl/core/sparse/block_pattern.hpp>
#include <taut/impl/dist/processes/vertex_exchange.hpp>
#include <taut/impl/dist/shape/fixed_part.hpp>

namespace taut::dist::impl
{

/// A handle of PETSc with its destructor; collective, both.
template <class Object, PetscErrorCode (*Destroy)(Object*)>
class petsc_object
{
public:
    petsc_object() = default;
    explicit petsc_object(Object made) : object_(made, end) {}

    Object get() const { return object_.get(); }
    explicit operator bool() const { return bool(object_); }

private:
    static void end(Object object)
    {
        PetscBool over = PETSC_FALSE;
        PetscFinalized(&over);
        if (!over) Destroy(&object);
    }
    std::shared_ptr<std::remove_pointer_t<Object>> object_;
};

using petsc_matrix = petsc_object<Mat, MatDestroy>;
using petsc_vector = petsc_object<Vec, VecDestroy>;
using petsc_preconditioner = petsc_object<PC, PCDestroy>;
using petsc_solver = petsc_object<KSP, KSPDestroy>;
using petsc_null_space = petsc_object<MatNullSpace, MatNullSpaceDestroy>;

/// The rows of a matrix of B x B blocks, one block a vertex that may move: those of this process, complete, with
/// columns ascending as PETSc wants them. Vertices that are pinned have neither rows nor columns.
class free_rows
{
public:
    using numbers = std::vector<double>;

    free_rows() = default;

    /// Collective. pattern: of the vertices of the part; null where it has no elements. still: a flag per vertex.
    template <class Element>
    free_rows(const part<Element>& p, const taut::impl::block_pattern* pattern, const std::vector<char>& still,
              int block)
        : block_(block)
    {
        std::vector<std::int64_t> unknown(p.size(), -1);
        for (std::size_t v = 0; v < p.own; ++v)
            if (!still[v])
            {
                unknown[v] = static_cast<std::int64_t>(vertices_.size());
                vertices_.push_back(v);
            }
        const std::int64_t first = p.all.before(static_cast<std::int64_t>(vertices_.size()));
        total_ = p.all.sum(static_cast<std::int64_t>(vertices_.size()));
        for (auto& u : unknown)
            if (u >= 0) u += first;
        p.update(unknown);

        starts_.push_back(0);
        std::vector<column> row;
        for (const std::size_t v : vertices_)
        {
            row.clear();
            for (std::size_t j = 0; j < pattern->length(v); ++j)
                if (const auto w = static_cast<std::size_t>(pattern->column(v, j)); unknown[w] >= 0)
                    row.push_back({unknown[w], w, pattern->place(v, j)});
            std::sort(row.begin(), row.end(), [](const column& a, const column& b) { return a.unknown < b.unknown; });
            for (const auto& c : row)
            {
                columns_.push_back(static_cast<PetscInt>(c.unknown));
                neighbours_.push_back(static_cast<idx>(c.vertex));
                places_.push_back(static_cast<idx>(c.place));
            }
            starts_.push_back(columns_.size());
        }
        values_.resize(columns_.size() * static_cast<std::size_t>(block * block));
        make(p.all);
    }

    /// Unknown blocks of all processes.
    std::int64_t total() const { return total_; }
    /// Vertices with rows here, ascending.
    const std::vector<std::size_t>& vertices() const { return vertices_; }
    Mat matrix() const { return matrix_.get(); }
    int block() const { return block_; }

    petsc_vector make_vector() const
    {
        Vec x = nullptr;
        require(MatCreateVecs(matrix(), &x, nullptr));
        return petsc_vector(x);
    }

    /// Collective. Hands values to PETSc. entry(v, w, place, i, j): that of the block of vertices v and w.
    template <class Entry>
    void set(const Entry& entry)
    {
        const auto B = static_cast<std::size_t>(block_);
        for (std::size_t r = 0; r < vertices_.size(); ++r)
        {
            const std::size_t begin = starts_[r], n = starts_[r + 1] - begin;
            double* const row = values_.data() + begin * B * B;
            for (std::size_t c = 0; c < n; ++c)
                entry(vertices_[r], static_cast<std::size_t>(neighbours_[begin + c]),
                      static_cast<std::size_t>(places_[begin + c]),
                      [&](std::size_t i, std::size_t j, double value) { row[i * B * n + c * B + j] = value; });
        }
        require(MatUpdateMPIAIJWithArray(matrix(), values_.data()));
    }

    /// Numbers of the vertices with rows, from those of all owned ones.
    void gather(const numbers& from, const petsc_vector& to) const
    {
        const auto B = static_cast<std::size_t>(block_);
        PetscScalar* x = nullptr;
        require(VecGetArrayWrite(to.get(), &x));
        for (std::size_t r = 0; r < vertices_.size(); ++r)
            for (std::size_t k = 0; k < B; ++k) x[B * r + k] = from[B * vertices_[r] + k];
        require(VecRestoreArrayWrite(to.get(), &x));
    }
    /// The way back; other vertices get 0.
    void scatter(const petsc_vector& from, numbers& to) const
    {
        const auto B = static_cast<std::size_t>(block_);
        std::fill(to.begin(), to.end(), 0.0);
        const PetscScalar* x = nullptr;
        require(VecGetArrayRead(from.get(), &x));
        for (std::size_t r = 0; r < vertices_.size(); ++r)
            for (std::size_t k = 0; k < B; ++k) to[B * vertices_[r] + k] = x[B * r + k];
        require(VecRestoreArrayRead(from.get(), &x));
    }

private:
    struct column
    {
        std::int64_t unknown;
        std::size_t vertex, place;
    };

    void make(const communicator& all)
    {
        const auto B = static_cast<std::size_t>(block_);
        // As PETSc counts: a row of numbers for each of a block.
        std::vector<PetscInt> i{0}, j;
        j.reserve(columns_.size() * B * B);
        for (std::size_t r = 0; r + 1 < starts_.size(); ++r)
            for (std::size_t k = 0; k < B; ++k)
            {
                for (std::size_t c = starts_[r]; c < starts_[r + 1]; ++c)
                    for (std::size_t m = 0; m < B; ++m) j.push_back(columns_[c] * block_ + static_cast<PetscInt>(m));
                i.push_back(static_cast<PetscInt>(j.size()));
            }
        const auto n = static_cast<PetscInt>(B * vertices_.size());
        Mat made = nullptr;
        require(MatCreate(all.raw(), &made));
        matrix_ = petsc_matrix(made);
        require(MatSetSizes(made, n, n, PETSC_DETERMINE, PETSC_DETERMINE));
        require(MatSetBlockSize(made, block_));
        require(MatSetType(made, MATMPIAIJ));
        require(MatMPIAIJSetPreallocationCSR(made, i.data(), j.data(), values_.data()));
        require(MatSetOption(made, MAT_SPD, PETSC_TRUE));
        require(MatSetOption(made, MAT_SYMMETRIC, PETSC_TRUE));
        columns_ = {};
    }

    int block_ = 1;
    std::int64_t total_ = 0;
    std::vector<std::size_t> vertices_, starts_;
    std::vector<PetscInt> columns_;        ///< of blocks, while it is made
    std::vector<idx> neighbours_, places_; ///< of each block: its vertex, and its place in the pattern
    numbers values_;
    petsc_matrix matrix_;
};

} // namespace taut::dist::impl
