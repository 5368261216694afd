// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace taut::io::impl
{

/// The members of a JSON object in the order of the text, as nlohmann::ordered_map, but found in logarithmic time, as
/// untrusted objects may have any number of members.
template <class Key, class T, class Less = std::less<Key>, class Allocator = std::allocator<std::pair<const Key, T>>>
class ordered_members : public std::vector<std::pair<const Key, T>, Allocator>
{
    using list = std::vector<std::pair<const Key, T>, Allocator>;

public:
    using key_type = Key;
    using mapped_type = T;
    using key_compare = std::equal_to<>;
    using typename list::const_iterator;
    using typename list::iterator;
    using typename list::size_type;
    using typename list::value_type;

    ordered_members() = default;
    template <class It>
    ordered_members(It first, It last)
    {
        insert(first, last);
    }

    template <class K>
    iterator find(const K& key)
    {
        return this->begin() + static_cast<std::ptrdiff_t>(place(key));
    }
    template <class K>
    const_iterator find(const K& key) const
    {
        return this->begin() + static_cast<std::ptrdiff_t>(place(key));
    }
    template <class K>
    size_type count(const K& key) const
    {
        return place(key) < this->size() ? 1 : 0;
    }

    template <class K>
    std::pair<iterator, bool> emplace(K&& key, T&& value)
    {
        if (const auto at = find(key); at != this->end()) return {at, false};
        list::emplace_back(std::forward<K>(key), std::move(value));
        if (!index_.empty())
            index_.emplace(this->back().first, this->size() - 1);
        else if (this->size() > few)
            make_index();
        return {std::prev(this->end()), true};
    }
    std::pair<iterator, bool> insert(value_type&& member) { return emplace(member.first, std::move(member.second)); }
    std::pair<iterator, bool> insert(const value_type& member) { return emplace(member.first, T(member.second)); }
    template <class It>
    void insert(It first, It last)
    {
        for (; first != last; ++first) insert(*first);
    }

    template <class K>
    T& operator[](K&& key)
    {
        return emplace(std::forward<K>(key), T{}).first->second;
    }
    template <class K>
    T& at(const K& key)
    {
        return list::at(place(key)).second;
    }
    template <class K>
    const T& at(const K& key) const
    {
        return list::at(place(key)).second;
    }

    iterator erase(iterator at) { return erase(at, std::next(at)); }
    iterator erase(iterator first, iterator last)
    {
        const auto begin = first - this->begin();
        list rest; // keys are constant, so that nothing moves up
        rest.reserve(this->size());
        for (auto at = this->begin(); at != this->end(); ++at)
            if (at < first || at >= last) rest.emplace_back(at->first, std::move(at->second));
        list::swap(rest);
        index_.clear();
        if (this->size() > few) make_index();
        return this->begin() + begin;
    }
    template <class K>
    size_type erase(K&& key)
    {
        const auto at = find(key);
        if (at == this->end()) return 0;
        erase(at);
        return 1;
    }
    void clear()
    {
        list::clear();
        index_.clear();
    }

private:
    static constexpr std::size_t few = 16; // are looked through

    /// size() if there is none.
    template <class K>
    std::size_t place(const K& key) const
    {
        if (!index_.empty())
        {
            const auto at = index_.find(key);
            return at == index_.end() ? this->size() : at->second;
        }
        std::size_t i = 0;
        while (i < this->size() && !((*this)(i) == key)) ++i;
        return i;
    }
    const Key& operator()(std::size_t i) const { return list::operator[](i).first; }

    void make_index()
    {
        for (std::size_t i = 0; i < this->size(); ++i) index_.emplace((*this)(i), i);
    }

    std::map<Key, std::size_t, std::less<>> index_; // of all members, or empty where they are few
};

/// JSON whose members keep their order.
using gltf_json = nlohmann::basic_json<impl::ordered_members>;

} // namespace taut::io::impl
