// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/impl/core/sparse/block_assembly.hpp>

namespace taut::impl
{

block_assembly::block_assembly(const block_matrix& A, const assembly_lists& lists)
    : queue_(A.queue()),
      items_(A.form().items(A.stride())),
      values_(A.values().size()),
      reach_(lists.reach),
      cells_(static_cast<idx>(lists.cell_stride)),
      diagonal_offsets_(queue_, lists.diagonal_offsets),
      diagonal_slots_(queue_, lists.diagonal),
      slot_offsets_(queue_, lists.other_offsets),
      slots_(queue_, lists.others)
{
    if (lists.places != A.columns().size())
        throw parameter_error("assembly_lists", "are of another pattern than the matrix");
    assemble_ = impl::block_kernel(queue_, "assemble", A.type(), A.block_size(), A.form());
}

void block_assembly::operator()(const real_buffer& blocks, block_matrix& A) const
{
    if (blocks.size() < reach_ || A.values().size() != values_)
        throw parameter_error("block_assembly", "blocks of " + std::to_string(reach_) +
                                                    " numbers and a matrix of the same pattern are needed");
    if (slots_.empty() && diagonal_slots_.empty()) return A.values().fill(0);
    assemble_(items_, {{"cells", cells_},
                       {"offsets", A.offsets()},
                       {"diagonal_offsets", diagonal_offsets_},
                       {"diagonal_slots", diagonal_slots_},
                       {"slot_offsets", slot_offsets_},
                       {"slots", slots_},
                       {"blocks", blocks},
                       {"A", A.values()}});
}

} // namespace taut::impl
