// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <taut/impl/core/symbolic/row_program.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

struct row_frame;

/// The operations on rows for one instruction set.
struct row_operations
{
    using handler = void (*)(const row_operation&, const row_frame&);

    std::string_view name;
    const handler* table; ///< by row_code
};

/// Those that this machine can run, best first; the last one runs everywhere. Results of sums of products differ
/// between the last one and the others in the last place where they contract both (fused multiply-add).
std::span<const row_operations> row_operation_sets();

/// An argument of a launch on the host: the memory of a buffer, or the bits of a number.
struct host_argument
{
    host_argument(const void* buffer) : memory(static_cast<char*>(const_cast<void*>(buffer))) {}
    template <traceable T>
    host_argument(T value) : bits(to_bits(value))
    {
    }

    char* memory = nullptr;
    std::uint64_t bits = 0;
};

/// A program with its arguments, which come in the order of the recording. Lives as long as the program.
///
///     const row_launch launch(*text.rows, arguments);
///     launch.run(0, n);                           // or parts of it, by several threads at a time
///
/// Results do not depend on how indices are split. Nothing beyond what the recording reads and writes at the indices
/// that are run is touched.
class row_launch
{
public:
    /// Computes what is the same for all indices, which reads memory: so make none for no indices.
    row_launch(const row_program& program, std::span<const host_argument> arguments,
               const row_operations& operations = row_operation_sets().front());

    /// Runs the indices first, first + step, ... below last. Takes scratch memory of its own.
    void run(idx first, idx last, idx step = 1) const;

private:
    char* place(const row_program::alias& a, std::ptrdiff_t index) const;
    void fill_splats(std::span<char* const> own, std::ptrdiff_t length) const;
    void copy_in(const row_program::alias& a, char* own, const row_frame& f) const;
    void copy_out(const row_program::alias& a, const char* own, const row_frame& f) const;

    const row_program& program_;
    const row_operations& operations_;
    std::vector<std::uint64_t> uniforms_;
    std::vector<char*> memory_;
    bool in_place_ = true; ///< no two rows are written at one place
};

} // namespace taut::impl
