// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace taut::report
{

/// report/page/report.html, which the build puts here. Its `@data@` is the place of what it shows, in JSON, its
/// `@scene@` that of the script.
extern const std::string_view report_html;

/// view/page/scene.js, with three.js: of reports and of the page of `taut view`.
extern const std::string_view scene_script;

} // namespace taut::report
