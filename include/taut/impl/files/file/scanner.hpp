// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include <taut/errors.hpp>
#include <taut/types.hpp>

namespace taut::io::impl
{

/// Fails if a text is of two bytes a letter.
inline void refuse_utf16(std::string_view text, const std::string& path)
{
    const auto alternates = [&](std::size_t zero) // 'v' 0 ' ' 0, or the other way round
    { return text.size() >= 4 && text[zero] == 0 && text[zero + 2] == 0 && text[1 - zero] > 0 && text[3 - zero] > 0; };
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") || alternates(0) || alternates(1))
        throw io_error(path, "a text in UTF-16; save it as UTF-8");
}

/// Returns whether two words are the same but for the case of their letters.
inline bool same_letters(std::string_view a, std::string_view b)
{
    const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return small(x) == small(y); });
}

/// Reads words and numbers from a text that stays alive. Lines end with LF, CR LF or CR; a backslash before the end of
/// a line joins it to the next one, as OBJ wants. Independent of the locale.
class scanner
{
public:
    /// comments: whether # ends a word, too, as in OFF; names in OBJ may contain it
    scanner(std::string_view text, std::string path, bool comments = false)
        : begin_(text.data()), at_(begin_), end_(begin_ + text.size()), comments_(comments), path_(std::move(path))
    {
        if (text.starts_with("\xef\xbb\xbf")) at_ += 3; // byte order mark of UTF-8
    }

    bool done() const { return at_ == end_; }
    const char* start() const { return begin_; }
    const char* position() const { return at_; }
    std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
    const std::string& path() const { return path_; }

    /// Skips blanks and joined line ends.
    void skip_blanks()
    {
        for (;;)
        {
            const char* p = at_;
            while (p != end_ && is_blank(*p)) ++p;
            at_ = p;
            if (end_ - at_ < 2 || *at_ != '\\' || !is_line_end(at_[1])) return;
            ++at_;
            skip_line_end();
        }
    }

    /// Returns whether nothing but blanks is left on the line.
    bool line_ends()
    {
        skip_blanks();
        return done() || is_line_end(*at_);
    }

    /// Returns whether no more than blanks and a comment from # on are left on the line.
    bool content_ends() { return line_ends() || at('#'); }

    /// Takes the rest of the line, without leading blanks.
    std::string_view rest_of_line()
    {
        while (at_ != end_ && is_blank(*at_)) ++at_;
        const char* const first = at_;
        while (at_ != end_ && !is_line_end(*at_)) ++at_;
        return since(first);
    }

    /// Goes to the start of the next line. With `joined`, lines joined by a backslash count as one.
    void next_line(bool joined = false)
    {
        for (;;)
        {
            const char* p = at_;
            for (; p != end_ && !is_line_end(*p); ++p) joined = joined && *p != '#'; // a comment ends with its line
            at_ = p;
            const bool goes_on = joined && at_ != begin_ && at_ != end_ && at_[-1] == '\\';
            skip_line_end();
            if (!goes_on || done()) return;
        }
    }

    /// Skips blanks and line ends.
    void skip_space()
    {
        while (line_ends() && !done()) skip_line_end();
    }

    /// The next word on the line; empty at its end.
    std::string_view word()
    {
        skip_blanks();
        const char *const first = at_, *p = first;
        while (!ends_word(p)) ++p;
        at_ = p;
        return {first, static_cast<std::size_t>(p - first)};
    }

    /// Returns whether the next character is c.
    bool at(char c) const { return !done() && *at_ == c; }

    bool at_digit() const { return !done() && *at_ >= '0' && *at_ <= '9'; }

    /// Returns whether the word ends here.
    bool word_ends() const { return ends_word(at_); }

    /// Returns whether the next character is c; if so it is taken.
    bool take(char c)
    {
        if (done() || *at_ != c) return false;
        ++at_;
        return true;
    }

