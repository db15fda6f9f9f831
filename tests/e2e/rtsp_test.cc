// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/program.h"
#include <cstdio>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using testing::HasSubstr;

// A server on this machine that goes away after four seconds, as a camera whose cable is pulled.
TEST(RunRtsp, IsCompleteWhenTheServerGoes) {
#ifndef PLUMBLINE_RTSP_SERVER
  GTEST_SKIP() << "no server: install libgstrtspserver-1.0-dev";
#else
  const ScratchFolder folder;
  const std::string pipeline =
      "( videotestsrc is-live=true ! video/x-raw,format=I420,width=320,height=240,framerate=20/1 ! "
      "jpegenc ! rtpjpegpay name=pay0 pt=26 )";
  FILE* server = ::popen(("'" PLUMBLINE_RTSP_SERVER "' 4 '" + pipeline + "'").c_str(), "r");
  ASSERT_NE(server, nullptr);
  int port = 0;
  ASSERT_EQ(std::fscanf(server, "%d", &port), 1);
  const auto camera =
      folder.Write("camera.yaml", "size: [320, 240]\nintrinsics: [300, 300, 160, 120]\n");
  const Outcome outcome =
      RunProgram(folder,
                 "run rtsp://someone:secret@127.0.0.1:" + std::to_string(port) +
                     "/stream --camera " + Quoted(camera) + " --out " + Quoted(folder / "run"));
  ::pclose(server);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              HasSubstr("no more frames: the stream has ended, or the device is gone"));
  const std::string text = Contents(folder / "run/summary.json");
  EXPECT_EQ(text.find("secret"), std::string::npos);
  EXPECT_EQ(Contents(folder / "run/report.html").find("secret"), std::string::npos);
  const auto summary = nlohmann::json::parse(text);
  EXPECT_GE(summary["frames"]["in"], 10);
  // Times of arrival increase.
  std::istringstream table(Contents(folder / "run/frames.csv"));
  std::string row;
  std::getline(table, row);
  double last = 0;
  while (std::getline(table, row)) {
    const double stamp = std::stod(row.substr(row.find(',') + 1));
    EXPECT_GT(stamp, last);
    last = stamp;
  }
#endif
}

}  // namespace
}  // namespace plumbline
