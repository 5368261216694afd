// SPDX-License-Identifier: MIT
#include "view/browser.hpp"

#include <fstream>
#include <system_error>

#include <windows.h>

#include <shellapi.h>

#include "view/leading_page.hpp"

namespace taut::view
{

browser::browser(const std::string& url)
{
    const auto path = folder_.path() / "open.html";
    std::ofstream file(path, std::ios::binary);
    if (!(file << page_that_leads_to(url) << std::flush))
        throw std::system_error(EIO, std::generic_category(), path.string());
    file.close();
    ::ShellExecuteW(nullptr, L"open", path.c_str(), nullptr, nullptr, SW_SHOWNORMAL); // or there is none
}

void browser::look() noexcept {}

} // namespace taut::view