    /// A decimal number, "nan", "inf" or what Microsoft's library prints for these as a word of its own, with an
    /// exponent as C (1e3) or Fortran (1D+3) prints it. Too large: infinity. Throws io_error.
    double number()
    {
        skip_blanks();
        double value = 0;
        if (short_number(value) || take_no_number(value)) return value;
        const char* first = after_plus();
        const auto [last, failure] = std::from_chars(first, end_, value);
        if (failure == std::errc{} && take_fortran_number(last, value)) return value;
        if (failure == std::errc::invalid_argument || !ends_word(last)) fail_at_word("a number");
        if (failure == std::errc::result_out_of_range) value = beyond_range({first, last});
        at_ = last;
        return value;
    }

    /// D numbers on the line.
    template <int D>
    vec<D> numbers()
    {
        vec<D> x;
        for (int k = 0; k < D; ++k) x[k] = number();
        return x;
    }

    /// A decimal integer as a word of its own. Throws io_error.
    long long integer(const char* what)
    {
        skip_blanks();
        const char* const first = at_;
        const long long value = leading_integer(what);
        if (word_ends()) return value;
        at_ = first;
        fail_at_word(what);
    }

    /// A decimal integer, which may be followed by anything. Throws io_error.
    long long leading_integer(const char* what)
    {
        skip_blanks();
        long long value = 0;
        const char* p = at_;
        for (; p != end_ && p - at_ < 18 && *p >= '0' && *p <= '9'; ++p) value = 10 * value + (*p - '0');
        if (p != at_ && p - at_ < 18)
        {
            at_ = p;
            return value;
        }
        const auto [last, failure] = std::from_chars(after_plus(), end_, value);
        if (failure != std::errc{}) fail_at_word(what);
        at_ = last;
        return value;
    }

    /// The next n bytes, which are taken whatever they are. Throws io_error with the byte where there are fewer.
    std::string_view bytes(std::size_t n)
    {
        if (n > remaining())
            throw io_error(path_, "the file ends too early; it is cut off, or its counts are wrong", byte_of(at_));
        at_ += n;
        return {at_ - n, n};
    }

    /// Goes to a position in the text.
    void go_to(const char* position) { at_ = position; }

    /// Text between an earlier position and this one.
    std::string_view since(const char* position) const { return {position, static_cast<std::size_t>(at_ - position)}; }

    /// Fails if this is a binary file.
    void require_text() const
    {
        if (std::string_view(at_, remaining()).find('\0') != std::string_view::npos)
            throw io_error(path_,
                           "not a text file: it has bytes 0; save it as text, or name it after the format that it has");
    }

    /// The present line. Slow (it counts), hence a function to hand on, called for errors.
    auto here() const
    {
        return [this] { return line_of(at_); };
    }

    /// The line of a position in the text, counted from 1.
    file_place line_of(const char* position) const
    {
        std::size_t line = 1;
        for (const char* p = begin_; p != position; ++p)
            if (*p == '\n' || (*p == '\r' && (p + 1 == end_ || p[1] != '\n'))) ++line;
        return {file_place::line, line};
    }

    /// The byte of a position in the text, counted from 0.
    file_place byte_of(const char* position) const
    {
        return {file_place::byte, static_cast<std::size_t>(position - begin_)};
    }

    [[noreturn]] void fail(const std::string& what) const { throw io_error(path_, what, line_of(at_)); }

    /// Fails with "expected X, found Y".
    [[noreturn]] void fail_at_word(const std::string& expected)
    {
        const char* const first = at_;
        const std::string found(word().substr(0, 40));
        at_ = first;
        fail("expected " + expected + (found.empty() ? ", found the end of the line" : ", found '" + found + "'"));
    }

private:
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
    static bool is_line_end(char c) { return c == '\n' || c == '\r'; }

    /// Returns whether p is the end, a blank, a line end, or the backslash of one, or starts a comment.
    bool ends_word(const char* p) const
    {
        return p == end_ || is_blank(*p) || is_line_end(*p) || (*p == '\\' && p + 1 != end_ && is_line_end(p[1])) ||
               (comments_ && *p == '#');
    }

    /// Start of the digits: behind a plus sign that no minus sign follows.
    const char* after_plus() const { return end_ - at_ > 1 && *at_ == '+' && at_[1] != '-' ? at_ + 1 : at_; }

    void skip_line_end()
    {
        if (at_ != end_ && *at_ == '\r')
            ++at_, take('\n');
        else if (at_ != end_ && *at_ == '\n')
            ++at_;
    }

