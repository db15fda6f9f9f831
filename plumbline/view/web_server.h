// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/view/web_access.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace plumbline {

struct WebFile {
  std::string type;  // "text/html; charset=utf-8"
  std::shared_ptr<const std::string> bytes;
};

// One WebSocket, while it is open.
class WebClient {
 public:
  WebClient() = default;
  WebClient(const WebClient&) = delete;
  WebClient& operator=(const WebClient&) = delete;
  virtual ~WebClient() = default;

  virtual void SendText(std::string text) = 0;
  // `body` comes behind `head` in one message, and is not copied.
  virtual void SendBinary(std::string head, std::shared_ptr<const std::string> body) = 0;
  // Messages that are not in the system's hands yet. A client that lets kMostWaiting of them pile
  // up is closed.
  virtual std::size_t waiting() const = 0;
  static constexpr std::size_t kMostWaiting = 64;
};

// What becomes of what comes in; all calls in the thread of Run().
struct WebEvents {
  // The file at a path ("/"); nullopt: there is none.
  std::function<std::optional<WebFile>(std::string_view path)> get;
  std::function<void(WebClient&)> opened;
  std::function<void(WebClient&, std::string_view message, bool binary)> received;
  std::function<void(WebClient&)> drained;  // nothing is waiting any more
  std::function<void(WebClient&)> closed;   // the last one of it
};

struct WebServerLoop;
struct WebServerCore;

// A web server for a page, its files and WebSockets of Foxglove's protocol, in one thread. Only GET
// and HEAD; nobody writes anything. At most kMostConnections at once: more are closed as they come.
// Whoever is silent for ten seconds before a request, for a minute behind the pings of a WebSocket,
// or sends what is no request, is closed. Requests are limited to 8 kB, messages to 64 kB.
class WebServer {
 public:
  static constexpr std::size_t kMostConnections = 64;

  // Listens from now on; without `access` nowhere, and only does what is posted. InputError where
  // that is not possible: "127.0.0.1:80: ...".
  WebServer(const std::optional<WebAccess>& access, WebEvents events);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  // Of a server that listens. "http://127.0.0.1:8080/", with the token.
  std::string url() const;

  // Serves until Stop.
  void Run();
  // From any thread: calls `work` in the thread of Run, soon or at a time.
  void Post(std::function<void()> work);
  void PostAt(std::chrono::steady_clock::time_point time, std::function<void()> work);
  // From any thread: tells the clients that there will be no more, and ends Run, within a second.
  void Stop();

 private:
  std::unique_ptr<WebServerLoop> loop_;
  std::shared_ptr<WebServerCore> core_;  // what is open has a part in it; goes before the loop
};

}  // namespace plumbline
