// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>

#include <unistd.h>

#include <picture/format.hpp>

namespace taut::tools
{

/// Modes of progress output.
enum class progress_mode
{
    bar,  ///< one line that is drawn over and over: for a terminal
    json, ///< one JSON object a line: for programs
    none
};

/// "auto", "json" or "none" as given by the user; auto is a bar if `terminal`, else none. Nothing for another word.
inline std::optional<progress_mode> parse_progress_mode(std::string_view word,
                                                        bool terminal = ::isatty(STDERR_FILENO) == 1)
{
    if (word == "auto") return terminal ? progress_mode::bar : progress_mode::none;
    if (word == "json") return progress_mode::json;
    if (word == "none") return progress_mode::none;
    return std::nullopt;
}

/// Progress of a run.
struct progress_report
{
    std::string_view phase = {}; ///< "start map", "optimize", ...
    int step = 0;                ///< iterations done in this phase
    int most_steps = 0;          ///< limit of the phase; 0 if there is none, which leaves out the bar itself
    double energy = std::numeric_limits<double>::quiet_NaN();   ///< left out while not finite
    double gradient = std::numeric_limits<double>::quiet_NaN(); ///< relative norm, for programs only
    double inverted = std::numeric_limits<double>::quiet_NaN(); ///< elements; left out while not finite
    double length = std::numeric_limits<double>::quiet_NaN();   ///< of the last step, for programs only
    double seconds = 0;                                         ///< since the start of the run
};

/// Tells progress on a stream, standard error as a rule, at most `rate` times a second: a run of a millisecond a step
/// must not wait for its terminal. The first report and every change of phase are told at once, the last one by
/// finish().
class progress
{
public:
    progress(progress_mode mode, std::ostream& out, double rate = 12) : mode_(mode), out_(&out), pause_(1 / rate) {}

    ~progress() { finish(); }

    progress(const progress&) = delete;
    progress& operator=(const progress&) = delete;

    void update(const progress_report& report)
    {
        if (mode_ == progress_mode::none) return;
        const bool due = phase_ != report.phase || !(report.seconds - told_at_ < pause_);
        if (pending_ && mode_ == progress_mode::json && phase_ != report.phase) tell(); // the end of the last phase
        pending_ = !due;
        line_ = mode_ == progress_mode::json ? json_line(report) : bar_line(report);
        if (!due) return;
        phase_ = report.phase;
        told_at_ = report.seconds;
        tell();
    }

    /// Tells what was held back, and takes the bar off the terminal. Reports may go on afterwards.
    void finish()
    {
        if (pending_ && mode_ == progress_mode::json) tell();
        if (!line_.empty() && mode_ == progress_mode::bar) *out_ << "\r\x1b[K" << std::flush;
        pending_ = false;
        line_.clear();
        phase_.clear();
    }

    /// `[########............] optimize  step 12  energy 7.446  0.53 s`
    static std::string bar_line(const progress_report& report)
    {
        constexpr int cells = 24;
        std::string line;
        if (report.most_steps > 0)
        {
            const double part = std::min(1.0, std::max(0, report.step) / double(report.most_steps));
            const auto full = static_cast<std::size_t>(part * cells);
            line.append(1, '[').append(full, '#').append(cells - full, '.').append("] ");
        }
        line += report.phase;
        if (report.step > 0 || report.most_steps > 0) line += "  step " + std::to_string(report.step);
        if (std::isfinite(report.inverted)) line += "  inverted " + io::impl::format_number(report.inverted, 9);
        if (std::isfinite(report.energy)) line += "  energy " + io::impl::format_number(report.energy);
        return line + "  " + io::impl::format_number(std::round(report.seconds * 100) / 100, 6) + " s";
    }

    /// One object, numbers with the digits that identify them; what is not known is null:
    /// `{"phase":"optimize","iteration":12,"energy":7.446,"gradient":0.01,"step":1,"seconds":0.53}`
    static std::string json_line(const progress_report& report)
    {
        std::string line = "{\"phase\":\"";
        for (const char c : report.phase)
        {
            if (c == '"' || c == '\\') line += '\\';
            line += static_cast<unsigned char>(c) < 32 ? ' ' : c;
        }
        const auto number = [](double x)
        {
            if (!std::isfinite(x)) return std::string("null");
            std::array<char, 32> digits{};
            return std::string(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr);
        };
        return line + "\",\"iteration\":" + std::to_string(report.step) + ",\"energy\":" + number(report.energy) +
               ",\"gradient\":" + number(report.gradient) + ",\"step\":" + number(report.length) +
               (std::isfinite(report.inverted) ? ",\"inverted\":" + number(report.inverted) : "") +
               ",\"seconds\":" + number(report.seconds) + "}";
    }

private:
    void tell()
    {
        if (mode_ == progress_mode::json)
            *out_ << line_ << '\n' << std::flush;
        else
            *out_ << '\r' << line_ << "\x1b[K" << std::flush; // K clears what a longer line left behind
    }

    progress_mode mode_;
    std::ostream* out_;
    double pause_;
    double told_at_ = -std::numeric_limits<double>::infinity();
    bool pending_ = false;
    std::string phase_;
    std::string line_;
};

} // namespace taut::tools
