// SPDX-License-Identifier: MIT
#include "view/server.hpp"

#include <chrono>
#include <utility>

#if !defined(_WIN32)
#include <fcntl.h>
#endif

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "view/connection.hpp"

namespace taut::view
{

using namespace impl;

namespace
{

/// No child keeps it open. Windows: sockets are not handed on.
template <class Socket>
void close_on_exec([[maybe_unused]] Socket& socket)
{
#if !defined(_WIN32)
    ::fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
#endif
}

} // namespace

class server::body
{
public:
    body(unsigned short port, page what, std::string model_message)
        : service_{what, std::move(model_message), {}, {}, {}, {}, {}, {}},
          acceptor_(io_, {asio::ip::make_address("127.0.0.1"), port})
    {
        close_on_exec(acceptor_);
        service_.entrance.emplace(acceptor_.local_endpoint().port());
    }

    ~body() { service_.pages.clear(); } // none takes over from another

    std::string url() const
    {
        return "http://127.0.0.1:" + std::to_string(acceptor_.local_endpoint().port()) + "/#" +
               service_.entrance->token();
    }

    void run(std::function<bool(message)> grant, std::function<bool()> goes_on)
    {
        service_.wish = std::move(grant);
        accept();
        watch(std::move(goes_on));
        io_.run();
    }

    void show(std::shared_ptr<const state> s)
    {
        asio::post(io_,
                   [this, s = std::move(s)]
                   {
                       service_.shown = s;
                       for (connection* c : service_.pages) c->look();
                   });
    }

    void open(std::string model_message)
    {
        asio::post(io_,
                   [this, m = std::move(model_message)]() mutable
                   {
                       service_.model = std::move(m);
                       service_.shown.reset(); // of the model before: a page that comes now must not get it
                       for (connection* c : service_.pages) c->open_model();
                   });
    }

    void tell(std::string encoded)
    {
        asio::post(io_,
                   [this, m = std::make_shared<const std::string>(std::move(encoded))]
                   {
                       if (!service_.pages.empty()) service_.pages.front()->send(m);
                   });
    }

private:
    void accept()
    {
        acceptor_.async_accept(
            [this](error_code e, tcp::socket socket)
            {
                // No more of them, or none where the process may open no more files.
                if (!service_.strangers.empty() && (e || service_.strangers.size() >= most_strangers))
                    service_.strangers.front()->drop();
                if (!e)
                {
                    error_code ignored;
                    close_on_exec(socket);
                    socket.set_option(tcp::no_delay(true), ignored); // what is small waits for no acknowledgement
                    std::make_shared<connection>(service_, std::move(socket))->read_request();
                }
                if (acceptor_.is_open()) accept();
            });
    }

    void watch(std::function<bool()> goes_on)
    {
        timer_.expires_after(std::chrono::milliseconds(250));
        timer_.async_wait(
            [this, goes_on = std::move(goes_on)](error_code) mutable
            {
                if (goes_on())
                    watch(std::move(goes_on));
                else
                    io_.stop();
            });
    }

    service service_; // which connections, that end with io_, refer to
    asio::io_context io_{1};
    tcp::acceptor acceptor_;
    asio::steady_timer timer_{io_};
};

server::server(unsigned short port, page what, std::string model_message)
    : body_(std::make_unique<body>(port, what, std::move(model_message)))
{
}

server::~server() = default;

std::string server::url() const
{
    return body_->url();
}

void server::run(std::function<bool(message)> grant, std::function<bool()> goes_on)
{
    body_->run(std::move(grant), std::move(goes_on));
}

void server::show(std::shared_ptr<const state> s)
{
    body_->show(std::move(s));
}

void server::open(std::string model_message)
{
    body_->open(std::move(model_message));
}

void server::tell(std::string encoded)
{
    body_->tell(std::move(encoded));
}

} // namespace taut::view
