// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/base64.h"

#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace plumbline {

// A connection to a port of this machine that sends arbitrary bytes.
class TestSocket {
 public:
  explicit TestSocket(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0) {
      ::close(socket_);
      throw std::runtime_error("cannot connect");
    }
  }
  ~TestSocket() { Close(); }
  TestSocket(TestSocket&& other) noexcept
      : socket_(std::exchange(other.socket_, -1)), read_(std::move(other.read_)) {}
  TestSocket& operator=(TestSocket&&) = delete;

  void Close() {
    if (socket_ >= 0) ::close(std::exchange(socket_, -1));
  }
  // Ends both directions; a thread that waits is woken.
  void Shutdown() const { ::shutdown(socket_, SHUT_RDWR); }
  // Returns false if the other side is gone.
  bool Send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }
  // Returns the next `count` bytes; nullopt if they do not come within ten seconds, or never will.
  std::optional<std::string> Take(std::size_t count) {
    while (read_.size() < count) {
      if (!ReadMore()) return std::nullopt;
    }
    std::string taken = read_.substr(0, count);
    read_.erase(0, count);
    return taken;
  }
  // Returns everything up to a mark and the mark, or until the other side closes.
  std::string TakeUntil(std::string_view mark) {
    std::size_t at = std::string::npos;
    while ((at = read_.find(mark)) == std::string::npos) {
      if (!ReadMore()) return std::exchange(read_, {});
    }
    return *Take(at + mark.size());
  }
  bool IsClosedByPeer() {
    while (ReadMore()) {
    }
    return closed_;
  }

 private:
  bool ReadMore() {
    constexpr int kPatienceMs = 10'000;
    pollfd readable{socket_, POLLIN, 0};
    if (::poll(&readable, 1, kPatienceMs) <= 0) return false;
    char bytes[65536];
    const ssize_t count = ::recv(socket_, bytes, sizeof(bytes), 0);
    closed_ = count <= 0;
    if (closed_) return false;
    read_.append(bytes, static_cast<std::size_t>(count));
    return true;
  }

  int socket_;
  std::string read_;
  bool closed_ = false;
};

// Opening request of a browser for a WebSocket.
struct Handshake {
  std::string target = "/";
  std::string host = "127.0.0.1";
  std::string origin;  // none if empty
  std::string protocols = "foxglove.websocket.v1";
};

// A hand-written WebSocket client, independent of the server's library.
class WebSocketClient {
 public:
  struct Message {
    bool binary = false;
    std::string bytes;
  };

  explicit WebSocketClient(std::uint16_t port, const Handshake& hello = {}) : socket_(port) {
    const std::string origin = hello.origin.empty() ? "" : "Origin: " + hello.origin + "\r\n";
    socket_.Send("GET " + hello.target + " HTTP/1.1\r\nHost: " + hello.host +
                 "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: " +
                 EncodeBase64("0123456789abcdef") + "\r\nSec-WebSocket-Version: 13\r\n" + origin +
                 "Sec-WebSocket-Protocol: " + hello.protocols + "\r\n\r\n");
    head_ = socket_.TakeUntil("\r\n\r\n");
  }

  // Status line and headers of the answer.
  const std::string& head() const { return head_; }
  bool is_open() const { return head_.starts_with("HTTP/1.1 101"); }
  TestSocket& socket() { return socket_; }

  void SendText(std::string_view text) { SendFrame(1, text); }
  void SendBinary(std::string_view bytes) { SendFrame(2, bytes); }

  // Returns the next text or binary message; nullopt if the server closes, or sends nothing for
  // long.
  std::optional<Message> Receive() {
    Message message;
    while (true) {
      const auto head = socket_.Take(2);
      if (!head) return std::nullopt;
      const unsigned first = static_cast<std::uint8_t>((*head)[0]);
      std::uint64_t size = static_cast<std::uint8_t>((*head)[1]) & 127U;
      if (size >= 126) {
        const auto bytes = socket_.Take(size == 126 ? 2 : 8);
        if (!bytes) return std::nullopt;
        size = 0;
        for (const char c : *bytes) size = size << 8U | static_cast<std::uint8_t>(c);
      }
      const auto payload = socket_.Take(size);
      const unsigned op = first & 15U;
      if (!payload || op == 8) return std::nullopt;
      if (op == 9) {
        SendFrame(10, *payload);
        continue;
      }
      if (op == 10) continue;
      if (op != 0) message.binary = op == 2;
      message.bytes += *payload;
      if ((first & 128U) != 0) return message;
    }
  }

 private:
  // Masked, as required of clients, by a mask that changes nothing.
  void SendFrame(unsigned op, std::string_view bytes) {
    std::string frame(1, static_cast<char>(128U | op));
    if (bytes.size() < 126) {
      frame += static_cast<char>(128U | bytes.size());
    } else {
      frame += static_cast<char>(128U | 126U);
      frame += static_cast<char>(bytes.size() >> 8U);
      frame += static_cast<char>(bytes.size());
    }
    frame += std::string(4, '\0');
    frame += bytes;
    socket_.Send(frame);
  }

  TestSocket socket_;
  std::string head_;
};

}  // namespace plumbline
