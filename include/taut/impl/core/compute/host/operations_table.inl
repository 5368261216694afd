// SPDX-License-Identifier: MIT
// The operations on rows by their codes: included after operations.inl, in the same namespace.

struct table_of_all
{
    std::array<row_operations::handler, row_code::count> all{};

    constexpr void plain(opcode op, scalar_type type, row_operations::handler h)
    {
        all[static_cast<std::size_t>(row_code::plain(op, type))] = h;
    }
    template <class F>
    constexpr void function(opcode op)
    {
        plain(op, scalar_type::f32, each<F, float, 1>);
        plain(op, scalar_type::f64, each<F, double, 1>);
    }
    template <class F>
    constexpr void vectors(opcode op)
    {
        plain(op, scalar_type::f32, map<F, vf, vf>::run);
        plain(op, scalar_type::f64, map<F, vd, vd>::run);
    }
    template <class F>
    constexpr void arithmetic(opcode op)
    {
        plain(op, scalar_type::f32, map<F, vf, vf, vf>::run);
        plain(op, scalar_type::f64, map<F, vd, vd, vd>::run);
        if constexpr (!std::is_same_v<F, quotient>) plain(op, scalar_type::i32, map<F, vu, vu, vu>::run);
    }
    template <class F>
    constexpr void comparison(opcode op)
    {
        plain(op, scalar_type::f32, map<F, vi, vf, vf>::run);
        plain(op, scalar_type::f64, map<F, hi, vd, vd>::run);
        plain(op, scalar_type::i32, map<F, vi, vi, vi>::run);
    }
    template <class V, class I, std::size_t... O>
    constexpr void fused(row_code::inner i, scalar_type type, std::index_sequence<O...>)
    {
        ((all[static_cast<std::size_t>(row_code::pair(i, row_code::outer(O), type))] =
              map<pair<I, int(O)>, V, V, V, V>::run),
         ...);
    }
    template <class V, class I, class J>
    constexpr void joined(row_code::inner i, row_code::inner j, scalar_type type)
    {
        const auto set = [&](row_code::outer o, row_operations::handler h)
        { all[static_cast<std::size_t>(row_code::join(i, j, o, type))] = h; };
        set(row_code::plus, map<join<I, J, row_code::plus>, V, V, V, V, V>::run);
        set(row_code::minus, map<join<I, J, row_code::minus>, V, V, V, V, V>::run);
        set(row_code::times, map<join<I, J, row_code::times>, V, V, V, V, V>::run);
    }
    template <class V, class I>
    constexpr void fused(row_code::inner i, scalar_type type)
    {
        fused<V, I>(i, type, std::make_index_sequence<4>());
        joined<V, I, sum>(i, row_code::sum, type);
        joined<V, I, difference>(i, row_code::difference, type);
        joined<V, I, product>(i, row_code::product, type);
    }
    template <class V>
    constexpr void fused(scalar_type type)
    {
        fused<V, sum>(row_code::sum, type);
        fused<V, difference>(row_code::difference, type);
        fused<V, product>(row_code::product, type);
    }
    template <class T, class I>
    constexpr void of_size(std::size_t wide)
    {
        all[row_code::copy + wide] = map<same, I, I>::run;
        all[row_code::load + wide] = memory<T>::load;
        all[row_code::store + wide] = memory<T>::store;
        all[row_code::gather + wide] = memory<T>::gather;
        all[row_code::masked + wide] = memory<T>::masked;
        all[row_code::scatter + wide] = memory<T>::scatter;
    }
    template <class F, class D, class A>
    constexpr void conversion(scalar_type from, scalar_type to)
    {
        all[static_cast<std::size_t>(row_code::cast(from, to))] = map<F, D, A>::run;
    }

    constexpr void conversions()
    {
        constexpr auto f32 = scalar_type::f32, f64 = scalar_type::f64, i32 = scalar_type::i32, b = scalar_type::boolean;
        conversion<cast<vd>, vd, hf>(f32, f64);
        conversion<cast<hf>, hf, vd>(f64, f32);
        conversion<cast<vi>, vi, vf>(f32, i32);
        conversion<cast<hi>, hi, vd>(f64, i32);
        conversion<cast<vf>, vf, vi>(i32, f32);
        conversion<cast<vd>, vd, hi>(i32, f64);
        conversion<cast_mask<vf>, vf, vi>(b, f32);
        conversion<cast_mask<vd>, vd, hi>(b, f64);
        conversion<cast_mask<vi>, vi, vi>(b, i32);
        conversion<nonzero, vi, vf>(f32, b);
        conversion<nonzero, hi, vd>(f64, b);
        conversion<nonzero, vi, vi>(i32, b);
    }
    constexpr void functions()
    {
        vectors<negative>(opcode::neg);
        plain(opcode::neg, scalar_type::i32, map<negative, vu, vu>::run);
        plain(opcode::abs, scalar_type::f32, map<absolute, vi, vi>::run);
        plain(opcode::abs, scalar_type::f64, map<absolute, vl, vl>::run);
        vectors<square_root>(opcode::sqrt);
        vectors<cube_root>(opcode::cbrt);
        vectors<third_root>(opcode::root3);
        function<floor_of>(opcode::floor);
        function<exp_of>(opcode::exp);
        function<log_of>(opcode::log);
        function<sin_of>(opcode::sin);
        function<cos_of>(opcode::cos);
        function<tan_of>(opcode::tan);
        function<atan_of>(opcode::atan);
        plain(opcode::pow, scalar_type::f32, each<pow_of, float, 1, 2>);
        plain(opcode::pow, scalar_type::f64, each<pow_of, double, 1, 2>);
    }
    constexpr void choices()
    {
        comparison<less>(opcode::less);
        comparison<less_equal>(opcode::less_equal);
        comparison<equal>(opcode::equal);
        comparison<not_equal>(opcode::not_equal);
        plain(opcode::logical_not, scalar_type::boolean, map<inverse, vi, vi>::run);
        plain(opcode::logical_and, scalar_type::boolean, map<both, vi, vi, vi>::run);
        plain(opcode::logical_or, scalar_type::boolean, map<either, vi, vi, vi>::run);
        for (const scalar_type type : {scalar_type::f32, scalar_type::i32, scalar_type::boolean})
            plain(opcode::select, type, map<choice, vi, vi, vi, vi>::run);
        plain(opcode::select, scalar_type::f64, map<choice, vl, hi, vl, vl>::run);
    }

    constexpr table_of_all()
    {
        arithmetic<sum>(opcode::add);
        arithmetic<difference>(opcode::sub);
        arithmetic<product>(opcode::mul);
        arithmetic<quotient>(opcode::div);
        plain(opcode::div, scalar_type::i32, each<integer_quotient, std::int32_t, 1, 2>);
        plain(opcode::rem, scalar_type::i32, each<integer_rest, std::int32_t, 1, 2>);
        functions();
        choices();
        conversions();
        fused<vf>(scalar_type::f32);
        fused<vd>(scalar_type::f64);
        of_size<float, vi>(0);
        of_size<double, vl>(1);
        all[row_code::index] = index;
        all[row_code::loop] = memory<float>::loop;
        all[row_code::loop + 1] = memory<double>::loop;
        all[row_code::loop + 2] = memory<std::int32_t>::loop;
    }
};

constexpr table_of_all table;
