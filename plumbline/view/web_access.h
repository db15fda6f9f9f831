// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

// Where a server listens and whom it answers.
struct WebAccess {
  std::string host = "127.0.0.1";    // address or name to listen on
  std::uint16_t port = 0;            // 0: any that is free
  std::string token;                 // that every address must have; empty: none
  std::vector<std::string> origins;  // of other pages that may connect, "https://app.example"
};

// "[HOST:]PORT", HOST an address, in brackets where it has colons, or a name; without one the
// loopback address. InputError "--view: expected [HOST:]PORT, found ..." for any other text.
WebAccess ParseWebAddress(std::string_view option, std::string_view text);
// An origin as browsers send it: a scheme, "://", and neither path nor blanks; "file://" and "null"
// too. InputError for any other text.
std::string ParseWebOrigin(std::string_view option, std::string_view text);

// Whether nobody but this machine reaches the host: localhost, 127.x.x.x or ::1.
bool IsLoopback(std::string_view host);

// 128 random bits as hexadecimal digits, from the system.
std::string MakeWebToken();

// What a request says of itself; empty where the header is missing.
struct WebRequestHead {
  std::string_view target;  // "/?token=..."
  std::string_view host;    // header Host
  std::string_view origin;  // header Origin
};

// Why the request is not to be answered; nullopt where it is.
//
// Host must be an address, localhost, the name that the server listens on, or this machine's: a
// name that somebody else made to mean this address (DNS rebinding) is none of these. Origin must
// be missing, the server's own or one of those named. The token must be right where there is one;
// it is compared in a time that does not depend on where it differs.
std::optional<std::string> WhyRefused(const WebAccess& access,
                                      const WebRequestHead& request,
                                      std::string_view machine_name);

// "/keyframe/12" of "/keyframe/12?token=...".
std::string_view PathOf(std::string_view target);

}  // namespace plumbline
