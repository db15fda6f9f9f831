// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/program.h"
#include <cstdio>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

#ifdef PLUMBLINE_RTSP_SERVER
constexpr const char* kPipeline =
    "( videotestsrc is-live=true ! video/x-raw,format=I420,width=320,height=240,framerate=20/1 ! "
    "jpegenc ! rtpjpegpay name=pay0 pt=26 )";

// A server on this machine that goes away after some seconds, as a camera whose cable is pulled.
class Server {
 public:
  // port 0: any.
  Server(int seconds, int port) {
    const std::string command = std::string("'" PLUMBLINE_RTSP_SERVER "' ") +
                                std::to_string(seconds) + ' ' + std::to_string(port) + " '" +
                                kPipeline + "'";
    output_ = ::popen(command.c_str(), "r");
    if (output_ == nullptr || std::fscanf(output_, "%d", &port_) != 1) {
      throw std::runtime_error("no server");
    }
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  // Waits until it is gone.
  ~Server() { ::pclose(output_); }
  int port() const { return port_; }

 private:
  FILE* output_ = nullptr;
  int port_ = 0;
};
#endif

// The stream is there, goes, comes back and goes for good.
TEST(RunRtsp, GoesOnWhenTheServerComesBackAndIsCompleteWhenItDoesNot) {
#ifndef PLUMBLINE_RTSP_SERVER
  GTEST_SKIP() << "no server: install libgstrtspserver-1.0-dev";
#else
  const ScratchFolder folder;
  auto server = std::make_unique<Server>(4, 0);
  const int port = server->port();
  std::thread again([&] {
    server.reset();
    server = std::make_unique<Server>(6, port);
  });
  const auto camera =
      folder.Write("camera.yaml", "size: [320, 240]\nintrinsics: [300, 300, 160, 120]\n");
  const Outcome outcome =
      RunProgram(folder,
                 "run rtsp://someone:secret@127.0.0.1:" + std::to_string(port) +
                     "/stream --camera " + Quoted(camera) + " --out " + Quoted(folder / "run"));
  again.join();
  EXPECT_EQ(outcome.code, 1) << outcome.err;  // what does not move gives no pose
  EXPECT_THAT(outcome.err, HasSubstr("no more frames come; it is opened again for 10 s"));
  EXPECT_THAT(outcome.err,
              HasSubstr("no more frames: the stream has ended, or the device is gone"));
  EXPECT_EQ(Contents(folder / "run/summary.json").find("secret"), std::string::npos);
  EXPECT_EQ(Contents(folder / "run/report.html").find("secret"), std::string::npos);
  // Times of arrival increase, and there are frames after the first loss.
  std::istringstream table(Contents(folder / "run/frames.csv"));
  std::string row;
  std::getline(table, row);
  double last = 0;
  int losses = 0, before = 0, after = 0;
  while (std::getline(table, row)) {
    const double stamp = std::stod(row.substr(row.find(',') + 1));
    EXPECT_GT(stamp, last);
    last = stamp;
    if (row.find(",source_lost,") != std::string::npos) {
      ++losses;
    } else {
      ++(losses == 0 ? before : after);
    }
  }
  EXPECT_EQ(losses, 2);
  EXPECT_GE(before, 10);
  EXPECT_GE(after, 10);
#endif
}

}  // namespace
}  // namespace plumbline
