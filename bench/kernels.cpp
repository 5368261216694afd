// SPDX-License-Identifier: MIT
// What the device kernels cost beside plain C++ on all cores in the same run: distortion and its gradient per triangle,
// and the bandwidth of the vector operations beside a STREAM triad.
#include <cstdio>
#include <exception>
#include <memory>
#include <numeric>
#include <random>

#include <support/meshes.hpp>

#include <taut/energies.hpp>
#include <taut/impl/core/objective/mesh_levels.hpp>
#include <taut/impl/core/objective/newton_objective.hpp>

#include "measure.hpp"
#include "native.hpp"
#include "stream.hpp"

namespace
{

using namespace taut;
using namespace taut::impl;

/// The mesh with its vertices, and its cells, in random order.
mesh<triangle> shuffled(const mesh<triangle>& m)
{
    std::mt19937 random(7);
    const auto lot = [&](taut::idx n)
    {
        std::vector<taut::idx> p(static_cast<std::size_t>(n));
        std::iota(p.begin(), p.end(), 0);
        std::shuffle(p.begin(), p.end(), random);
        return permutation(std::move(p));
    };
    return permute(m, mesh_order{lot(m.vertex_count()), lot(m.cell_count())});
}

/// What the element kernels read, in the order of the mesh or in the library's.
struct arrays
{
    std::size_t cells, vertices, cell_stride, vertex_stride;
    std::vector<taut::idx> corners;
    std::vector<double> inverse, measure, x;
    csr incidence;

    /// Positions are the rest positions seen from above.
    arrays(const mesh<triangle>& m, bool ordered)
    {
        const mesh<triangle> local = ordered ? permute(m, locality_order(m)) : m;
        cells = static_cast<std::size_t>(m.cell_count());
        vertices = static_cast<std::size_t>(m.vertex_count());
        incidence = vertex_corners(local);
        ideal_elements<triangle> ideal(local);
        auto triangles = local.cells();
        cell_stride = padded(triangles.size(), layout<triangle>::step);
        triangles.resize(cell_stride, triangles.back()); // copies of the last one, of measure 0, as in layout.hpp
        ideal.inverse.resize(cell_stride, ideal.inverse.back());
        ideal.measure.resize(cell_stride, 0.0);
        vertex_stride = padded(vertices, layout<triangle>::step);
        for (std::size_t k = 0; k < 3; ++k)
            for (const auto& t : triangles) corners.push_back(t[k]);
        for (const auto& [column, row] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1)})
            for (const auto& w : ideal.inverse) inverse.push_back(w[column][row]);
        measure = ideal.measure;
        x.assign(2 * vertex_stride, 0);
        for (std::size_t v = 0; v < vertices; ++v)
            for (int k = 0; k < 2; ++k) x[static_cast<std::size_t>(k) * vertex_stride + v] = local.points()[v][k];
    }
};

template <class To, class From>
std::vector<To> to(const std::vector<From>& v)
{
    return {v.begin(), v.end()};
}

/// The two steps of the gradient on the device.
class device_elements
{
public:
    device_elements(queue& q, const arrays& a, const real_types& types)
        : queue_(q),
          a_(a),
          kernels_(q, energy::isometric{}, types),
          corners_(q, a.corners),
          inverse_(q, types.vector, a.inverse),
          measure_(q, types.vector, a.measure),
          x_(q, types.position, a.x),
          energy_(q, types.vector, a.cell_stride),
          gradient_(q, types.vector, 2 * a.vertex_stride),
          corner_gradient_(q, types.position, 6 * a.cell_stride),
          gather_(make_gather(types))
    {
    }

    void value()
    {
        kernels_.value(range(), with({{"energy", energy_}}));
        queue_.finish();
    }
    void elements()
    {
        launch_elements();
        queue_.finish();
    }
    void gradient()
    {
        launch_elements();
        gather_(corner_gradient_, gradient_);
        queue_.finish();
    }
    std::vector<double> result() const { return gradient_.download(); }

private:
    void launch_elements()
    {
        kernels_.gradient(range(), with({{"energy", energy_}, {"corner_gradient", corner_gradient_}}));
    }

    static taut::idx stride(std::size_t n) { return static_cast<taut::idx>(n); }
    taut::range range() const { return {a_.cell_stride, layout<triangle>::step}; }

    /// The measure is the weight, too.
    std::vector<named_argument> with(std::initializer_list<named_argument> more) const
    {
        std::vector<named_argument> all = {{"corners", corners_},
                                           {"inverse", inverse_},
                                           {"measure", measure_},
                                           {"weight", measure_},
                                           {"x", x_},
                                           {"cell_stride", stride(a_.cell_stride)},
                                           {"vertex_stride", stride(a_.vertex_stride)}};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }

