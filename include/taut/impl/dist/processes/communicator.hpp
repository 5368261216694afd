// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include <mpi.h>

#include <taut/mesh_piece.hpp>

namespace taut::dist::impl
{

/// What one process sends to each of the others, by their rank.
template <class T>
using parcels = std::vector<std::vector<T>>;

/// What it got: all of it by sender, ascending, and where that of each sender begins.
template <class T>
struct received
{
    std::vector<T> items;
    std::vector<std::size_t> begin; ///< size() + 1 of them

    std::span<const T> from(std::size_t rank) const
    {
        return std::span(items).subspan(begin[rank], begin[rank + 1] - begin[rank]);
    }
};

/// Processes that work on one mesh, with a communication space of their own. All functions but rank(), size() and raw()
/// are collective; their results are the same bits on all processes.
class communicator
{
public:
    explicit communicator(MPI_Comm given)
    {
        MPI_Comm copy = MPI_COMM_NULL;
        require(MPI_Comm_dup(given, &copy), "MPI_Comm_dup");
        MPI_Comm guard = MPI_COMM_NULL;
        require(MPI_Comm_dup(given, &guard), "MPI_Comm_dup");
        handle_ = std::shared_ptr<handle>(new handle{copy, guard});
        MPI_Comm_rank(copy, &rank_);
        MPI_Comm_size(copy, &size_);
    }

    int rank() const noexcept { return rank_; }
    int size() const noexcept { return size_; }
    std::size_t ranks() const noexcept { return static_cast<std::size_t>(size_); }
    MPI_Comm raw() const noexcept { return handle_->comm; }

    std::int64_t sum(std::int64_t x) const { return reduced(x, MPI_INT64_T, MPI_SUM); }
    std::int64_t least(std::int64_t x) const { return reduced(x, MPI_INT64_T, MPI_MIN); }
    std::int64_t most(std::int64_t x) const { return reduced(x, MPI_INT64_T, MPI_MAX); }
    /// NaN where one of them is: what MPI makes of that may differ between processes, which would part their ways.
    double least(double x) const
    {
        const bool none = std::isnan(x);
        std::array<double, 2> both{none ? std::numeric_limits<double>::infinity() : x, none ? 0.0 : 1.0};
        require(MPI_Allreduce(MPI_IN_PLACE, both.data(), 2, MPI_DOUBLE, MPI_MIN, raw()), "MPI_Allreduce");
        return both[1] > 0 ? both[0] : std::numeric_limits<double>::quiet_NaN();
    }
    double most(double x) const { return -least(-x); }
    bool any(bool x) const { return most(std::int64_t{x}) != 0; }
    bool all(bool x) const { return !any(!x); }

    /// Sums over the processes with lower ranks.
    std::int64_t before(std::int64_t n) const
    {
        std::int64_t sum = 0;
        require(MPI_Exscan(&n, &sum, 1, MPI_INT64_T, MPI_SUM, raw()), "MPI_Exscan");
        return rank_ == 0 ? 0 : sum;
    }

    /// Sums of integers, entry by entry.
    void add(std::span<std::int64_t> x) const
    {
        require(MPI_Allreduce(MPI_IN_PLACE, x.data(), count_of(x.size()), MPI_INT64_T, MPI_SUM, raw()),
                "MPI_Allreduce");
    }

    /// Sums of doubles, entry by entry. They depend on the number of processes by rounding, not on the process.
    void add(std::span<double> x) const
    {
        const void* const from = rank_ == 0 ? MPI_IN_PLACE : static_cast<const void*>(x.data());
        require(MPI_Reduce(from, x.data(), count_of(x.size()), MPI_DOUBLE, MPI_SUM, 0, raw()), "MPI_Reduce");
        share(x);
    }

    /// Replaces x by that of process `root`.
    template <class T>
    void share(std::span<T> x, int root = 0) const
    {
        static_assert(std::is_trivially_copyable_v<T>);
        const record<T> type;
        require(MPI_Bcast(x.data(), count_of(x.size()), type.handle, root, raw()), "MPI_Bcast");
    }
    template <class T>
    T shared(T x, int root = 0) const
    {
        share(std::span(&x, 1), root);
        return x;
    }
    std::string shared(std::string text, int root = 0) const
    {
        text.resize(static_cast<std::size_t>(shared(static_cast<std::int64_t>(text.size()), root)));
        share(std::span<char>(text.data(), text.size()), root);
        return text;
    }

