// SPDX-License-Identifier: MIT
#include "view/workbench.hpp"

#include <cstddef>
#include <exception>
#include <numeric>
#include <type_traits>
#include <utility>
#include <variant>

namespace taut::view
{

namespace
{

/// A pose that the next message changes again.
bool is_overtaken(const std::deque<message>& all, std::size_t k)
{
    return k + 1 < all.size() && std::holds_alternative<ask::pose>(all[k].what) &&
           std::holds_alternative<ask::pose>(all[k + 1].what) && all[k].gesture == all[k + 1].gesture;
}

} // namespace

workbench::workbench(std::unique_ptr<subject> what, listener who, std::chrono::duration<double> frame)
    : subject_(std::move(what)),
      listener_(std::move(who)),
      frame_(frame),
      revision_(subject_->revision()),
      thread_([this] { work(); })
{
}

workbench::~workbench()
{
    {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

bool workbench::wish(message m)
{
    constexpr std::size_t most = 1000;
    {
        const std::lock_guard lock(mutex_);
        if (inbox_.size() >= most) return false;
        inbox_.push_back(std::move(m));
    }
    changed_.notify_one();
    return true;
}

void workbench::work()
{
    using clock = std::chrono::steady_clock;
    rehearse();
    show(0);
    for (;;)
    {
        std::deque<message> wishes;
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [this] { return over_ || working_ || !inbox_.empty(); });
            if (over_) return;
            std::swap(wishes, inbox_);
        }
        const auto begin = clock::now();
        try
        {
            for (std::size_t k = 0; k < wishes.size(); ++k)
                if (!is_overtaken(wishes, k)) grant(wishes[k]);
            if (working_) working_ = subject_->advance(frame_, [this] { return !is_asked(); });
        }
        catch (const std::exception& e)
        {
            working_ = false;
            listener_.tell(encode_note(e.what()));
        }
        show(std::chrono::duration<double>(clock::now() - begin).count());
    }
}

void workbench::rehearse()
{
    try
    {
        subject_->rehearse();
    }
    catch (const std::exception& e)
    {
        listener_.tell(encode_note(e.what()));
    }
}

/// Returns whether somebody waits, or it is over.
bool workbench::is_asked()
{
    const std::lock_guard lock(mutex_);
    return over_ || !inbox_.empty();
}

/// One that is refused is told, and the others are granted.
void workbench::grant(const message& m)
{
    const auto change = [&](bool works, const auto& f)
    {
        const bool begins = gesture_ != m.gesture;
        moment before = begins ? subject_->remember() : nullptr;
        f();
        working_ = works || working_;
        if (begins) keep(std::move(before));
        gesture_ = m.gesture;
    };
    try
    {
        std::visit(
            [&](const auto& w)
            {
                using kind = std::remove_cvref_t<decltype(w)>;
                if constexpr (std::is_same_v<kind, ask::places>)
                    change(true, [&] { subject_->pin(w.pins); });
                else if constexpr (std::is_same_v<kind, ask::release>)
                    change(false, [&] { subject_->release(w.vertices); });
                else if constexpr (std::is_same_v<kind, ask::focus>)
                    change(false, [&] { subject_->focus(w.faces); });
                else if constexpr (std::is_same_v<kind, ask::align>)
                    change(true, [&] { subject_->align(w.axis, w.vertices); });
                else if constexpr (std::is_same_v<kind, ask::relax>)
                    change(true,
                           [&]
                           {
                               if (w.afresh) subject_->start_afresh();
                           });
                else if constexpr (std::is_same_v<kind, ask::pose>)
                    change(false, [&] { subject_->pose(w); });
                else if constexpr (std::is_same_v<kind, ask::move>)
                    change(false, [&] { subject_->move(w); });
                else if constexpr (std::is_same_v<kind, ask::keep>)
                    change(false, [&] { subject_->keep(); });
                else if constexpr (std::is_same_v<kind, ask::undo>)
                    go(before_, after_);
                else if constexpr (std::is_same_v<kind, ask::redo>)
                    go(after_, before_);
                else if constexpr (std::is_same_v<kind, ask::save>)
                {
                    const auto file = subject_->write();
                    listener_.tell(encode_file(file.name, file.bytes));
                    for (const auto& note : file.notes) listener_.tell(encode_note(note));
                }
            },
            m.what);
    }
    catch (const std::exception& e)
    {
        listener_.tell(encode_note(e.what()));
    }
}

/// Keeps the state before a gesture, as many of them as there is room for.
void workbench::keep(moment before)
{
    constexpr std::size_t most = 100, most_bytes = 256 << 20;
    before_.push_back(std::move(before));
    after_.clear();
    std::size_t bytes = std::accumulate(before_.begin(), before_.end(), std::size_t{0},
                                        [](std::size_t sum, const moment& m) { return sum + m->bytes(); });
    while (before_.size() > 1 && (before_.size() > most || bytes > most_bytes))
    {
        bytes -= before_.front()->bytes();
        before_.pop_front();
    }
}

void workbench::go(std::deque<moment>& from, std::deque<moment>& to)
{
    if (from.empty()) return;
    to.push_back(subject_->remember());
    subject_->go_back(*from.back());
    from.pop_back();
    gesture_.reset();
    working_ = false;
}

void workbench::show(double seconds)
{
    if (const int now = subject_->revision(); std::exchange(revision_, now) != now)
        listener_.open(encode(subject_->model()));
    auto s = std::make_shared<state>();
    subject_->describe(*s);
    s->number = ++number_;
    s->working = working_;
    s->can_undo = !before_.empty();
    s->can_redo = !after_.empty();
    s->seconds = seconds;
    listener_.show(std::move(s));
}

} // namespace taut::view
