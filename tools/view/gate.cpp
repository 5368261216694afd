// SPDX-License-Identifier: MIT
#include "view/gate.hpp"

#include <algorithm>
#include <random>

namespace taut::view
{

gate::gate(unsigned short port) : port_(std::to_string(port))
{
    std::random_device random; // of the system, in Debian's library
    constexpr char digits[] = "0123456789abcdef";
    for (int word = 0; word < 8; ++word)
        for (unsigned bits = random(), k = 0; k < 8; ++k, bits >>= 4) token_ += digits[bits & 15u];
}

bool gate::is_local(std::string_view host) const
{
    for (const std::string name : {"127.0.0.1", "localhost"})
        if (host == name + ":" + port_ || (port_ == "80" && host == name)) return true; // browsers leave 80 out
    return false;
}

bool gate::is_own(std::string_view origin, std::string_view host) const
{
    return is_local(host) && origin == "http://" + std::string(host);
}

bool gate::has_token(std::string_view subprotocols) const
{
    constexpr std::string_view prefix = "token.";
    bool found = false;
    while (!subprotocols.empty())
    {
        const auto comma = std::min(subprotocols.find(','), subprotocols.size());
        auto one = subprotocols.substr(0, comma);
        subprotocols.remove_prefix(std::min(comma + 1, subprotocols.size()));
        one.remove_prefix(std::min(one.find_first_not_of(' '), one.size()));
        if (one.substr(0, prefix.size()) != prefix) continue;
        one.remove_prefix(prefix.size());
        unsigned differ = one.size() == token_.size() ? 0 : 1;
        for (std::size_t k = 0; k < token_.size(); ++k)
            differ |= static_cast<unsigned>(static_cast<unsigned char>(token_[k]) ^
                                            static_cast<unsigned char>(k < one.size() ? one[k] : '\0'));
        found = found || differ == 0;
    }
    return found;
}

bool allowance::take(clock::time_point now)
{
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    left_ = std::min(a_second_, left_ + seconds * a_second_);
    if (left_ < 1) return false;
    left_ -= 1;
    return true;
}

} // namespace taut::view
