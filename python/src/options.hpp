// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <taut/errors.hpp>

#include "arrays.hpp"

namespace taut::python
{

/// The keyword arguments of a call, of which None and what is missing leave the default as it is.
class options
{
public:
    explicit options(nb::dict given) : given_(std::move(given)) {}

    /// The value of a name, if it is there and not None.
    std::optional<nb::object> find(const char* name) const
    {
        if (!given_.contains(name)) return std::nullopt;
        nb::object value = given_[name];
        if (value.is_none()) return std::nullopt;
        return value;
    }

    /// Throws parameter_error for a value of another type.
    template <class T>
    bool read(const char* name, T& into) const
    {
        const auto value = find(name);
        if (!value) return false;
        try
        {
            into = nb::cast<T>(*value);
        }
        catch (const nb::cast_error&)
        {
            throw parameter_error(name, "is " + std::string(nb::repr(*value).c_str()) + ", but must be " + wanted<T>());
        }
        return true;
    }

    template <class T>
    T get(const char* name, T otherwise) const
    {
        read(name, otherwise);
        return otherwise;
    }

    std::optional<array> rows(const char* name) const
    {
        array a;
        if (!read(name, a)) return std::nullopt;
        return a;
    }

    /// Throws parameter_error that lists the words there are.
    template <class Enum>
    void read_word(const char* name, Enum& into, std::initializer_list<std::pair<const char*, Enum>> words) const
    {
        std::string word, all;
        if (!read(name, word)) return;
        for (const auto& [text, value] : words)
        {
            if (word == text)
            {
                into = value;
                return;
            }
            all += (all.empty() ? "" : ", ") + std::string(text);
        }
        throw parameter_error(name, "is \"" + word + "\"; it must be one of " + all);
    }

    void read_seconds(const char* name, std::chrono::duration<double>& into) const
    {
        double seconds = into.count();
        if (read(name, seconds)) into = std::chrono::duration<double>(seconds);
    }

    /// What a value of a type is, for messages.
    template <class T>
    static const char* wanted()
    {
        if constexpr (std::is_same_v<T, bool>)
            return "True or False";
        else if constexpr (std::is_integral_v<T>)
            return "a whole number";
        else if constexpr (std::is_floating_point_v<T>)
            return "a number";
        else if constexpr (std::is_same_v<T, std::string>)
            return "a string";
        else
            return "an array of numbers";
    }

    nb::object progress() const
    {
        const auto found = find("progress");
        return found ? *found : nb::none();
    }

private:
    nb::dict given_;
};

} // namespace taut::python
