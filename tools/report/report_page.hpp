// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace taut::report
{

/// report/page/report.html, which the build puts here. Its `@data@` is the place of what it shows, in JSON.
extern const std::string_view report_html;

} // namespace taut::report