    /// Items of all processes, by rank.
    template <class T>
    std::vector<T> gathered(const std::vector<T>& mine) const
    {
        return exchange(parcels<T>(ranks(), mine)).items;
    }
    /// Texts of all processes, by rank, whatever bytes are in them.
    std::vector<std::string> gathered(const std::vector<std::string>& mine) const
    {
        std::vector<std::uint64_t> sizes;
        std::string bytes;
        for (const auto& text : mine) sizes.push_back(text.size()), bytes += text;
        sizes = gathered(sizes);
        const auto all = gathered(std::vector<char>(bytes.begin(), bytes.end()));
        std::vector<std::string> texts;
        const char* at = all.data();
        for (const auto size : sizes) texts.emplace_back(at, size), at += size;
        return texts;
    }

    /// Sends parcels and receives those of the others. Where there is no room for them on one process, all throw.
    template <class T>
    received<T> exchange(const parcels<T>& to) const
    {
        static_assert(std::is_trivially_copyable_v<T>);
        std::vector<int> counts(ranks()), theirs(ranks()), starts(ranks() + 1, 0), places(ranks() + 1, 0);
        std::vector<T> all;
        together(
            [&]
            {
                std::size_t sent = 0;
                for (std::size_t r = 0; r < ranks(); ++r)
                {
                    counts[r] = count_of(to[r].size());
                    sent += to[r].size();
                    starts[r + 1] = count_of(sent);
                }
                all.reserve(sent);
                for (const auto& parcel : to) all.insert(all.end(), parcel.begin(), parcel.end());
            });
        require(MPI_Alltoall(counts.data(), 1, MPI_INT, theirs.data(), 1, MPI_INT, raw()), "MPI_Alltoall");
        received<T> got;
        together(
            [&]
            {
                got.begin.assign(ranks() + 1, 0);
                for (std::size_t r = 0; r < ranks(); ++r)
                {
                    got.begin[r + 1] = got.begin[r] + static_cast<std::size_t>(theirs[r]);
                    places[r + 1] = count_of(got.begin[r + 1]);
                }
                got.items.resize(got.begin.back());
            });
        const record<T> type;
        require(MPI_Alltoallv(all.data(), counts.data(), starts.data(), type.handle, got.items.data(), theirs.data(),
                              places.data(), type.handle, raw()),
                "MPI_Alltoallv");
        return got;
    }

    /// Ends a step that processes do by themselves: where one of them failed, all throw, it its own error, the others a
    /// remote_error. failure: null where nothing did.
    void agree(const std::exception_ptr& failure) const
    {
        const auto first = static_cast<int>(least(std::int64_t{failure ? rank_ : size_}));
        if (first < size_) fail(first, failure);
    }

    /// The same, once it is known that a process did.
    [[noreturn]] void fail(const std::exception_ptr& failure) const
    {
        fail(static_cast<int>(least(std::int64_t{failure ? rank_ : size_})), failure);
    }

    /// Does something by itself, and agrees.
    template <class F>
    void together(const F& f) const
    {
        std::exception_ptr failure;
        try
        {
            f();
        }
        catch (...)
        {
            failure = std::current_exception();
        }
        agree(failure);
    }

    /// A call of the library. Where it fails on one process between two points where all meet, this one waits for the
    /// others at its end, and all throw, as in agree(). Where they do not come for a while, as they wait for it
    /// elsewhere, it prints a message and ends all by MPI_Abort.
    template <class F>
    void guarded(const F& f) const
    {
        std::exception_ptr failure;
        try
        {
            f();
        }
        catch (...)
        {
            failure = std::current_exception();
            if (failure == handle_->told) throw; // all know
        }
        MPI_Request request = MPI_REQUEST_NULL;
        require(MPI_Ibarrier(handle_->guard, &request), "MPI_Ibarrier");
        wait(request, failure);
        agree(failure);
    }

