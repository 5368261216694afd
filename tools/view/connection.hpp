// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "view/gate.hpp"
#include "view/messages.hpp"
#include "view/server.hpp"

namespace taut::view
{

namespace impl
{

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using error_code = boost::system::error_code;

constexpr std::size_t most_pages = 16;
constexpr std::size_t most_strangers = 64;       // that have not shown the token, which any user of the machine can be
constexpr std::size_t longest_message = 8 << 20; // a region of two million faces
constexpr double messages_a_second = 1000;
constexpr int most_faults = 100; // of one connection, then it is closed
constexpr std::size_t most_waiting = 32;

constexpr const char* subprotocol = "taut";

inline std::string_view text(beast::string_view s)
{
    return {s.data(), s.size()};
}

class connection;

/// State shared by all connections.
struct service
{
    page files;
    std::string model;            ///< the message
    std::optional<gate> entrance; ///< once the port is known
    std::function<bool(message)> wish;
    std::shared_ptr<const state> shown;
    std::vector<connection*> pages;    ///< with an open socket, in the order in which they came
    std::vector<connection*> admitted; ///< that have shown the token: these, and those whose socket is opening
    std::deque<connection*> strangers; ///< that have not, the oldest first
};

/// One client, from its request to the end of its socket.
class connection : public std::enable_shared_from_this<connection>
{
public:
    connection(service& h, tcp::socket socket) : service_(h), stream_(std::move(socket))
    {
        service_.strangers.push_back(this);
    }
    connection(const connection&) = delete;
    connection& operator=(const connection&) = delete;
    ~connection()
    {
        leave();
        std::erase(service_.strangers, this);
        std::erase(service_.admitted, this);
    }

    /// Ends a stranger, to make room.
    void drop()
    {
        std::erase(service_.strangers, this);
        stream_.close();
    }

    void read_request()
    {
        parser_.emplace();
        parser_->header_limit(8192);
        parser_->body_limit(0);
        stream_.expires_after(std::chrono::seconds(10));
        http::async_read(stream_, buffer_, *parser_,
                         [self = shared_from_this()](error_code e, std::size_t)
                         {
                             if (e == http::error::body_limit || e == http::error::header_limit)
                                 self->respond(http::status::payload_too_large, "too long\n", "text/plain");
                             else if (!e)
                                 self->admit();
                         });
    }

    /// Shows the last state, if the page has drawn the one before it.
    void look()
    {
        if (!service_.shown || !drawn_ || shown_ == service_.shown) return;
        shown_ = service_.shown;
        drawn_ = false;
        send(std::make_shared<const std::string>(encode(*shown_, writes())));
    }

    /// The model, and states of it from then on.
    void open_model()
    {
        send(std::make_shared<const std::string>(service_.model));
        shown_.reset();
        drawn_ = true;
    }

    /// Also where it has been shown.
    void look_again()
    {
        shown_.reset();
        drawn_ = true;
        look();
    }

    void send(std::shared_ptr<const std::string> m)
    {
        if (waiting_.size() >= most_waiting) return; // it does not read; pings will find out
        waiting_.push_back(std::move(m));
        if (waiting_.size() == 1) write();
    }

private:
    /// The first page writes. When it goes, the next one does.
    bool writes() const { return !service_.pages.empty() && service_.pages.front() == this; }

    void leave()
    {
        const bool wrote = writes();
        std::erase(service_.pages, this);
        if (wrote && !service_.pages.empty()) service_.pages.front()->look_again();
    }

    void admit()
    {
        const auto request = parser_->release();
        const auto host = text(request[http::field::host]);
        const auto origin = request.find(http::field::origin);
        const bool upgrade = websocket::is_upgrade(request);
        if (request.count(http::field::host) != 1 || !service_.entrance->is_local(host) ||
            (origin == request.end() && upgrade) ||
            (origin != request.end() && !service_.entrance->is_own(text(origin->value()), host)))
            return respond(http::status::forbidden, "forbidden\n", "text/plain");
        if (upgrade)
        {
            if (request.target() != "/live" ||
                !service_.entrance->has_token(text(request[http::field::sec_websocket_protocol])))
                return respond(http::status::forbidden, "forbidden\n", "text/plain");
            if (service_.admitted.size() >= most_pages)
                return respond(http::status::service_unavailable, "too many pages\n", "text/plain");
            std::erase(service_.strangers, this);
            service_.admitted.push_back(this);
            return open(request);
        }
        if (request.method() != http::verb::get && request.method() != http::verb::head)
            return respond(http::status::method_not_allowed, "only GET\n", "text/plain");
        head_ = request.method() == http::verb::head;
        const auto target = text(request.target());
        if (target == "/") return respond(http::status::ok, service_.files.html, "text/html; charset=utf-8");
        if (target == "/page.js") return respond(http::status::ok, service_.files.script, "text/javascript");
        if (target == "/scene.js") return respond(http::status::ok, service_.files.scene, "text/javascript");
        if (target == "/page.css") return respond(http::status::ok, service_.files.style, "text/css");
        respond(http::status::not_found, "not here\n", "text/plain");
    }

