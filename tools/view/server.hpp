// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "view/messages.hpp"

namespace taut::view
{

/// Page served to browsers: three files, the same for everybody.
struct page
{
    std::string_view html, script, style, scene;
};

/// Listens on 127.0.0.1 and serves one subject: one page writes, others look on. Everything runs in run(), on the
/// thread that calls it, but for what says otherwise.
class server
{
public:
    /// port 0: a free one. Throws std::system_error where it is taken.
    server(unsigned short port, page what, std::string model_message);
    ~server();

    /// Address of the page, with the token.
    std::string url() const;

    /// wish: gets the messages of the page that writes; false: it is not taken now. goes_on is asked some times a
    /// second.
    void run(std::function<bool(message)> wish, std::function<bool()> goes_on);

    /// From any thread: shows the state to all pages as soon as they have drawn the last one, and not those between.
    void show(std::shared_ptr<const state> s);

    /// From any thread: another model, encoded, in the place of the one at hand, to all pages.
    void open(std::string model_message);

    /// From any thread: a note or a file, to the page that writes.
    void tell(std::string encoded);

private:
    class body;
    std::unique_ptr<body> body_;
};

} // namespace taut::view
