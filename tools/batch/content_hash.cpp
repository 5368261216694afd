// SPDX-License-Identifier: MIT
#include "batch/content_hash.hpp"

#include <array>
#include <cerrno>
#include <cstddef>
#include <memory>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <openssl/evp.h>

#include <taut/files.hpp>

namespace taut::tools::batch
{

std::optional<std::string> content_hash(const std::string& path)
{
    struct stat status = {};
    // A pipe that is opened and closed again is taken from the job: its writer would end.
    if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    const io::impl::descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
    if (!file || ::fstat(*file, &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;

    const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
    if (!context || EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) != 1) return std::nullopt;
    std::vector<char> piece(1 << 20);
    for (;;)
    {
        const auto got = ::read(*file, piece.data(), piece.size());
        if (got == 0) break;
        if (got < 0 && errno == EINTR) continue;
        if (got < 0 || EVP_DigestUpdate(context.get(), piece.data(), static_cast<std::size_t>(got)) != 1)
            return std::nullopt;
    }
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned length = 0;
    if (EVP_DigestFinal_ex(context.get(), digest.data(), &length) != 1) return std::nullopt;
    std::string text;
    for (unsigned k = 0; k < length; ++k)
        for (const int digit : {digest[k] >> 4, digest[k] & 15}) text += "0123456789abcdef"[digit];
    return text;
}

} // namespace taut::tools::batch
