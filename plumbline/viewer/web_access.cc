// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/web_access.h"

#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <random>

#include <fmt/format.h>

namespace plumbline {
namespace {

bool IsDigits(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::string LowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

// Returns "::1" for "[::1]:8080", "localhost" for "localhost:8080".
std::string_view WithoutPort(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == std::string_view::npos ? std::string_view() : host.substr(1, end - 1);
  }
  return host.substr(0, host.find(':'));
}

// Returns true if the host is an address: four numbers, or a text with colons, which names do not
// have.
bool IsAddress(std::string_view host) {
  if (host.find(':') != std::string_view::npos) {
    return std::all_of(host.begin(), host.end(), [](char c) {
      return std::isxdigit(static_cast<unsigned char>(c)) != 0 || c == ':' || c == '.';
    });
  }
  int parts = 0;
  while (true) {
    const std::size_t dot = host.find('.');
    if (!IsDigits(host.substr(0, dot))) return false;
    ++parts;
    if (dot == std::string_view::npos) return parts == 4;
    host.remove_prefix(dot + 1);
  }
}

std::string_view TokenOf(std::string_view target) {
  constexpr std::string_view kName = "token=";
  const std::size_t question = target.find('?');
  if (question == std::string_view::npos) return {};
  std::string_view query = target.substr(question + 1);
  while (!query.empty()) {
    const std::size_t end = query.find('&');
    const std::string_view pair = query.substr(0, end);
    if (pair.starts_with(kName)) return pair.substr(kName.size());
    if (end == std::string_view::npos) break;
    query.remove_prefix(end + 1);
  }
  return {};
}

bool SameInConstantTime(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    different |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  }
  return different == 0;
}

bool HostIsKnown(const WebAccess& access, std::string_view host, std::string_view machine_name) {
  const std::string name = LowerCase(WithoutPort(host));
  if (name.empty()) return false;
  const std::string machine = LowerCase(machine_name);
  return IsAddress(name) || name == "localhost" || name == LowerCase(access.host) ||
         (!machine.empty() && (name == machine || name == machine + ".local"));
}

bool OriginIsKnown(const WebAccess& access, const WebRequestHead& request) {
  if (request.origin.empty()) return true;
  if (request.origin == "http://" + std::string(request.host)) return true;
  return std::find(access.origins.begin(), access.origins.end(), request.origin) !=
         access.origins.end();
}

}  // namespace

WebAccess ParseWebAddress(std::string_view option, std::string_view text) {
  const auto fail = [&] {
    throw InputError(fmt::format(
        "{}: expected [HOST:]PORT, a port from 0 to 65535, found {}", option, InQuotes(text)));
  };
  WebAccess access;
  const std::size_t colon = text.rfind(':');
  const std::string_view port = colon == std::string_view::npos ? text : text.substr(colon + 1);
  const char* end = port.data() + port.size();
  const auto [stop, error] = std::from_chars(port.data(), end, access.port);
  if (error != std::errc() || stop != end) fail();
  if (colon == std::string_view::npos) return access;
  std::string_view host = text.substr(0, colon);
  if (host.starts_with('[')) {
    if (!host.ends_with(']')) fail();
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string_view::npos) {
    fail();
  }
  const bool plain = std::all_of(host.begin(), host.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == ':' || c == '-' ||
           c == '_';
  });
  if (host.empty() || !plain) fail();
  access.host = host;
  return access;
}

std::string ParseWebOrigin(std::string_view option, std::string_view text) {
  const std::size_t scheme = text.find("://");
  const std::string_view rest =
      scheme == std::string_view::npos ? std::string_view() : text.substr(scheme + 3);
  const bool whole =
      scheme != std::string_view::npos && scheme > 0 && (text == "file://" || !rest.empty()) &&
      rest.find('/') == std::string_view::npos &&
      std::none_of(
          text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) <= ' '; });
  if (!whole && text != "null") {
    throw InputError(
        fmt::format("{}: expected the origin of a page, as https://app.example, found {}",
                    option,
                    InQuotes(text)));
  }
  return std::string(text);
}

bool IsLoopback(std::string_view host) {
  return LowerCase(host) == "localhost" || host == "::1" ||
         (host.starts_with("127.") && IsAddress(host));
}

std::string MakeWebToken() {
  std::random_device device;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", static_cast<std::uint32_t>(device()));
  return token;
}

std::string_view PathOf(std::string_view target) { return target.substr(0, target.find('?')); }

std::optional<std::string> WhyRefused(const WebAccess& access,
                                      const WebRequestHead& request,
                                      std::string_view machine_name) {
  if (!HostIsKnown(access, request.host, machine_name)) return "unknown host";
  if (!OriginIsKnown(access, request)) return "unknown origin";
  if (!access.token.empty() && !SameInConstantTime(TokenOf(request.target), access.token)) {
    return "the token is missing or wrong";
  }
  return std::nullopt;
}

}  // namespace plumbline
