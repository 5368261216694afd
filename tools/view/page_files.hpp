// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace taut::view
{

/// The files of view/page, which the build puts here.
extern const std::string_view page_html, page_script, page_style;

} // namespace taut::view