    /// Takes a number of the form -1.25, as most are, if its digits fit a double: it is then the quotient of two
    /// doubles that are exact, so that one rounding gives the value nearest to it. False, and nothing taken, for any
    /// other.
    bool short_number(double& value)
    {
        constexpr std::uint64_t exact = std::uint64_t{1} << 53;
        static constexpr std::array<double, 23> powers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                       1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                       1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
        const char* p = at_;
        const bool negative = p != end_ && *p == '-';
        if (negative) ++p;
        std::uint64_t digits = 0;
        const auto take_digits = [&]
        {
            const char* const first = p;
            for (; p != end_ && *p >= '0' && *p <= '9' && digits < exact; ++p)
                digits = 10 * digits + static_cast<std::uint64_t>(*p - '0');
            return static_cast<std::size_t>(p - first);
        };
        if (take_digits() == 0) return false;
        std::size_t fraction = 0;
        if (p != end_ && *p == '.')
        {
            ++p;
            if (p != end_ && *p == '#') return false; // 1.#INF
            fraction = take_digits();
        }
        if (digits > exact || fraction >= powers.size() || !ends_word(p)) return false;
        value = static_cast<double>(digits) / powers[fraction];
        if (negative) value = -value;
        at_ = p;
        return true;
    }

    /// Takes what Microsoft's library prints for what is no number: 1.#INF, -1.#IND00, 1.#QNAN.
    bool take_no_number(double& value)
    {
        constexpr std::string_view begin = "1.#";
        const char* p = at_;
        if (p != end_ && (*p == '-' || *p == '+')) ++p;
        if (!std::string_view(p, static_cast<std::size_t>(end_ - p)).starts_with(begin)) return false;
        const char* const first = p += begin.size();
        while (p != end_ && *p >= 'A' && *p <= 'Z') ++p;
        const std::string_view letters(first, static_cast<std::size_t>(p - first));
        while (p != end_ && *p >= '0' && *p <= '9') ++p;
        if (letters.empty() || !ends_word(p)) return false;
        using limits = std::numeric_limits<double>;
        value = letters == "INF" ? (*at_ == '-' ? -limits::infinity() : limits::infinity()) : limits::quiet_NaN();
        at_ = p;
        return true;
    }

    /// Takes a number whose exponent begins with D, as Fortran writes those of double precision, of which the mantissa
    /// ends at `letter`.
    bool take_fortran_number(const char* letter, double& value)
    {
        if (letter == end_ || (*letter != 'D' && *letter != 'd')) return false;
        const char *const first = after_plus(), *last = letter;
        while (!ends_word(last)) ++last;
        std::string word(first, last);
        word[static_cast<std::size_t>(letter - first)] = 'e';
        const char* const end = word.data() + word.size();
        const auto [stop, failure] = std::from_chars(word.data(), end, value);
        if (failure == std::errc::invalid_argument || stop != end) return false;
        if (failure == std::errc::result_out_of_range) value = beyond_range(word);
        at_ = last;
        return true;
    }

    /// Value of a number beyond the range of double: 0 if it is below 1, else infinity.
    static double beyond_range(std::string_view digits)
    {
        const auto e = std::min(digits.find_first_of("eE"), digits.size());
        const std::string_view mantissa = digits.substr(0, e);
        const auto point = std::min(mantissa.find('.'), e);
        const auto leading = mantissa.find_first_of("123456789");
        if (leading == mantissa.npos) return 0.0;
        long long exponent = 0;
        std::string_view power = digits.substr(std::min(e + 1, digits.size()));
        if (power.starts_with('+')) power.remove_prefix(1);
        if (std::from_chars(power.data(), power.data() + power.size(), exponent).ec == std::errc::result_out_of_range)
            return power.starts_with('-') ? 0.0 : std::numeric_limits<double>::infinity();
        const auto before_point = static_cast<long long>(point) - static_cast<long long>(leading);
        return exponent > -before_point ? std::numeric_limits<double>::infinity() : 0.0;
    }

    const char *begin_, *at_, *end_;
    bool comments_;
    std::string path_;
};

} // namespace taut::io::impl
