// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <taut/device.hpp>
#include <taut/impl/core/compute/opencl/boost_compute.hpp>

namespace taut::impl
{

/// By what a program is kept: all that its bytes depend on.
std::string key_of(const device& device, const std::string& source, const std::string& options);

/// Compiled programs of earlier processes, for drivers that keep none: files in a folder of the user's alone. A folder
/// or file that cannot be trusted, read or written costs time and is no error: programs are compiled anew. Files that
/// are no entries are neither read nor removed.
class program_store
{
public:
    /// An empty folder finds and keeps nothing. limit: bytes of all entries; the half that was used last stays beyond
    /// it.
    explicit program_store(std::filesystem::path folder, std::uintmax_t limit = std::uintmax_t(256) << 20);

    /// The user's, in a folder of its own in TAUT_CACHE_DIR, or where caches are. Finds and keeps nothing for a driver
    /// that keeps programs itself, with TAUT_CACHE_DIR=0, and where there is no home.
    static program_store of(const device& device);

    /// What was kept by that key, empty if nothing was.
    std::string find(const std::string& key) const;

    void keep(const std::string& key, const std::string& bytes) const;

    /// Builds a program, or takes a kept one. `made` is the program, also where building
    /// it fails; throws what that throws.
    void build(boost::compute::program& made, const boost::compute::context& context, const device& device,
               const std::string& source, const std::string& options) const;

private:
    std::filesystem::path file_of(const std::string& key) const;
    void clean() const;

    std::filesystem::path folder_;
    std::uintmax_t limit_;
};

} // namespace taut::impl
