#include "viewer/view_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <csignal>
#include <iostream>
#include <set>
#include <stdexcept>
#include <utility>

#include "viewer/access.h"
#include "viewer/page_files.h"

namespace nextview {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using beast::error_code;

constexpr std::size_t kLargestWord = 4096;  // of a page
constexpr std::chrono::seconds kPatience{30};

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

class PageSocket;

}  // namespace

struct ViewServer::State {
  State(std::deque<ServedRun>& served, const std::filesystem::path& folder, std::uint16_t wanted)
      : runs(served), files(page_files(folder)), acceptor(io) {
    const tcp::endpoint here(asio::ip::address_v4::loopback(), wanted);
    acceptor.open(here.protocol());
    acceptor.set_option(asio::socket_base::reuse_address(true));
    acceptor.bind(here);
    acceptor.listen();
    port = acceptor.local_endpoint().port();
  }
  State(std::deque<ServedRun>& served, const std::filesystem::path& folder, ListeningSocket socket)
      : runs(served), files(page_files(folder)), acceptor(io) {
    acceptor.assign(tcp::v4(), socket.fd);
    port = acceptor.local_endpoint().port();
  }

  void accept();
  void pump_all();
  void left(PageSocket* socket);

  std::deque<ServedRun>& runs;
  const std::map<std::string, PageFile, std::less<>> files;
  std::uint16_t port = 0;
  std::set<PageSocket*> sockets;
  std::atomic<bool> notified = false;
  // Last, so that it goes first, and the sockets with it.
  asio::io_context io{1};
  tcp::acceptor acceptor;
  asio::signal_set signals{io};
};

namespace {

/// One page's WebSocket: one message at a time in either direction.
class PageSocket : public std::enable_shared_from_this<PageSocket> {
 public:
  PageSocket(ViewServer::State& server, tcp::socket socket)
      : server_(server), socket_(std::move(socket)), outbox_(server.runs) {
    server_.sockets.insert(this);
  }
  ~PageSocket() { server_.left(this); }

  void accept(const http::request<http::string_body>& request) {
    socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    socket_.read_message_max(kLargestWord);
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return;
      self->read();
      self->pump();
    });
  }

  /// Sends what there is to send.
  void pump() {
    if (writing_ || !socket_.is_open()) return;
    try {
      auto message = outbox_.next();
      if (!message) return;
      message_ = std::move(*message);
    } catch (const std::exception& error) {
      return fail(error.what());
    }
    writing_ = true;
    socket_.binary(message_.binary);
    socket_.async_write(asio::buffer(message_.bytes),
                        [self = shared_from_this()](error_code error, std::size_t) {
                          self->writing_ = false;
                          if (!error) self->pump();
                        });
  }

 private:
  void read() {
    socket_.async_read(words_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return;
      try {
        self->outbox_.take(
            beast::buffers_to_string(self->words_.data()),
            [&server = self->server_] { asio::post(server.io, [&server] { server.pump_all(); }); });
      } catch (const std::exception& wrong) {
        return self->fail(wrong.what());
      }
      self->words_.consume(self->words_.size());
      self->pump();
      self->read();
    });
  }

  void fail(const char* why) {
    std::cerr << "nextview_viewer: a page was left: " << why << std::endl;
    socket_.async_close(websocket::close_code::policy_error,
                        [self = shared_from_this()](error_code) {});
  }

  ViewServer::State& server_;
  websocket::stream<beast::tcp_stream> socket_;
  Outbox outbox_;
  beast::flat_buffer words_;
  Outbox::Message message_;  // on its way
  bool writing_ = false;
};

/// One request for a file, or to become a PageSocket.
class Request : public std::enable_shared_from_this<Request> {
 public:
  Request(ViewServer::State& server, tcp::socket socket)
      : server_(server), stream_(std::move(socket)) {}

  void read() {
    stream_.expires_after(kPatience);
    http::async_read(stream_, buffer_, request_,
                     [self = shared_from_this()](error_code error, std::size_t) {
                       if (!error) self->answer();
                     });
  }

