// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace taut::view
{

/// Access control of the server. Pages of others can make a browser send requests to it (a name of theirs that leads
/// here, a form, a socket), so that an address of this machine alone keeps nobody out.
class gate
{
public:
    /// port: where the program listens. Makes a token of 256 random bits.
    explicit gate(unsigned short port);

    const std::string& token() const { return token_; }

    /// Returns whether the Host of a request is this machine under one of its own names.
    bool is_local(std::string_view host) const;

    /// Returns whether the Origin is a page that the program itself gave to that Host.
    bool is_own(std::string_view origin, std::string_view host) const;

    /// Returns whether one of the offered subprotocols is "token." and the token. Takes as long for any token.
    bool has_token(std::string_view subprotocols) const;

private:
    std::string port_;
    std::string token_;
};

/// Rate limit of messages: a number per second on average, and as many at once.
class allowance
{
public:
    using clock = std::chrono::steady_clock;

    explicit allowance(double a_second) : a_second_(a_second), left_(a_second) {}

    /// Returns whether one more may come now.
    bool take(clock::time_point now);

private:
    double a_second_, left_;
    clock::time_point last_ = clock::now();
};

} // namespace taut::view
