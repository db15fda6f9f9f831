// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/viewer/web_access.h"

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

// An open WebSocket.
class WebClient {
 public:
  WebClient() = default;
  WebClient(const WebClient&) = delete;
  WebClient& operator=(const WebClient&) = delete;
  virtual ~WebClient() = default;

  virtual void SendText(std::string text) = 0;
  // Sends `head` and `body` in one message; `body` is not copied.
  virtual void SendBinary(std::string head, std::shared_ptr<const std::string> body) = 0;
  // Returns the number of messages that the system has not accepted yet. A client with kMostWaiting
  // of them is closed.
  virtual std::size_t waiting() const = 0;
  static constexpr std::size_t kMostWaiting = 64;
};

// Handlers of requests and messages, all called in the thread of Run().
struct WebEvents {
  // Returns the file at a path ("/"); nullopt if it does not exist.
  std::function<std::optional<WebFile>(std::string_view path)> get;
  std::function<void(WebClient&)> opened;
  std::function<void(WebClient&, std::string_view message, bool binary)> received;
  std::function<void(WebClient&)> drained;  // no message is waiting any more
  std::function<void(WebClient&)> closed;   // last call for this client
};

struct WebServerLoop;
struct WebServerCore;

// A web server for a page, its files and WebSockets of Foxglove's protocol, in one thread. It
// answers only GET and HEAD, so that it is read-only. At most kMostConnections are open at once;
// further ones are closed immediately. Clients are closed if silent for ten seconds before a
// request, or for a minute after the pings of a WebSocket, or after an invalid request. Requests
// are limited to 8 kB, messages to 64 kB.
class WebServer {
 public:
  static constexpr std::size_t kMostConnections = 64;

  // Starts to listen; without `access` it does not listen and only runs posted work. Throws
  // InputError if listening fails: "127.0.0.1:80: ...".
  WebServer(const std::optional<WebAccess>& access, WebEvents events);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  // Returns the address of a listening server, "http://127.0.0.1:8080/", with the token.
  std::string url() const;

  // Serves until Stop() is called.
  void Run();
  // Calls `work` in the thread of Run, soon or at a time. Thread-safe.
  void Post(std::function<void()> work);
  void PostAt(std::chrono::steady_clock::time_point time, std::function<void()> work);
  // Announces the end to the clients, and ends Run within a second. Thread-safe.
  void Stop();

 private:
  std::unique_ptr<WebServerLoop> loop_;
  std::shared_ptr<WebServerCore> core_;  // shared with open connections; released before the loop
};

}  // namespace plumbline