    void respond(http::status status, std::string_view content, const char* type)
    {
        using response = http::response<http::span_body<const char>>;
        const auto r = std::make_shared<response>(status, 11);
        r->set(http::field::content_type, type);
        r->set(http::field::cache_control, "no-store");
        r->set("X-Content-Type-Options", "nosniff");
        r->set("Referrer-Policy", "no-referrer");
        r->set("Cross-Origin-Opener-Policy", "same-origin");
        r->set("Cross-Origin-Resource-Policy", "same-origin");
        r->set("Content-Security-Policy",
               "default-src 'none'; script-src 'self'; style-src 'self'; img-src data: blob:; "
               "connect-src 'self'; base-uri 'none'; form-action 'none'; "
               "frame-ancestors 'none'");
        r->keep_alive(false);
        if (!head_) r->body() = {content.data(), content.size()};
        r->content_length(content.size());
        stream_.expires_after(std::chrono::seconds(10));
        http::async_write(stream_, *r,
                          [self = shared_from_this(), r](error_code, std::size_t)
                          {
                              error_code ignored;
                              self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                          });
    }

    template <class Request>
    void open(const Request& request)
    {
        stream_.expires_never();
        socket_.emplace(std::move(stream_));
        socket_->set_option(websocket::stream_base::timeout{std::chrono::seconds(10), std::chrono::seconds(40), true});
        socket_->set_option(websocket::stream_base::decorator(
            [](websocket::response_type& r) { r.set(http::field::sec_websocket_protocol, subprotocol); }));
        socket_->read_message_max(longest_message);
        socket_->binary(true);
        socket_->auto_fragment(false);
        socket_->async_accept(request,
                              [self = shared_from_this()](error_code e)
                              {
                                  if (e) return;
                                  self->service_.pages.push_back(self.get());
                                  self->send(std::make_shared<const std::string>(self->service_.model));
                                  self->look();
                                  self->read();
                              });
    }

    void read()
    {
        socket_->async_read(buffer_,
                            [self = shared_from_this()](error_code e, std::size_t)
                            {
                                if (e) return self->leave();
                                const auto bytes = self->buffer_.cdata();
                                self->take({static_cast<const unsigned char*>(bytes.data()), bytes.size()});
                                self->buffer_.consume(self->buffer_.size());
                                if (self->faults_ < most_faults) return self->read();
                                self->socket_->async_close(websocket::close_code::policy_error, [self](error_code) {});
                            });
    }

    void take(std::span<const unsigned char> bytes)
    {
        try
        {
            if (!socket_->got_binary()) throw message_error("messages are binary");
            if (!allowance_.take(allowance::clock::now())) throw message_error("too many messages a second");
            auto m = parse(bytes);
            if (const auto* seen = std::get_if<ask::seen>(&m.what))
            {
                if (shown_ && seen->state == shown_->number) drawn_ = true;
                return look();
            }
            if (!writes()) throw message_error("another page writes; this one looks on");
            if (!service_.wish(std::move(m))) throw message_error("too many messages wait");
        }
        catch (const message_error& e)
        {
            ++faults_;
            send(std::make_shared<const std::string>(encode_note(e.what())));
        }
    }

    void write()
    {
        socket_->async_write(asio::buffer(*waiting_.front()),
                             [self = shared_from_this()](error_code e, std::size_t)
                             {
                                 if (e) return self->leave();
                                 self->waiting_.pop_front();
                                 if (!self->waiting_.empty()) self->write();
                             });
    }

    service& service_;
    beast::tcp_stream stream_;
    beast::flat_buffer buffer_{longest_message};
    std::optional<http::request_parser<http::string_body>> parser_;
    std::optional<websocket::stream<beast::tcp_stream>> socket_;
    std::deque<std::shared_ptr<const std::string>> waiting_; ///< to be sent; the first one is on its way
    std::shared_ptr<const state> shown_;
    allowance allowance_{messages_a_second};
    int faults_ = 0;
    bool drawn_ = true; ///< the page has drawn what it was shown last
    bool head_ = false;
};

} // namespace impl

} // namespace taut::view
