// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include <taut/files.hpp>

namespace taut::tools::batch
{

/// The folder where kernel caches of batches lie unless another one is named: of this machine, in POCL_CACHE_DIR, or
/// where the user's caches are. Throws usage_error where there is no such place.
std::filesystem::path default_caches();

/// A folder of compiled kernels that no other process uses: PoCL's cache is not safe between processes.
class kernel_cache
{
public:
    /// The first folder below `caches` that is free, made if need be: in the next run it is warm. Throws usage_error
    /// if none can be made, or if others than this user may have put something there, which would be run as code;
    /// std::system_error where no more files can be opened.
    explicit kernel_cache(const std::filesystem::path& caches);

    const std::filesystem::path& folder() const noexcept { return folder_; }

private:
    std::filesystem::path folder_;
    io::impl::descriptor lock_; ///< held as long as it is open
};

} // namespace taut::tools::batch