    gather make_gather(const real_types& types)
    {
        std::vector<taut::idx> cell, corner;
        for (const auto item : a_.incidence.items)
        {
            cell.push_back(item / 3);
            corner.push_back(item % 3);
        }
        return gather(queue_, a_.incidence.offsets, cell, corner,
                      {.components = 2, .cell_stride = a_.cell_stride, .vertex_stride = a_.vertex_stride},
                      types.position, types.vector);
    }

    queue queue_;
    const arrays& a_;
    element_kernels<triangle> kernels_;
    buffer<taut::idx> corners_;
    real_buffer inverse_, measure_, x_, energy_, gradient_, corner_gradient_;
    gather gather_;
};

template <class P, class R>
native::dirichlet<P, R> native_elements(const arrays& a)
{
    native::dirichlet<P, R> n;
    n.cells = a.cells, n.vertices = a.vertices, n.cell_stride = a.cell_stride, n.vertex_stride = a.vertex_stride;
    n.corners = a.corners;
    n.inverse = to<R>(a.inverse);
    n.weight = to<R>(a.measure);
    n.x = to<P>(a.x);
    n.offset = a.incidence.offsets;
    for (const auto item : a.incidence.items)
        n.slot.push_back(static_cast<int>(2 * static_cast<std::size_t>(item % 3) * a.cell_stride) + item / 3);
    n.allocate();
    return n;
}

/// The largest difference of two gradients, relative to the largest entry.
template <class R>
double difference(const std::vector<R>& a, const std::vector<double>& b)
{
    double most = 0, scale = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
    {
        most = std::max(most, std::abs(double(a[i]) - b[i]));
        scale = std::max(scale, std::abs(double(a[i])));
    }
    return most / scale;
}

class kernel_bench
{
public:
    explicit kernel_bench(bool quick) : quick_(quick), report_(bench::circumstances(queue_)) {}

    const nlohmann::ordered_json& report() const { return report_; }
    bool right() const { return right_; }

    void run()
    {
        std::printf("taut %s %s on %s, driver %s; native: C++ on %u threads\n\n", TAUT_VERSION_STRING,
                    TAUT_BENCH_COMMIT, queue_.device().name().c_str(), queue_.device().driver_version().c_str(),
                    workers_.size());
        if (!quick_)
        {
            const auto c = bench::measure_commands(queue_);
            report_["commands"] = {{"launch", c.launch}, {"launch_and_wait", c.wait}, {"launch_and_read", c.read}};
            std::printf("microseconds: a launch %.1f, with a wait %.1f, with a number read %.1f\n\n", 1e6 * c.launch,
                        1e6 * c.wait, 1e6 * c.read);
        }
        const std::vector<int> sides = quick_ ? std::vector{20} : std::vector{139, 620};
        std::vector<mesh<triangle>> meshes;
        for (const int side : sides) meshes.push_back(shuffled(test::bumpy(side)));

        std::printf("ns a triangle            value           elements        gradient        gradient, given order\n"
                    "triangles precision      taut  native    taut  native    taut  native    taut  native\n");
        for (const auto& m : meshes)
        {
            const arrays ordered(m, true), given(m, false);
            elements<double, double>("double", ordered, given);
            elements<double, float>("mixed", ordered, given);
            elements<float, float>("float", ordered, given);
        }

        std::printf("\nGB/s               native\n"
                    "numbers    type    triad    dot      2 x 8 dots  axpby    sum of 8\n");
        for (const auto& m : meshes)
        {
            const auto n = 2 * padded(static_cast<std::size_t>(m.vertex_count()), layout<triangle>::step);
            vectors<double>("double", n);
            vectors<float>("float", n);
        }
        if (!quick_)
        {
            vectors<double>("double", 8 << 20);
            vectors<float>("float", 8 << 20);
        }

        std::printf("\nNewton, mixed    ns a triangle (GB/s, part of the triad)\n"
                    "triangles        triad  product               smoothing step        Hessians              "
                    "assembly              "
                    "coarse matrices       V-cycle               restriction           prolongation          "
                    "inverse of coarsest   its product\n");
        for (const auto& m : meshes) newton(m);
    }

private:
    int repeats(std::size_t n) const { return quick_ ? 3 : n > 300000 ? 15 : 51; }

