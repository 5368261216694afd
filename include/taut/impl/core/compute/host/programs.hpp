// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <taut/impl/core/compute/program/own_program.hpp>

namespace taut::impl
{

// The programs of kernels/*.cl in the forms that the host device has of them. Their bodies are those of the rooms that
// use them, so that nobody compiles the others.
const std::vector<host_program>& host_vectors(); ///< blas, gather and reduce
const std::vector<host_program>& host_blocks();  ///< block_sparse and block_setup
const std::vector<host_program>& host_charts();
const std::vector<host_program>& host_untangle();
const std::vector<host_program>& host_rbf();
const std::vector<host_program>& host_feature_map();
const std::vector<host_program>& host_bake();

} // namespace taut::impl