 private:
  void answer() {
    if (!is_own_host(view(request_[http::field::host]), server_.port)) {
      return send(http::status::misdirected_request,
                  {"text/plain", "not the name of this server\n"});
    }
    if (websocket::is_upgrade(request_)) return become_socket();
    if (request_.method() != http::verb::get && request_.method() != http::verb::head) {
      return send(http::status::method_not_allowed, {"text/plain", "GET or HEAD\n"});
    }
    const std::string_view target = view(request_.target());
    const auto file = server_.files.find(target.substr(0, target.find('?')));
    if (file == server_.files.end()) {
      return send(http::status::not_found, {"text/plain", "no such file\n"});
    }
    send(http::status::ok, file->second);
  }

  void become_socket() {
    if (view(request_.target()) != "/socket") {
      return send(http::status::not_found, {"text/plain", "the socket is /socket\n"});
    }
    if (!is_own_origin(view(request_[http::field::origin]), server_.port)) {
      return send(http::status::forbidden, {"text/plain", "for pages of this server only\n"});
    }
    stream_.expires_never();
    std::make_shared<PageSocket>(server_, stream_.release_socket())->accept(request_);
  }

  void send(http::status status, const PageFile& file) {
    response_ = {status, request_.version()};
    response_.set(http::field::content_type, file.type);
    response_.set(http::field::cache_control, "no-cache");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    // Nothing from anywhere else, whatever a page may come to hold; no frame of another's.
    response_.set("Content-Security-Policy",
                  fmt::format("default-src 'self'; img-src 'self' blob: data:; style-src 'self' "
                              "'unsafe-inline'; connect-src ws://127.0.0.1:{0} ws://localhost:{0}; "
                              "frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
                              server_.port));
    response_.keep_alive(false);
    if (request_.method() == http::verb::head) {
      response_.content_length(file.content.size());
    } else {
      response_.body() = file.content;
      response_.prepare_payload();
    }
    http::async_write(stream_, response_, [self = shared_from_this()](error_code, std::size_t) {
      error_code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  ViewServer::State& server_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{16 * 1024};
  http::request<http::string_body> request_;
  http::response<http::string_body> response_;
};

}  // namespace

void ViewServer::State::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error) {
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      std::make_shared<Request>(*this, std::move(socket))->read();
    }
    accept();
  });
}

void ViewServer::State::pump_all() {
  for (PageSocket* socket : std::set<PageSocket*>(sockets)) socket->pump();
}

void ViewServer::State::left(PageSocket* socket) {
  sockets.erase(socket);
  if (!sockets.empty()) return;
  // A run that nobody looks at any more goes on.
  for (ServedRun& run : runs) run.viewed.set_pace(kAnyView);
}

ViewServer::ViewServer(std::deque<ServedRun>& runs, const std::filesystem::path& page,
                       std::uint16_t port) {
  try {
    state_ = std::make_unique<State>(runs, page, port);
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error(
        fmt::format("port {} of 127.0.0.1 cannot be had: {}", port, error.code().message()));
  }
  start();
}

ViewServer::ViewServer(std::deque<ServedRun>& runs, const std::filesystem::path& page,
                       ListeningSocket socket) {
  try {
    state_ = std::make_unique<State>(runs, page, socket);
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error(
        fmt::format("file descriptor {} does not listen: {}", socket.fd, error.code().message()));
  }
  start();
}

void ViewServer::start() {
  for (ServedRun& run : state_->runs) {
    run.viewed.on_change([this] { notify(); });
  }
  state_->accept();
}

ViewServer::~ViewServer() {
  for (ServedRun& run : state_->runs) {
    run.viewed.on_change({});
    run.cad.cancel();
  }
}

std::uint16_t ViewServer::port() const { return state_->port; }
void ViewServer::serve() { state_->io.run(); }
void ViewServer::stop() { state_->io.stop(); }

void ViewServer::end_on_signals() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) state_->signals.add(number);
  state_->signals.async_wait([this](error_code error, int) {
    if (!error) stop();
  });
}

void ViewServer::notify() {
  if (state_->notified.exchange(true)) return;
  asio::post(state_->io, [state = state_.get()] {
    state->notified = false;
    state->pump_all();
  });
}

}  // namespace nextview