    template <class P, class R>
    void elements(const char* precision, const arrays& ordered, const arrays& given)
    {
        const real_types types{scalar_type_of<P>, scalar_type_of<R>};
        device_elements device(queue_, ordered, types), device_given(queue_, given, types);
        auto host = native_elements<P, R>(ordered), host_given = native_elements<P, R>(given);
        const auto gradient = [this](auto& h)
        {
            h.elements(workers_);
            h.gather(workers_);
        };
        const auto t =
            bench::interleaved(repeats(ordered.cells),
                               {[&] { device.value(); }, [&] { host.value(workers_); }, [&] { device.elements(); },
                                [&] { host.elements(workers_); }, [&] { device.gradient(); }, [&] { gradient(host); },
                                [&] { device_given.gradient(); }, [&] { gradient(host_given); }});

        const double error = difference(host.gradient, device.result());
        if (!(error < (sizeof(R) == 8 ? 1e-10 : 1e-3))) right_ = false;

        nlohmann::ordered_json row = {{"what", "elements"}, {"triangles", ordered.cells}, {"precision", precision}};
        const char* names[] = {"value",
                               "native_value",
                               "elements",
                               "native_elements",
                               "gradient",
                               "native_gradient",
                               "gradient_given_order",
                               "native_gradient_given_order"};
        std::printf("%-9zu %-10s", ordered.cells, precision);
        const double per_cell = 1e9 / static_cast<double>(ordered.cells);
        for (std::size_t i = 0; i < t.size(); ++i)
        {
            const std::string name = names[i];
            row[name + "_ns"] = t[i].median * per_cell;
            row[name + "_least_ns"] = t[i].least * per_cell;
            std::printf("%s%8.2f", i % 2 || i == 0 ? "" : "  ", t[i].median * per_cell);
        }
        const double ratio = t[4].median / t[5].median;
        std::printf("   x%.2f (least: %.2f / %.2f)\n", ratio, t[4].least * per_cell, t[5].least * per_cell);
        row["gradient_to_native"] = ratio;
        row["gradient_difference"] = error;
        report_["results"].push_back(row);
    }

    /// What an iteration of Newton's method is made of. Bytes are those that must move, each number once.
    void newton(const mesh<triangle>& m)
    {
        const auto types = types_of(precision::mixed);
        const mesh_levels levels(m);
        const newton_plan<triangle> host(levels, 0, lane_form::for_device(queue_.device()));
        const auto local = host.layout;
        const any_energy energy = energy::isometric{};
        const newton_kernels<triangle> kernels(queue_, energy, types);
        multigrid mg(queue_, types.vector, host.cycle);
        auto& A = mg.matrix();
        const block_assembly assembly(A, host.assembly);
        const element_arrays<triangle> arrays(queue_, types.vector, *local, energy::weighting::measure, energy);
        std::vector<double> positions(2 * local->vertex_stride);
        for (std::size_t v = 0; v < levels.points().size(); ++v)
            for (int c = 0; c < 2; ++c)
                positions[static_cast<std::size_t>(c) * local->vertex_stride + v] =
                    levels.points()[v][c] * local->scale;
        const real_buffer x(queue_, types.position, positions);
        real_buffer hessian(queue_, types.vector, hessian_slots<2>::count * local->cell_stride);
        const auto hessians = [&]
        {
            kernels.second.launch(
                {local->cell_stride, layout<triangle>::step},
                arrays.with(x, {kernels.second.as_argument(definiteness::projected), {"hessian", hessian}}));
        };
        hessians();
        assembly(hessian, A);
        mg.refresh();
        auto g = A.vector(), d = A.vector(), y = A.vector();
        g.data().fill(1);
        const auto &coarse = mg.matrix(1), &last = mg.matrix(mg.levels() - 1);
        const block_transfer transfer(A, host.cycle.transfers.front(), coarse);
        dense_inverse inverse(last, host.cycle.active);
        auto b = coarse.vector(), z = coarse.vector(), r = last.vector(), e = last.vector();
        r.data().fill(1);
        // On a GPU a wait takes as long as a kernel: of many in a row.
        const int in_a_row = queue_.device().is_cpu() || quick_ ? 1 : 20;
        const auto done = [&](auto&& work)
        {
            return [&, work]
            {
                for (int i = 0; i < in_a_row; ++i) work();
                queue_.finish();
            };
        };
        const auto t = bench::interleaved(
            repeats(m.cells().size()),
            {done([&] { A.multiply(g, d); }), done([&] { A.smooth(g, d, d, 1, 0, 0.5, y); }), done(hessians),
             done([&] { assembly(hessian, A); }), done([&] { mg.refresh(); }), done([&] { mg.apply(g, d); }),
             done([&] { transfer.restrict_residual(g, coarse, 0.5, b, z); }), done([&] { transfer.prolong(b, d); }),
             done([&] { inverse.refresh(last); }), done([&] { inverse.apply(r, e); })});
        const auto of = [](const device_vector& v) { return 4.0 * static_cast<double>(v.size()); };
        const double vector = of(g), cells = static_cast<double>(m.cells().size());
        const double lists = static_cast<double>(transfer.columns().bytes() + transfer.weights().bytes());
        const double numbers = static_cast<double>(inverse.inverse().bytes());
        const double product = static_cast<double>(A.product_bytes());
        const double moved[] = {product,
                                product + 3 * vector, // inverses, right side
                                cells * (3 + 3 + 1 + 1 + hessian_slots<2>::count) * 4 + 2 * vector,
                                static_cast<double>(hessian.bytes() + assembly.bytes() + A.values().bytes()),
                                static_cast<double>(mg.bytes()),
                                static_cast<double>(mg.bytes()),
                                lists + vector + 4 * of(b), // and the inverses of its 2 x 2 diagonal blocks
                                lists + 2 * vector + of(b),
                                numbers, // in place: what must be read once
                                numbers + of(r) + of(e)};
        const double triad = bench::device_triad(queue_);
        const char* names[] = {"product", "smoothing",   "hessians",     "assembly",         "refresh",
                               "cycle",   "restriction", "prolongation", "coarsest_inverse", "coarsest_product"};
        nlohmann::ordered_json row = {
            {"what", "newton"}, {"triangles", m.cells().size()}, {"triad_GBps", triad * 1e-9}};
        std::printf("%-12zu %9.1f", m.cells().size(), triad * 1e-9);
        for (std::size_t i = 0; i < t.size(); ++i)
        {
            const std::string name = names[i];
            const double took = t[i].median / in_a_row;
            row[name + "_ns"] = took * 1e9 / cells;
            std::printf("  %7.2f", took * 1e9 / cells);
            const double rate = moved[i] / took;
            row[name + "_GBps"] = rate * 1e-9;
            row[name + "_of_triad"] = rate / triad;
            std::printf(" (%.1f, %.0f %%)", rate * 1e-9, 100 * rate / triad);
        }
        std::printf("\n");
        report_["results"].push_back(row);
    }

