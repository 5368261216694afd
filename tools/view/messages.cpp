// SPDX-License-Identifier: MIT
#include "view/messages.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace taut::view
{

namespace
{

static_assert(
    std::endian::native == std::endian::little,
    "messages hold numbers as this machine has them, and the page takes them as little-endian; build taut for a "
    "little-endian machine, or without its tools (TAUT_TOOLS=OFF)");

enum class kind : std::uint8_t
{
    places = 1,
    release,
    focus,
    relax,
    align,
    undo,
    redo,
    save,
    seen,
    pose,
    keep,
    move,
    // to the page
    model = 64,
    state,
    note,
    file
};

class reader
{
public:
    explicit reader(std::span<const unsigned char> bytes) : rest_(bytes) {}

    template <class T>
    T take()
    {
        if (rest_.size() < sizeof(T)) throw message_error("the message is too short");
        T value;
        std::memcpy(&value, rest_.data(), sizeof(T));
        rest_ = rest_.subspan(sizeof(T));
        return value;
    }

    double number()
    {
        const auto x = take<double>();
        if (!std::isfinite(x)) throw message_error("a number is not finite");
        return x;
    }

    bool flag() { return take_below(2) == 1; }

    std::uint8_t take_below(std::uint8_t bound)
    {
        const auto x = take<std::uint8_t>();
        if (x >= bound) throw message_error("a choice that there is not");
        return x;
    }

    /// Reads a count, and checks that the remaining bytes suffice.
    std::size_t count(std::size_t size)
    {
        const std::size_t n = take<std::uint32_t>();
        if (n > rest_.size() / size) throw message_error("the message is too short for its list");
        return n;
    }

    std::int32_t id()
    {
        const auto v = take<std::int32_t>();
        if (v < 0) throw message_error("a negative number of a vertex or face");
        return v;
    }

    std::vector<std::int32_t> ids()
    {
        std::vector<std::int32_t> list(count(sizeof(std::int32_t)));
        for (auto& v : list) v = id();
        return list;
    }

    void end() const
    {
        if (!rest_.empty()) throw message_error("the message is too long");
    }

private:
    std::span<const unsigned char> rest_;
};

ask::places read_places(reader& in)
{
    ask::places p{std::vector<place>(in.count(sizeof(std::int32_t) + 1 + 3 * sizeof(double)))};
    for (place& pin : p.pins)
    {
        pin.vertex = in.id();
        pin.held = in.take_below(8);
        for (double& x : pin.x) x = in.number();
    }
    return p;
}

wish read_wish(kind what, reader& in)
{
    switch (what)
    {
    case kind::places:
        return read_places(in);
    case kind::release:
        return ask::release{in.ids()};
    case kind::focus:
        return ask::focus{in.ids()};
    case kind::relax:
        return ask::relax{in.flag()};
    case kind::align:
    {
        const auto axis = in.take_below(3);
        return ask::align{axis, in.ids()};
    }
    case kind::undo:
        return ask::undo{};
    case kind::redo:
        return ask::redo{};
    case kind::save:
        return ask::save{};
    case kind::seen:
        return ask::seen{in.take<std::uint32_t>()};
    case kind::pose:
    {
        const auto onto = in.take<std::int32_t>();
        const double turn = in.number(), scale = in.number();
        return ask::pose{onto, turn, scale, in.number()};
    }
    case kind::move:
    {
        const double x = in.number(), y = in.number();
        return ask::move{{x, y, in.number()}};
    }
    case kind::keep:
        return ask::keep{};
    default:
        throw message_error("a kind of message that there is not");
    }
}

class writer
{
public:
    explicit writer(kind what) { put(what); }

    template <class T>
    writer& put(T value) requires std::is_trivially_copyable_v<T>
    {
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        out_.append(bytes, sizeof(T));
        return *this;
    }

    writer& text(std::string_view s)
    {
        put(static_cast<std::uint32_t>(s.size()));
        out_ += s;
        return *this;
    }

    template <class T>
    writer& list(const std::vector<T>& values)
    {
        put(static_cast<std::uint32_t>(values.size()));
        out_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        return *this;
    }

    std::string take() { return std::move(out_); }

private:
    std::string out_;
};

} // namespace

message parse(std::span<const unsigned char> bytes)
{
    reader in(bytes);
    const auto what = in.take<kind>();
    const auto gesture = in.take<std::uint32_t>();
    message m{gesture, read_wish(what, in)};
    in.end();
    return m;
}

std::string encode(const model& m)
{
    return writer(kind::model)
        .put(m.dimension)
        .put(m.what)
        .text(m.name)
        .list(m.points)
        .list(m.faces)
        .put(m.first_of_feature)
        .take();
}

std::string encode(const state& s, bool may_write)
{
    std::uint8_t flags = 0;
    int bit = 0;
    for (const bool b : {s.converged, s.held, s.working, s.can_undo, s.can_redo, may_write})
        flags = static_cast<std::uint8_t>(flags | (b ? 1 : 0) << bit++);
    writer out(kind::state);
    out.put(flags).put(s.number).put(s.flipped).put(s.energy).put(s.distance).put(s.seconds);
    out.put(s.turn).put(s.scale).put(s.softness);
    out.put(static_cast<std::uint32_t>(s.pins.size()));
    for (const place& p : s.pins)
    {
        out.put(p.vertex).put(p.held);
        for (const double x : p.x) out.put(x);
    }
    for (const double x : s.origin) out.put(x);
    return out.list(s.positions).take();
}

std::string encode_note(std::string_view text)
{
    return writer(kind::note).text(text).take();
}

std::string encode_file(std::string_view name, std::string_view bytes)
{
    return writer(kind::file).text(name).text(bytes).take();
}

} // namespace taut::view
