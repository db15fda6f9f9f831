// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/recordings/recording.h"

#include "tests/io/scratch_folder.h"
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {

using RecordingReader =
    std::function<std::unique_ptr<Recording>(const std::filesystem::path&, const MessageSink&)>;

// Messages as they come out of a file.
struct ReadMessages {
  std::vector<std::string> topics, texts;
  std::vector<StoredMessage> places;
  std::unique_ptr<Recording> file;
};

inline ReadMessages ReadAll(const RecordingReader& read, const std::filesystem::path& path) {
  ReadMessages all;
  all.file = read(
      path,
      [&](const Channel& channel, const StoredMessage& place, std::span<const std::uint8_t> bytes) {
        all.topics.push_back(channel.topic);
        all.texts.emplace_back(bytes.begin(), bytes.end());
        all.places.push_back(place);
      });
  return all;
}

// Cuts a file anywhere: each is refused in one line.
inline void ExpectEveryCutToShow(const RecordingReader& read,
                                 const ScratchFolder& folder,
                                 const std::string& name,
                                 const std::string& bytes,
                                 std::size_t step) {
  for (std::size_t size = 0; size < bytes.size(); size += size < 200 ? 1 : step) {
    const auto path = folder.Write(name, bytes.substr(0, size));
    const std::string message = MessageOf([&] { ReadAll(read, path); });
    EXPECT_NE(message, "no error") << size;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_EQ(message.find(path.string()), 0U) << message;
  }
}

// Changes every `step`-th byte: what comes is an InputError of one line or the messages, some of
// them changed. Returns how many changes showed.
inline int ChangeBytes(const RecordingReader& read,
                       const ScratchFolder& folder,
                       const std::string& name,
                       const std::string& bytes,
                       std::size_t step) {
  int shown = 0;
  for (std::size_t i = 0; i < bytes.size(); i += step) {
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ 0x81);
    const auto path = folder.Write(name, changed);
    const std::string message = MessageOf([&] { ReadAll(read, path); });
    shown += message != "no error" ? 1 : 0;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  return shown;
}

}  // namespace plumbline
