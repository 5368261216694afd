// SPDX-License-Identifier: MIT
#pragma once

#include <taut/io/io_error.hpp>

#include "failure.hpp"
#include "png.hpp"

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

} // namespace taut::tools