    template <class T>
    void vectors(const char* type, std::size_t n)
    {
        const device_vectors space(queue_, scalar_type_of<T>, n);
        std::vector<device_vector> v;
        for (std::size_t k = 0; k < 9; ++k)
        {
            v.push_back(space.make());
            space.axpby(0, v[k], 0, v[k]);
            v[k].data().fill(1 / static_cast<double>(k + 1));
        }
        std::vector<const device_vector*> in;
        for (std::size_t k = 0; k < 8; ++k) in.push_back(&v[k]);
        const std::vector<double> coefficients = {1, -1, 0.5, 2, -2, 0.25, 3, -1};
        std::vector<double> products(16);
        std::vector<T> a(n), b(n, T(1)), c(n, T(2));

        const auto t = bench::interleaved(repeats(n), {[&] { native::triad(workers_, a, b, T(3), c); },
                                                       [&] { space.dot(v[0], v[1]); },
                                                       [&] { space.multi_dot(std::span(in).first(2), in, products); },
                                                       [&]
                                                       {
                                                           space.axpby(0.5, v[0], 0.5, v[8]);
                                                           queue_.finish();
                                                       },
                                                       [&]
                                                       {
                                                           space.linear_combination(coefficients, in, v[8]);
                                                           queue_.finish();
                                                       }});
        // What an ideal implementation moves: each vector once. (2 x 8 dots: the two are among the eight.)
        const double moved[] = {3, 2, 8, 3, 9};
        const char* names[] = {"native_triad", "dot", "multi_dot", "axpby", "linear_combination"};
        nlohmann::ordered_json row = {{"what", "vectors"}, {"numbers", n}, {"type", type}};
        std::printf("%-10zu %-7s", n, type);
        for (std::size_t i = 0; i < t.size(); ++i)
        {
            const double bytes = moved[i] * sizeof(T) * static_cast<double>(n);
            const std::string name = names[i];
            const double rate = bytes / t[i].median * 1e-9;
            row[name + "_GBps"] = rate;
            row[name + "_best_GBps"] = bytes / t[i].least * 1e-9;
            std::printf("%-9.1f%s", rate, i == 2 ? "   " : "");
        }
        std::printf("\n");
        report_["results"].push_back(row);
    }

    bool quick_;
    bool right_ = true;
    queue queue_;
    native::crew workers_;
    nlohmann::ordered_json report_;
};

} // namespace

int main(int argc, char** argv)
try
{
    const bench::options options(argc, argv);
    kernel_bench b(options.quick);
    b.run();
    options.write(b.report());
    if (!b.right()) std::fprintf(stderr, "the device's gradient is not the native one\n");
    return b.right() ? 0 : 1;
}
catch (const std::exception& e)
{
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
