// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/map/atlas.h"
#include "plumbline/viewer/protocol.h"
#include "plumbline/viewer/view_clients.h"
#include "plumbline/viewer/web_access.h"

#include "fuzz/input_folder.h"
#include <array>
#include <string>

#include <nlohmann/json.hpp>

namespace {

using namespace plumbline;

// Three lines: what a request says of itself. Whoever lacks the token is refused, whatever else the
// request says.
void CheckRequest(std::string_view text) {
  std::array<std::string_view, 3> lines;
  for (std::string_view& line : lines) {
    const std::size_t end = text.find('\n');
    line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  const WebRequestHead request{lines[0], lines[1], lines[2]};
  WebAccess access;
  access.port = 8765;
  WhyRefused(access, request, "machine");
  access.token = "0123456789abcdef0123456789abcdef";
  const bool has_token = lines[0].find(access.token) != std::string_view::npos;
  PLUMBLINE_CHECK(has_token || WhyRefused(access, request, "machine"),
                  "a request without the token is refused");
  PathOf(lines[0]);
}

// Answers are JSON, whatever the question says.
void CheckQuestion(std::string_view json) {
  static const Atlas atlas = [] {
    Atlas empty;
    empty.Start();
    return empty;
  }();
  if (const auto question = ParseMapQuestion(json)) {
    const std::string answer = AnswerMapQuestion(atlas, *question);
    PLUMBLINE_CHECK(nlohmann::json::accept(answer), "an answer that is no JSON");
  }
}

}  // namespace

// What a client of the viewer sends: text and binary messages of the protocol, questions about the
// map, heads of requests, and the address and origins that a user gives.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(AsText(data, size));
  if (const auto message = ParseClientText(text)) {
    if (const auto* call = std::get_if<ServiceCall>(&*message)) CheckQuestion(call->json);
  }
  if (const auto message = ParseClientBinary(text)) {
    if (const auto* call = std::get_if<ServiceCall>(&*message)) CheckQuestion(call->json);
  }
  CheckQuestion(text);
  CheckRequest(text);
  try {
    ParseWebAddress("--view", text);
  } catch (const InputError&) {
  }
  try {
    ParseWebOrigin("--view-origin", text);
  } catch (const InputError&) {
  }
  return 0;
}
