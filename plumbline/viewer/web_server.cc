// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/web_server.h"

#include "plumbline/base/error.h"
#include "plumbline/viewer/protocol.h"

#include <algorithm>
#include <array>
#include <deque>
#include <set>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/host_name.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>

namespace plumbline {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kLargestRequest = 8 * 1024;
constexpr std::size_t kLargestMessage = 64 * 1024;
// Bytes that the system takes for a client that does not read; more would only be late.
constexpr int kSendBuffer = 512 * 1024;
constexpr auto kRequestTime = std::chrono::seconds(10);
constexpr auto kSilence = std::chrono::seconds(60);
constexpr auto kFarewell = std::chrono::milliseconds(300);
constexpr auto kRetryAccept = std::chrono::milliseconds(100);

using Request = http::request<http::empty_body>;

std::string_view View(boost::string_view text) { return {text.data(), text.size()}; }

// Returns the first of our subprotocols that the client offers; empty if it offers none.
std::string_view ChooseSubprotocol(std::string_view offered) {
  for (const std::string_view known : kFoxgloveSubprotocols) {
    std::string_view rest = offered;
    while (!rest.empty()) {
      const std::size_t comma = rest.find(',');
      std::string_view name = rest.substr(0, comma);
      while (name.starts_with(' ')) name.remove_prefix(1);
      while (name.ends_with(' ')) name.remove_suffix(1);
      if (name == known) return known;
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
  }
  return {};
}

}  // namespace

class WebSocketSession;

struct WebServerLoop {
  asio::io_context io{1};
};

struct WebServerCore {
  WebServerCore(asio::io_context& the_io, WebAccess the_access, WebEvents the_events)
      : access(std::move(the_access)),
        events(std::move(the_events)),
        io(the_io),
        acceptor(io),
        retry(io) {
    error_code ignored;
    machine = asio::ip::host_name(ignored);
  }

  WebAccess access;
  WebEvents events;
  std::string machine;  // name of this machine
  asio::io_context& io;
  Tcp::acceptor acceptor;
  asio::steady_timer retry;
  std::size_t connections = 0;
  std::set<WebSocketSession*> sockets;
  bool stopping = false;
};

namespace {

// Counts a connection as long as it exists.
class Place {
 public:
  explicit Place(std::shared_ptr<WebServerCore> core) : core_(std::move(core)) {
    ++core_->connections;
  }
  ~Place() {
    if (core_) --core_->connections;
  }
  Place(Place&&) noexcept = default;
  Place& operator=(Place&&) = delete;
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  WebServerCore* operator->() const { return core_.get(); }

 private:
  std::shared_ptr<WebServerCore> core_;
};

}  // namespace

// A session lives as long as one of its reads or writes is under way.
class WebSocketSession : public WebClient, public std::enable_shared_from_this<WebSocketSession> {
 public:
  WebSocketSession(Place core, beast::tcp_stream stream)
      : core_(std::move(core)), socket_(std::move(stream)) {}
  ~WebSocketSession() override { Leave(); }

