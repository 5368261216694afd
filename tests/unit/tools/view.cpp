// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <chrono>
#include <cstring>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include <view/gate.hpp>
#include <view/messages.hpp>

using namespace taut::view;

namespace
{

/// Bytes of numbers, as pages send them.
struct bytes
{
    template <class T>
    bytes& put(T value)
    {
        const auto at = list.size();
        list.resize(at + sizeof(T));
        std::memcpy(list.data() + at, &value, sizeof(T));
        return *this;
    }
    std::vector<unsigned char> list;
};

bytes begin(std::uint8_t kind)
{
    return bytes().put(kind).put(std::uint32_t{17});
}

} // namespace

TEST_CASE("messages of a page: what is said is understood, and nothing else")
{
    auto pin = begin(1).put(std::uint32_t{1}).put(std::int32_t{5}).put(std::uint8_t{3}).put(0.25).put(-1e300).put(0.0);
    const auto m = parse(pin.list);
    CHECK(m.gesture == 17);
    const auto& p = std::get<ask::places>(m.what).pins.at(0);
    CHECK(p.vertex == 5);
    CHECK(p.held == 3);
    CHECK(p.x[0] == 0.25);
    CHECK(p.x[1] == -1e300);

    for (std::size_t n = 0; n < pin.list.size(); ++n)
        CHECK_THROWS_AS(parse(std::span<const unsigned char>(pin.list).first(n)), message_error);
    pin.list.push_back(0);
    CHECK_THROWS_WITH_AS(parse(pin.list), "the message is too long", message_error);

    CHECK(std::get<ask::align>(
              parse(begin(5).put(std::uint8_t{1}).put(std::uint32_t{2}).put(std::int32_t{8}).put(std::int32_t{9}).list)
                  .what)
              .vertices == std::vector<std::int32_t>{8, 9});
    const auto pose = std::get<ask::pose>(parse(begin(10).put(std::int32_t{-1}).put(0.5).put(2.0).put(0.25).list).what);
    CHECK(pose.onto == -1);
    CHECK(pose.turn == 0.5);
    CHECK(pose.scale == 2);
    CHECK(pose.softness == 0.25);
    CHECK(std::get<ask::relax>(parse(begin(4).put(std::uint8_t{1}).list).what).afresh);
    CHECK(std::get<ask::seen>(parse(begin(9).put(std::uint32_t{3}).list).what).state == 3);

    const auto nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(
        parse(begin(1).put(std::uint32_t{1}).put(std::int32_t{5}).put(std::uint8_t{3}).put(nan).put(0.0).put(0.0).list),
        message_error);
    CHECK_THROWS_AS(parse(begin(2).put(std::uint32_t{0xffffffffu}).list),
                    message_error); // before anything is allocated
    CHECK_THROWS_AS(parse(begin(2).put(std::uint32_t{1}).put(std::int32_t{-1}).list), message_error);
    CHECK_THROWS_AS(parse(begin(5).put(std::uint8_t{3}).put(std::uint32_t{0}).list), message_error);
    CHECK_THROWS_AS(parse(begin(64).list), message_error); // what only the program says
    CHECK_THROWS_AS(parse(begin(0).list), message_error);
}

TEST_CASE("the gate of a page: this machine by its own names, its own pages, and the token")
{
    const gate g(4711);
    CHECK(g.token().size() == 64);
    CHECK(g.token() != gate(4711).token());
    CHECK(g.is_local("127.0.0.1:4711"));
    CHECK(g.is_local("localhost:4711"));
    for (const char* host : {"", "127.0.0.1", "localhost", "evil.example:4711", "127.0.0.1:4712", "127.0.0.1:47110",
                             "localhost.evil.example:4711", "[::1]:4711"})
        CHECK_FALSE(g.is_local(host));

    CHECK(g.is_own("http://localhost:4711", "localhost:4711"));
    for (const char* origin : {"", "null", "http://localhost", "https://localhost:4711", "http://127.0.0.1:4711",
                               "http://localhost:4711/", "http://evil.example"})
        CHECK_FALSE(g.is_own(origin, "localhost:4711"));
    CHECK_FALSE(g.is_own("http://evil.example:4711", "evil.example:4711"));

    CHECK(g.has_token("taut, token." + g.token()));
    CHECK(g.has_token("token." + g.token() + ",taut"));
    for (const std::string& offer :
         std::vector<std::string>{"", "taut", "token.", g.token(), "token." + g.token() + "0", ",,",
                                  "token." + g.token().substr(1), "taut, token." + std::string(64, '0')})
        CHECK_FALSE(g.has_token(offer));
}

TEST_CASE("an allowance: so many at once, and then as many as time brings")
{
    using namespace std::chrono_literals;
    allowance a(10);
    const auto now = allowance::clock::now() + 1s;
    int taken = 0;
    for (int k = 0; k < 100; ++k) taken += a.take(now) ? 1 : 0;
    CHECK(taken == 10);
    CHECK_FALSE(a.take(now + 50ms));
    CHECK(a.take(now + 200ms));
    taken = 0;
    for (int k = 0; k < 100; ++k) taken += a.take(now + 1h) ? 1 : 0;
    CHECK(taken == 10);
}
