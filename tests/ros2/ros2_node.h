// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include "messages.h"
#include "tests/e2e/program.h"
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <sched.h>
#include <sys/prctl.h>

namespace plumbline {

using DdsImage = sensor_msgs_msg_dds__Image_;
using PoseStamped = geometry_msgs_msg_dds__PoseStamped_;

inline constexpr std::int64_t kSecond = 1'000'000'000;

// Of this process alone.
inline unsigned Domain() { return 1 + static_cast<unsigned>(::getpid()) % 200; }

// Resident memory of a process, in MB.
inline double MemoryOf(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/statm");
  double all = 0, resident = 0;
  file >> all >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

// What a node finds around it.
struct NodeSurroundings {
  bool loopback = true;                            // ROS_LOCALHOST_ONLY
  std::map<std::string, std::string> environment;  // more of it
  // In a network of its own, with nothing but a loopback that is down; it waits for SIGCONT.
  bool own_network = false;
};

// Arguments of a node for the stereo pair of EuRoC, in lockstep; `more` are added.
inline std::vector<std::string> PairArguments(const std::vector<std::string>& more = {}) {
  std::vector<std::string> all = {"--ros-args",
                                  "-r",
                                  "left/image:=/cam0/image_raw",
                                  "-r",
                                  "right/image:=/cam1/image_raw",
                                  "-p",
                                  "sensor:=stereo",
                                  "-p",
                                  "camera:=euroc",
                                  "-p",
                                  "base_frame:=cam0",
                                  "-p",
                                  "reliability:=reliable",
                                  "-p",
                                  "options.slam.mode:=lockstep"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

// plumbline-ros2 while it runs, with its lines on standard error.
class Ros2Node {
 public:
  explicit Ros2Node(std::vector<std::string> arguments, const NodeSurroundings& surroundings = {}) {
    arguments.insert(arguments.begin(), PLUMBLINE_ROS2_BINARY);
    std::vector<char*> argv;
    for (std::string& word : arguments) argv.push_back(word.data());
    argv.push_back(nullptr);
    const std::string domain = std::to_string(Domain());
    child_ = ::fork();
    if (child_ != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that fails leaves nothing running
    ::setenv("ROS_DOMAIN_ID", domain.c_str(), 1);
    ::setenv("ROS_LOCALHOST_ONLY", surroundings.loopback ? "1" : "0", 1);
    for (const auto& [name, value] : surroundings.environment) {
      ::setenv(name.c_str(), value.c_str(), 1);
    }
    const int file = ::open((folder_ / "stderr").c_str(), O_WRONLY | O_CREAT, 0600);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    if (surroundings.own_network) {
      if (::unshare(CLONE_NEWNET) != 0) ::_exit(126);
      ::raise(SIGSTOP);
    }
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  ~Ros2Node() { Stop(); }
  Ros2Node(const Ros2Node&) = delete;
  Ros2Node& operator=(const Ros2Node&) = delete;

  pid_t pid() const { return child_; }
  std::string Said() const { return Contents(folder_ / "stderr"); }
  // Ends it as Ctrl-C does; returns its exit code, -1 if it crashed.
  int Stop() {
    if (child_ <= 0) return code_;
    ::kill(child_, SIGINT);
    return Wait();
  }
  // As a crash does; returns -1.
  int Kill() {
    ::kill(child_, SIGKILL);
    return Wait();
  }
  // Waits for a signal that stops it without ending it, and returns it; -1 if it ended.
  int WaitUntilStopped() const {
    int status = 0;
    ::waitpid(child_, &status, WUNTRACED);
    return WIFSTOPPED(status) ? WSTOPSIG(status) : -1;
  }
  int Wait() {
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = 0;
    code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return code_;
  }

 private:
  ScratchFolder folder_;
  pid_t child_ = 0;
  int code_ = 0;
};

// The message of an image; the pixels are the caller's.
inline DdsImage DdsImageOf(const GrayImage& image,
                           std::int64_t stamp_ns,
                           std::vector<std::uint8_t>& pixels) {
  static std::string frame = "cam0", encoding = "mono8";
  pixels.clear();
  for (int y = 0; y < image.height(); ++y) {
    pixels.insert(pixels.end(), image.row(y), image.row(y) + image.width());
  }
  DdsImage message{};
  message.header.stamp.sec = static_cast<std::int32_t>(stamp_ns / kSecond);
  message.header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % kSecond);
  message.header.frame_id = frame.data();
  message.encoding = encoding.data();
  message.width = message.step = static_cast<std::uint32_t>(image.width());
  message.height = static_cast<std::uint32_t>(image.height());
  message.data._length = message.data._maximum = static_cast<std::uint32_t>(pixels.size());
  message.data._buffer = pixels.data();
  return message;
}

inline std::int64_t StampOf(const std_msgs_msg_dds__Header_& header) {
  return header.stamp.sec * kSecond + header.stamp.nanosec;
}

}  // namespace plumbline