  void Accept(const Request& request) {
    const std::string_view protocol =
        ChooseSubprotocol(View(request[http::field::sec_websocket_protocol]));
    beast::get_lowest_layer(socket_).expires_never();
    websocket::stream_base::timeout times{};
    times.handshake_timeout = kRequestTime;
    times.idle_timeout = kSilence;
    times.keep_alive_pings = true;
    socket_.set_option(times);
    socket_.set_option(
        websocket::stream_base::decorator([protocol](websocket::response_type& response) {
          response.set(http::field::sec_websocket_protocol,
                       boost::string_view(protocol.data(), protocol.size()));
        }));
    socket_.read_message_max(kLargestMessage);
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (!error) self->Open();
    });
  }

  void SendText(std::string text) override { Send({std::move(text), nullptr, true}); }
  void SendBinary(std::string head, std::shared_ptr<const std::string> body) override {
    Send({std::move(head), std::move(body), false});
  }
  std::size_t waiting() const override { return queue_.size(); }

  // Says good-bye if the client listens.
  void End() {
    if (!queue_.empty()) return Drop();
    socket_.async_close(websocket::close_code::going_away,
                        [self = shared_from_this()](error_code) { self->Leave(); });
  }

 private:
  struct Outgoing {
    std::string head;
    std::shared_ptr<const std::string> body;  // may be null
    bool text = false;
  };

  void Open() {
    if (core_->stopping) return Drop();
    core_->sockets.insert(this);
    open_ = true;
    core_->events.opened(*this);
    Read();
  }

  void Read() {
    socket_.async_read(incoming_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->Drop();
      const auto bytes = self->incoming_.cdata();
      const std::string message(static_cast<const char*>(bytes.data()), bytes.size());
      self->incoming_.consume(message.size());
      if (self->open_) {
        self->core_->events.received(*self, message, self->socket_.got_binary());
        self->Read();
      }
    });
  }

  void Send(Outgoing message) {
    if (!open_) return;
    if (queue_.size() >= kMostWaiting) return Drop();
    queue_.push_back(std::move(message));
    if (queue_.size() == 1) Write();
  }

  void Write() {
    const Outgoing& next = queue_.front();
    socket_.text(next.text);
    std::array<asio::const_buffer, 2> parts = {asio::buffer(next.head), asio::const_buffer()};
    if (next.body) parts[1] = asio::buffer(*next.body);
    socket_.async_write(parts, [self = shared_from_this()](error_code error, std::size_t) {
      if (error || !self->open_) return self->Drop();
      self->queue_.pop_front();
      if (!self->queue_.empty()) return self->Write();
      self->core_->events.drained(*self);
    });
  }

  void Drop() {
    Leave();
    error_code ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
  }

  void Leave() {
    if (!std::exchange(open_, false)) return;
    core_->sockets.erase(this);
    core_->events.closed(*this);
  }

  Place core_;
  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer incoming_;
  std::deque<Outgoing> queue_;  // the first message is being written
  bool open_ = false;
};

namespace {

// One request and its answer, or the beginning of a WebSocket.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Place core, Tcp::socket socket) : core_(std::move(core)), stream_(std::move(socket)) {}

  void Start() {
    parser_.header_limit(static_cast<std::uint32_t>(kLargestRequest));
    stream_.expires_after(kRequestTime);
    http::async_read(
        stream_, buffer_, parser_, [self = shared_from_this()](error_code error, std::size_t) {
          if (!error) self->Answer();
        });
  }

 private:
  using Response = http::response<http::string_body>;

  void Answer() {
    const Request& request = parser_.get();
    const WebRequestHead head{View(request.target()),
                              View(request[http::field::host]),
                              View(request[http::field::origin])};
    // Nothing would check the fields after the second one.
    for (const auto field : {http::field::host, http::field::origin}) {
      if (request.count(field) < 2) continue;
      return Reply(http::status::bad_request,
                   fmt::format("expected one header {}, found several", View(to_string(field))));
    }
    if (const auto why = WhyRefused(core_->access, head, core_->machine)) {
      return Reply(http::status::forbidden, *why);
    }
    if (websocket::is_upgrade(request)) return Upgrade();
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
      return Reply(http::status::method_not_allowed, "only GET and HEAD");
    }
    const auto file = core_->events.get(PathOf(head.target));
    if (!file) return Reply(http::status::not_found, "no such file");
    ReplyWith(http::status::ok, file->type, *file->bytes);
  }

  void Upgrade() {
    if (ChooseSubprotocol(View(parser_.get()[http::field::sec_websocket_protocol])).empty()) {
      return Reply(http::status::bad_request,
                   fmt::format("expected the subprotocol {} or {}",
                               kFoxgloveSubprotocols[0],
                               kFoxgloveSubprotocols[1]));
    }
    const auto session = std::make_shared<WebSocketSession>(std::move(core_), std::move(stream_));
    session->Accept(parser_.get());
  }

  void Reply(http::status status, const std::string& text) {
    ReplyWith(status, "text/plain; charset=utf-8", text + "\n");
  }

  void ReplyWith(http::status status, const std::string& type, const std::string& bytes) {
    response_ = Response(status, parser_.get().version());
    response_.set(http::field::content_type, type);
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("X-Frame-Options", "DENY");
    response_.set("Referrer-Policy", "no-referrer");
    response_.keep_alive(false);
    response_.content_length(bytes.size());
    if (parser_.get().method() != http::verb::head) response_.body() = bytes;
    http::async_write(stream_, response_, [self = shared_from_this()](error_code, std::size_t) {
      error_code ignored;
      self->stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
    });
  }

  Place core_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kLargestRequest};
  http::request_parser<http::empty_body> parser_;
  Response response_;
};

