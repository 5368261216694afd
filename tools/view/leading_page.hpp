// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace taut::view
{

inline std::string page_that_leads_to(const std::string& url)
{
    return "<!doctype html>\n<meta charset=\"utf-8\">\n<title>taut</title>\n<meta http-equiv=\"refresh\" "
           "content=\"0;url=" +
           url + "\">\n<a href=\"" + url + "\">taut</a>\n";
}

} // namespace taut::view
