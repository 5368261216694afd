// SPDX-License-Identifier: MIT
// Kernels without a kernel language: a lambda over traced values, recorded and compiled for the device at hand.
#include <iostream>
#include <vector>

#include <taut/kernel.hpp>

int main()
{
    taut::queue q;
    const std::vector<float> ones(1000, 1.0f), threes(1000, 3.0f);
    taut::buffer<float> bx(q, ones), by(q, threes);
    const float alpha = 4;

    // [saxpy]
    q.submit(
        [&](taut::handler& h)
        {
            auto x = bx.read(h);
            auto y = by.read_write(h);
            auto a = h.uniform(alpha); // an argument, not a literal
            h.parallel_for(1000, [=](auto i) { y[i] = a * x[i] + y[i]; });
        });
    // [saxpy]

    std::cout << by.download().back() << '\n';
}
