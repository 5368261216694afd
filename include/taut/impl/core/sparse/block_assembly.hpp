// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <taut/impl/core/sparse/assembly_lists.hpp>
#include <taut/impl/core/sparse/block_matrix.hpp>

namespace taut::impl
{

/// Sums element blocks (assembly_lists.hpp) into a block matrix. Deterministic, without atomics; one launch.
class block_assembly
{
public:
    /// For A and all matrices like it; the lists are of its pattern and may go afterwards. Throws parameter_error.
    block_assembly(const block_matrix& A, const assembly_lists& lists);

    /// Enqueues the sums into the values of A. Its diagonal is not inverted.
    void operator()(const real_buffer& blocks, block_matrix& A) const;

    /// Bytes of the lists.
    std::size_t bytes() const
    {
        return diagonal_offsets_.bytes() + diagonal_slots_.bytes() + slot_offsets_.bytes() + slots_.bytes();
    }

private:
    mutable queue queue_;
    range items_;
    std::size_t values_, reach_ = 0;
    idx cells_;
    buffer<idx> diagonal_offsets_, diagonal_slots_, slot_offsets_, slots_;
    impl::late_kernel assemble_;
};

} // namespace taut::impl
