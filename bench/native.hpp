// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

/// What the kernels do, in plain C++ on all cores: the yardstick of the same run. native.cpp is compiled for this very
/// processor (-O3 -march=native), the rest of the program is not.
namespace native
{

/// Threads that sleep between calls, so that they do not take time from the device under test.
class crew
{
public:
    explicit crew(unsigned threads = std::thread::hardware_concurrency());
    ~crew();
    crew(const crew&) = delete;
    crew& operator=(const crew&) = delete;

    unsigned size() const { return static_cast<unsigned>(threads_.size()) + 1; }

    /// Calls body(begin, end) on equal parts of [0, n), one a thread; the calling thread takes the first.
    void run(std::size_t n, const std::function<void(std::size_t, std::size_t)>& body);

private:
    void work(unsigned rank);
    void part(unsigned rank) const;

    std::mutex mutex_;
    std::condition_variable begin_, end_;
    std::vector<std::thread> threads_;
    const std::function<void(std::size_t, std::size_t)>* body_ = nullptr;
    std::size_t n_ = 0, round_ = 0;
    unsigned busy_ = 0;
    bool stop_ = false;
};

/// STREAM triad a = b + s c: 3 n sizeof(T) bytes.
template <class T>
void triad(crew& workers, std::vector<T>& a, const std::vector<T>& b, T s, const std::vector<T>& c);

/// The symmetric Dirichlet energy and its gradient in the two steps of paper Fig. 8, positions in P and the rest in R.
/// Arrays as in taut::impl::layout; a vertex sums its corners through a CSR of slots.
template <class P, class R>
struct dirichlet
{
    std::size_t cells = 0, vertices = 0, cell_stride = 0, vertex_stride = 0;
    std::vector<int> corners;      ///< 3 x cell_stride
    std::vector<R> inverse;        ///< 3 x cell_stride: W^-1 as (0,0) (0,1) (1,1)
    std::vector<R> weight;         ///< cell_stride
    std::vector<P> x;              ///< 2 x vertex_stride
    std::vector<int> offset, slot; ///< row v: 2 * corner * cell_stride + cell for its corners
    std::vector<R> energy, corner_gradient, gradient;

    /// The results' sizes, once everything else is set.
    void allocate();

    void value(crew& workers);
    void elements(crew& workers); ///< energy and corner gradients
    void gather(crew& workers);   ///< corner gradients to vertices

private:
    template <bool Gradient>
    void element_range(std::size_t begin, std::size_t end);
};

} // namespace native
