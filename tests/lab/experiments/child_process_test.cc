// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/child_process.h"

#include "tests/io/scratch_folder.h"
#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

ChildProcess::End WaitFor(ChildProcess& process) {
  for (int i = 0; i < 10000; ++i) {
    if (const auto end = process.Poll()) return *end;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ADD_FAILURE() << "the process does not end";
  return {};
}

TEST(ChildProcess, GivesCodeAndOutput) {
  const ScratchFolder folder;
  ChildProcess process({"/bin/sh", "-c", "echo out; echo err >&2; exit 3"}, folder / "log");
  const ChildProcess::End end = WaitFor(process);
  EXPECT_EQ(end.code, 3);
  EXPECT_FALSE(end.signal.has_value());
  EXPECT_EQ(Contents(folder / "log"), "out\nerr\n");
}

TEST(ChildProcess, TellsOfASignal) {
  const ScratchFolder folder;
  ChildProcess process({"/bin/sh", "-c", "kill -SEGV $$"}, folder / "log");
  EXPECT_EQ(WaitFor(process).signal, SIGSEGV);
}

TEST(ChildProcess, DiesWithAllItStarted) {
  const ScratchFolder folder;
  const std::string alive = (folder / "alive").string();
  {
    ChildProcess process(
        {"/bin/sh", "-c", "(sleep 1; touch '" + alive + "') & touch '" + alive + "0'; wait"},
        folder / "log");
    for (int i = 0; i < 5000 && !std::filesystem::exists(alive + "0"); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_FALSE(process.Poll().has_value());
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(1200));
  EXPECT_TRUE(std::filesystem::exists(alive + "0"));
  EXPECT_FALSE(std::filesystem::exists(alive));
}

TEST(ChildProcess, SaysWhatCannotBeStarted) {
  const ScratchFolder folder;
  ChildProcess process({(folder / "none").string()}, folder / "log");
  EXPECT_EQ(WaitFor(process).code, 127);
  EXPECT_EQ(Contents(folder / "log"), "cannot start the program\n");
  EXPECT_THAT(MessageOf([&] { ChildProcess({"/bin/true"}, folder / "no/folder/log"); }),
              HasSubstr("no/folder/log: No such file or directory"));
}

}  // namespace
}  // namespace plumbline
