// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

// Where a server listens, and whom it answers.
struct WebAccess {
  std::string host = "127.0.0.1";  // address or name to listen on
  std::uint16_t port = 0;          // 0: any free port
  std::string token;               // token that every address must have; empty: none
  // Origins of other pages that may connect: "https://app.example".
  std::vector<std::string> origins;
};

// Parses "[HOST:]PORT". HOST is an address, in brackets where it has colons, or a name; without it
// the loopback address is used. Throws InputError "--view: expected [HOST:]PORT, found ..." for any
// other text.
WebAccess ParseWebAddress(std::string_view option, std::string_view text);
// Parses an origin as browsers send it: a scheme, "://", and neither path nor blanks; also
// "file://" and "null". Throws InputError for any other text.
std::string ParseWebOrigin(std::string_view option, std::string_view text);

// Whether only this machine can reach the host: localhost, 127.x.x.x or ::1.
bool IsLoopback(std::string_view host);

// Returns 128 random bits from the system, as hexadecimal digits.
std::string MakeWebToken();

// The parts of a request that decide about access; empty where the header is missing.
struct WebRequestHead {
  std::string_view target;  // "/?token=..."
  std::string_view host;    // header Host
  std::string_view origin;  // header Origin
};

// Returns why the request is not to be answered; nullopt where it is.
//
// Host must be an address, localhost, the name that the server listens on, or this machine's: a
// foreign name that was made to mean this address (DNS rebinding) is none of these. Origin must be
// missing, the server's own or one of those named. The token must be right where there is one; the
// time of its comparison does not depend on where it differs.
std::optional<std::string> WhyRefused(const WebAccess& access,
                                      const WebRequestHead& request,
                                      std::string_view machine_name);

// Returns "/keyframe/12" for "/keyframe/12?token=...".
std::string_view PathOf(std::string_view target);

}  // namespace plumbline
