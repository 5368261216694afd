// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <taut/files.hpp>

#include "shared/failure.hpp"
#include "shared/interrupt.hpp"
#include "shared/outputs.hpp"
#include "shared/png.hpp"
#include "shared/run_clock.hpp"

namespace taut::tools
{

/// Runs what writes files; whatever could not be written is an output_error.
template <class F>
void writing(F&& write)
{
    try
    {
        write();
    }
    catch (const io::io_error& e)
    {
        throw output_error(e.what());
    }
    catch (const picture_error& e)
    {
        throw output_error(e.what());
    }
}

/// Returns whether there is a picture of that name to be drawn. Whoever interrupts a run does not wait for pictures:
/// their names are cleared, with a note.
inline bool drawn(std::string& picture, std::vector<std::string>& notes)
{
    if (interrupted() && !picture.empty())
    {
        notes.push_back("interrupted: " + picture + " was not drawn");
        picture.clear();
    }
    return !picture.empty();
}

/// Adds a picture of that name to the files of a run, if one is to be drawn. seconds: grows by what drawing takes,
/// which is no part of the writing. The clock is referred to, too.
template <class Draw>
void add_picture(std::vector<io::file_to_write>& files, std::string& picture, std::vector<std::string>& notes,
                 const run_clock& clock, double& seconds, Draw draw)
{
    if (!drawn(picture, notes)) return;
    files.push_back({picture, [draw, &clock, &seconds](io::atomic_file& file)
                     {
                         std::string image;
                         seconds += clock.timed([&] { image = draw(); });
                         file.write(image);
                     }});
}

/// Throws output_error: what is printed is a result, too.
inline void write_standard_output(std::string_view text)
{
    writing([&] { io::write_file(standard_output, text); });
}

} // namespace taut::tools
