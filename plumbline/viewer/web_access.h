// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

// Address of a server, and the clients that it accepts.
struct WebAccess {
  std::string host = "127.0.0.1";  // address or name to listen on
  std::uint16_t port = 0;          // 0: any free port
  std::string token;               // token required in every address; empty: none
  // Origins of other pages that may connect: "https://app.example".
  std::vector<std::string> origins;
};

// Parses "[HOST:]PORT". HOST is an address, in brackets if it has colons, or a name; without it the
// loopback address is used. Throws InputError "--view: expected [HOST:]PORT, found ..." for any
// other text.
WebAccess ParseWebAddress(std::string_view option, std::string_view text);
// Parses an origin as browsers send it: a scheme, "://", and neither path nor blanks; also
// "file://" and "null". Throws InputError for any other text.
std::string ParseWebOrigin(std::string_view option, std::string_view text);

// Returns true if only this machine can reach the host: localhost, 127.x.x.x or ::1.
bool IsLoopback(std::string_view host);

// Returns 128 random bits from the system, as hexadecimal digits.
std::string MakeWebToken();

// Parts of a request for access control; empty if the header is missing.
struct WebRequestHead {
  std::string_view target;  // "/?token=..."
  std::string_view host;    // header Host
  std::string_view origin;  // header Origin
};

// Returns the reason to refuse the request; nullopt if it is accepted.
//
// Host must be an address, localhost, the server's name, or this machine's: a foreign name resolved
// to this address (DNS rebinding) is none of these. Origin must be missing, the server's own or one
// of the allowed ones. The token, if any, must be right; the time of its comparison does not depend
// on the position of a difference.
std::optional<std::string> WhyRefused(const WebAccess& access,
                                      const WebRequestHead& request,
                                      std::string_view machine_name);

// Returns "/keyframe/12" for "/keyframe/12?token=...".
std::string_view PathOf(std::string_view target);

}  // namespace plumbline