    /// Whether a call of another library failed on any process, which may keep those where it did not waiting inside of
    /// it: as guarded(), it ends all where these do not come.
    bool any_failed(bool failed, const char* call) const
    {
        int all = failed;
        MPI_Request request = MPI_REQUEST_NULL;
        require(MPI_Iallreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MAX, raw(), &request), "MPI_Iallreduce");
        wait(request, failed ? std::make_exception_ptr(backend_error(std::string(call) + " failed")) : nullptr);
        return all != 0;
    }

    /// How long a process that failed waits for the others: TAUT_MPI_PATIENCE in seconds, or 20.
    static std::chrono::duration<double> patience()
    {
        const char* const wish = std::getenv("TAUT_MPI_PATIENCE");
        const double seconds = wish ? std::atof(wish) : 0;
        return std::chrono::duration<double>(seconds > 0 ? seconds : 20);
    }

    /// Throws backend_error for a code of MPI other than success.
    static void require(int code, const char* call)
    {
        if (code == MPI_SUCCESS) return;
        char text[MPI_MAX_ERROR_STRING];
        int length = 0;
        MPI_Error_string(code, text, &length);
        throw backend_error(std::string(call) + ": " + std::string(text, static_cast<std::size_t>(length)));
    }

private:
    struct handle
    {
        MPI_Comm comm, guard;
        std::exception_ptr told; ///< the last failure that all know of, as it is thrown here
        handle(MPI_Comm c, MPI_Comm g) : comm(c), guard(g) {}
        handle(const handle&) = delete;
        handle& operator=(const handle&) = delete;
        ~handle()
        {
            int over = 0;
            MPI_Finalized(&over);
            if (over) return;
            MPI_Comm_free(&comm);
            MPI_Comm_free(&guard);
        }
    };

    /// A record as MPI sees it: counts are ints.
    template <class T>
    struct record
    {
        MPI_Datatype handle = MPI_DATATYPE_NULL;
        record()
        {
            MPI_Type_contiguous(static_cast<int>(sizeof(T)), MPI_BYTE, &handle);
            MPI_Type_commit(&handle);
        }
        record(const record&) = delete;
        record& operator=(const record&) = delete;
        ~record() { MPI_Type_free(&handle); }
    };

    static int count_of(std::size_t n)
    {
        if (n > static_cast<std::size_t>(std::numeric_limits<int>::max()))
            throw size_error("communicator", "more than 2^31 records in one message; use more processes");
        return static_cast<int>(n);
    }

    template <class T>
    T reduced(T x, MPI_Datatype type, MPI_Op op) const
    {
        T result{};
        require(MPI_Allreduce(&x, &result, 1, type, op, raw()), "MPI_Allreduce");
        return result;
    }

    [[noreturn]] void fail(int first, const std::exception_ptr& failure) const
    {
        const std::string what = shared(text_of(failure, first), first);
        handle_->told = failure ? failure : std::make_exception_ptr(remote_error(first, what));
        std::rethrow_exception(handle_->told);
    }

    /// Waits for what all processes take part in; where this one has failed, not for ever.
    void wait(MPI_Request& request, const std::exception_ptr& failure) const
    {
        const auto begin = std::chrono::steady_clock::now();
        for (int tries = 0;; ++tries)
        {
            int done = 0;
            require(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "MPI_Test");
            if (done) return;
            if (failure && std::chrono::steady_clock::now() - begin > patience()) end(failure);
            if (tries > 1000) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }

    [[noreturn]] void end(const std::exception_ptr& failure) const
    {
        const std::string text = "taut: error: process " + std::to_string(rank_) +
                                 " failed while others wait for it, so all are ended: " + text_of(failure, rank_) +
                                 '\n';
        std::fputs(text.c_str(), stderr);
        std::fflush(stderr);
        constexpr int backend_failed = 9; // as the program's exit codes have it
        MPI_Abort(raw(), backend_failed);
        std::abort();
    }

    static std::string text_of(const std::exception_ptr& failure, int rank)
    {
        if (!failure) return {};
        try
        {
            std::rethrow_exception(failure);
        }
        catch (const std::bad_alloc&)
        {
            return "not enough memory on process " + std::to_string(rank) + "; use more processes";
        }
        catch (const std::exception& e)
        {
            return e.what();
        }
        catch (...)
        {
            return "process " + std::to_string(rank) + " failed";
        }
    }

    std::shared_ptr<handle> handle_;
    int rank_ = 0, size_ = 1;
};

} // namespace taut::dist::impl
