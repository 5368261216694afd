// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <view/gate.hpp>
#include <view/messages.hpp>
#include <view/workbench.hpp>

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

/// A number that pins set. Its steps never end by themselves where they are counted. What is remembered of it is said
/// to be large.
class number_subject final : public subject
{
public:
    number_subject(std::size_t bytes, std::atomic<int>* steps) : bytes_(bytes), steps_(steps) {}

    taut::view::model model() const override { return {}; }
    void pin(std::span<const place> pins) override { value_ = pins[0].vertex; }
    void rehearse() override { ++rehearsals_; }
    bool advance(std::chrono::duration<double>, const std::function<bool()>& goes_on) override
    {
        if (steps_ == nullptr) return false;
        ++*steps_;
        while (goes_on()) std::this_thread::yield();
        return true;
    }
    void describe(state& s) const override
    {
        s.energy = value_;
        s.turn = rehearsals_;
    }
    std::shared_ptr<const memory> remember() const override { return std::make_shared<moment>(value_, bytes_); }
    void go_back(const memory& before) override { value_ = static_cast<const moment&>(before).value; }

    void release(std::span<const std::int32_t>) override {}
    void focus(std::span<const std::int32_t>) override {}
    void align(int, std::span<const std::int32_t>) override {}
    void start_afresh() override {}
    void pose(const ask::pose&) override {}
    void move(const ask::move&) override {}
    void keep() override {}
    int revision() const override { return 0; }
    saved write() const override { return {}; }

private:
    struct moment : memory
    {
        moment(int v, std::size_t b) : value(v), size(b) {}
        std::size_t bytes() const override { return size; }
        int value;
        std::size_t size;
    };
    std::size_t bytes_;
    std::atomic<int>* steps_;
    int value_ = -1, rehearsals_ = 0;
};

/// A workbench, and what it shows.
class watched
{
public:
    explicit watched(std::size_t bytes, std::atomic<int>* steps = nullptr)
        : bench_(std::make_unique<number_subject>(bytes, steps),
                 {.show =
                      [this](std::shared_ptr<const state> s)
                  {
                      const std::lock_guard lock(mutex_);
                      last_ = std::move(s);
                      shown_.notify_one();
                  },
                  .tell = [](const std::string&) {},
                  .open = [](const std::string&) {}},
                 std::chrono::duration<double>(0))
    {
    }

    void pin(int value) { bench_.wish({gesture_++, ask::places{{place{value, 3, {}}}}}); }
    void undo() { bench_.wish({0, ask::undo{}}); }

    /// The first state that is so; null: none has come.
    std::shared_ptr<const state> wait(const std::function<bool(const state&)>& is_so)
    {
        std::unique_lock lock(mutex_);
        const bool came = shown_.wait_for(lock, std::chrono::seconds(20), [&] { return last_ && is_so(*last_); });
        return came ? last_ : nullptr;
    }

private:
    std::mutex mutex_;
    std::condition_variable shown_;
    std::shared_ptr<const state> last_;
    std::uint32_t gesture_ = 1;
    workbench bench_; // last: it calls
};

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
    CHECK(std::get<ask::move>(parse(begin(12).put(0.5).put(-1.0).put(0.25).list).what).by[1] == -1);
    CHECK(std::get<ask::relax>(parse(begin(4).put(std::uint8_t{1}).list).what).afresh);
    CHECK(std::get<ask::seen>(parse(begin(9).put(std::uint32_t{3}).list).what).state == 3);

    const auto nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(
        parse(begin(1).put(std::uint32_t{1}).put(std::int32_t{5}).put(std::uint8_t{3}).put(nan).put(0.0).put(0.0).list),
        message_error);
    CHECK_THROWS_AS(parse(begin(12).put(0.5).put(nan).put(0.25).list), message_error);
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
    CHECK_FALSE(g.is_local("localhost")); // browsers leave out port 80 alone
    CHECK(gate(80).is_own("http://127.0.0.1", "127.0.0.1"));
    CHECK(gate(80).is_local("localhost:80"));
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

TEST_CASE("a workbench: what undo keeps is bounded by its bytes, and by a hundred gestures")
{
    for (const auto& [bytes, kept] :
         {std::pair{std::size_t{1}, 100}, {std::size_t{100} << 20, 2}, {std::size_t{1} << 30, 1}})
    {
        watched w(bytes);
        constexpr int gestures = 120;
        for (int k = 0; k < gestures; ++k) w.pin(k);
        REQUIRE(w.wait([](const state& s) { return s.energy == gestures - 1; }));
        for (int k = 0; k < gestures; ++k) w.undo();
        const auto first = w.wait([](const state& s) { return !s.can_undo; });
        REQUIRE(first);
        CHECK(first->energy == gestures - 1 - kept);
    }
}

TEST_CASE("a workbench: a wish ends the step at hand, and what drivers compile late is rehearsed once")
{
    std::atomic<int> steps{0};
    watched w(1, &steps);
    w.pin(0);
    while (steps == 0) std::this_thread::yield();
    w.pin(1);
    const auto s = w.wait([](const state& now) { return now.energy == 0; });
    REQUIRE(s);
    CHECK(s->turn == 1);
}
