// SPDX-License-Identifier: MIT
#include "native.hpp"

namespace native
{

crew::crew(unsigned threads)
{
    for (unsigned rank = 1; rank < threads; ++rank) threads_.emplace_back([this, rank] { work(rank); });
}

crew::~crew()
{
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    begin_.notify_all();
    for (auto& thread : threads_) thread.join();
}

void crew::run(std::size_t n, const std::function<void(std::size_t, std::size_t)>& body)
{
    {
        const std::lock_guard lock(mutex_);
        body_ = &body;
        n_ = n;
        busy_ = size() - 1;
        ++round_;
    }
    begin_.notify_all();
    part(0);
    std::unique_lock lock(mutex_);
    end_.wait(lock, [this] { return busy_ == 0; });
}

void crew::work(unsigned rank)
{
    std::size_t done = 0;
    for (;;)
    {
        {
            std::unique_lock lock(mutex_);
            begin_.wait(lock, [&] { return stop_ || round_ != done; });
            if (stop_) return;
            done = round_;
        }
        part(rank);
        const std::lock_guard lock(mutex_);
        if (--busy_ == 0) end_.notify_one();
    }
}

void crew::part(unsigned rank) const
{
    (*body_)(n_ * rank / size(), n_ * (rank + 1) / size());
}

template <class T>
void triad(crew& workers, std::vector<T>& a, const std::vector<T>& b, T s, const std::vector<T>& c)
{
    workers.run(a.size(),
                [&](std::size_t begin, std::size_t end)
                {
                    T* out = a.data();
                    const T *x = b.data(), *y = c.data();
#pragma GCC ivdep
                    for (std::size_t i = begin; i < end; ++i) out[i] = x[i] + s * y[i];
                });
}

template <class P, class R>
void dirichlet<P, R>::allocate()
{
    energy.resize(cell_stride);
    corner_gradient.resize(6 * cell_stride);
    gradient.resize(2 * vertex_stride);
}

template <class P, class R>
template <bool Gradient>
void dirichlet<P, R>::element_range(std::size_t begin, std::size_t end)
{
    const std::size_t n = cell_stride;
    const int *c0 = corners.data(), *c1 = c0 + n, *c2 = c1 + n;
    const R *w0 = inverse.data(), *w1 = w0 + n, *w2 = w1 + n, *weights = weight.data();
    const P *px = x.data(), *py = px + vertex_stride;
    R *e = energy.data(), *ix = corner_gradient.data(), *iy = ix + n, *jx = iy + n, *jy = jx + n, *kx = jy + n,
      *ky = kx + n;
#pragma GCC ivdep // the arrays do not overlap, which is too much for the compiler to check at run time
    for (std::size_t f = begin; f < end; ++f)
    {
        const int i = c0[f], j = c1[f], k = c2[f];
        const R ax = R(px[j] - px[i]), ay = R(py[j] - py[i]), bx = R(px[k] - px[i]), by = R(py[k] - py[i]);
        const R p = w0[f], q = w1[f], r = w2[f];
        const R s00 = ax * p, s10 = ay * p, s01 = ax * q + bx * r, s11 = ay * q + by * r;
        const R det = s00 * s11 - s01 * s10, inv = 1 / det, inv2 = inv * inv;
        const R n2 = s00 * s00 + s10 * s10 + s01 * s01 + s11 * s11, u = 1 + inv2;
        e[f] = weights[f] * n2 * u;
        if constexpr (Gradient)
        {
            const R a = 2 * u * weights[f], b = -2 * n2 * inv2 * inv * weights[f];
            const R g00 = a * s00 + b * s11, g10 = a * s10 - b * s01, g01 = a * s01 - b * s10, g11 = a * s11 + b * s00;
            jx[f] = g00 * p + g01 * q;
            jy[f] = g10 * p + g11 * q;
            kx[f] = g01 * r;
            ky[f] = g11 * r;
            ix[f] = -(jx[f] + kx[f]);
            iy[f] = -(jy[f] + ky[f]);
        }
    }
}

template <class P, class R>
void dirichlet<P, R>::value(crew& workers)
{
    workers.run(cells, [this](std::size_t begin, std::size_t end) { element_range<false>(begin, end); });
}

template <class P, class R>
void dirichlet<P, R>::elements(crew& workers)
{
    workers.run(cells, [this](std::size_t begin, std::size_t end) { element_range<true>(begin, end); });
}

template <class P, class R>
void dirichlet<P, R>::gather(crew& workers)
{
    workers.run(vertices,
                [this](std::size_t begin, std::size_t end)
                {
                    const R *gx = corner_gradient.data(), *gy = gx + cell_stride;
                    const int *offsets = offset.data(), *slots = slot.data();
                    for (std::size_t v = begin; v < end; ++v)
                    {
                        R sx = 0, sy = 0;
                        for (int s = offsets[v]; s < offsets[v + 1]; ++s) sx += gx[slots[s]], sy += gy[slots[s]];
                        gradient[v] = sx;
                        gradient[vertex_stride + v] = sy;
                    }
                });
}

template void triad(crew&, std::vector<float>&, const std::vector<float>&, float, const std::vector<float>&);
template void triad(crew&, std::vector<double>&, const std::vector<double>&, double, const std::vector<double>&);
template struct dirichlet<double, double>;
template struct dirichlet<double, float>;
template struct dirichlet<float, float>;

} // namespace native