void AcceptNext(const std::shared_ptr<WebServerCore>& core);

void TakeIn(const std::shared_ptr<WebServerCore>& core, Tcp::socket socket) {
  if (core->connections >= WebServer::kMostConnections) return;  // returning closes the socket
  error_code ignored;
  socket.set_option(Tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
  std::make_shared<Connection>(Place(core), std::move(socket))->Start();
}

void AcceptNext(const std::shared_ptr<WebServerCore>& core) {
  core->acceptor.async_accept([core](error_code error, Tcp::socket socket) {
    if (core->stopping || error == asio::error::operation_aborted) return;
    if (!error) {
      TakeIn(core, std::move(socket));
      return AcceptNext(core);
    }
    // The system lacks some resource; the next attempt may succeed.
    core->retry.expires_after(kRetryAccept);
    core->retry.async_wait([core](error_code) {
      if (!core->stopping) AcceptNext(core);
    });
  });
}

void Listen(WebServerCore& core) {
  const WebAccess& access = core.access;
  Tcp::resolver resolver(core.io);
  const auto addresses =
      resolver.resolve(access.host, std::to_string(access.port), Tcp::resolver::passive);
  const Tcp::endpoint endpoint = addresses.begin()->endpoint();
  core.acceptor.open(endpoint.protocol());
  core.acceptor.set_option(asio::socket_base::reuse_address(true));
  core.acceptor.bind(endpoint);
  core.acceptor.listen();
}

}  // namespace

WebServer::WebServer(const std::optional<WebAccess>& access, WebEvents events)
    : loop_(std::make_unique<WebServerLoop>()),
      core_(std::make_shared<WebServerCore>(
          loop_->io, access.value_or(WebAccess()), std::move(events))) {
  if (!access) return;
  try {
    Listen(*core_);
  } catch (const boost::system::system_error& error) {
    throw InputError(fmt::format("{}:{}: cannot listen there: {}",
                                 core_->access.host,
                                 core_->access.port,
                                 error.code().message()));
  }
}

// Connections that are still open end with the loop, without a call of `closed`.
WebServer::~WebServer() {
  core_->stopping = true;
  core_->events.closed = [](WebClient&) {};
}

std::string WebServer::url() const {
  const WebAccess& access = core_->access;
  const bool colons = access.host.find(':') != std::string::npos;
  std::string host = colons ? "[" + access.host + "]" : access.host;
  if (host == "0.0.0.0" || host == "[::]") host = core_->machine;
  const std::string token = access.token.empty() ? "" : "?token=" + access.token;
  return fmt::format("http://{}:{}/{}", host, core_->acceptor.local_endpoint().port(), token);
}

void WebServer::Run() {
  if (core_->acceptor.is_open()) AcceptNext(core_);
  const auto guard = asio::make_work_guard(core_->io);
  core_->io.run();
}

void WebServer::Post(std::function<void()> work) { asio::post(core_->io, std::move(work)); }

void WebServer::PostAt(std::chrono::steady_clock::time_point time, std::function<void()> work) {
  const auto timer = std::make_shared<asio::steady_timer>(core_->io, time);
  timer->async_wait([timer, work = std::move(work)](error_code error) {
    if (!error) work();
  });
}

void WebServer::Stop() {
  Post([core = core_] {
    core->stopping = true;
    error_code ignored;
    core->acceptor.close(ignored);
    core->retry.cancel();
    const std::set<WebSocketSession*> sockets = core->sockets;
    for (WebSocketSession* socket : sockets) socket->End();
    core->retry.expires_after(kFarewell);
    core->retry.async_wait([core](error_code error) {
      if (!error) core->io.stop();
    });
  });
}

}  // namespace plumbline
