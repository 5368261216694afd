// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <exception>
#include <string>
#include <utility>

#include <taut/impl/dist/processes/communicator.hpp>

namespace taut::dist::impl
{

/// A file that is not read by ranges, and why: process 0 reads it as a whole, and says what is wrong if something is.
class unsuited : public std::exception
{
public:
    explicit unsuited(std::string why) : why_(std::move(why)) {}
    const char* what() const noexcept override { return why_.c_str(); }

private:
    std::string why_;
};

/// Collective. Does something by itself; where it is unsuited on one process, all throw that.
template <class F>
void suited(const communicator& all, const F& f)
{
    std::exception_ptr failure;
    std::string why;
    bool refused = false;
    try
    {
        f();
    }
    catch (const unsuited& e)
    {
        refused = true;
        why = e.what();
    }
    catch (...)
    {
        failure = std::current_exception();
    }
    all.agree(failure);
    const auto first = static_cast<int>(all.least(std::int64_t{refused ? all.rank() : all.size()}));
    if (first < all.size()) throw unsuited(all.shared(why, first));
}

} // namespace taut::dist::impl
