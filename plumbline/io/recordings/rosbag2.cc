// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/input_file.h"
#include "plumbline/io/recordings/compression.h"
#include "plumbline/io/recordings/recording_formats.h"
#include "plumbline/io/recordings/temporary_folder.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

bool IsMcap(const fs::path& file, const fs::path& name) {
  if (FileBeginsWith(file, kMcapMagic)) return true;
  return name.string().find(".mcap") != std::string::npos && !FileBeginsWith(file, kSqliteMagic);
}

// Reads one file; a packed one is unpacked first.
std::unique_ptr<Recording> ReadPart(const fs::path& file, const MessageSink& sink) {
  CheckIsFile(file);
  std::optional<TemporaryFolder> folder;
  std::optional<std::string> fault;
  fs::path opened = file;
  if (file.extension() == ".zstd") {
    folder.emplace();
    opened = folder->path() / "bag";
    fault = UnpackZstdFile(file, opened);
  }
  // The unpacked file goes with its folder here and is open until its messages have been read.
  std::unique_ptr<Recording> part;
  try {
    part =
        IsMcap(opened, file) ? ReadMcapPart(opened, sink, file) : ReadSqliteBag(opened, sink, file);
  } catch (const InputError&) {
    if (fault) throw InputError(file.string() + ": " + *fault);
    throw;
  }
  if (fault) part->AddNote(file.string() + ": " + *fault + "; what comes before is read");
  return part;
}

// The files of a recording as one.
class JoinedRecording : public Recording {
 public:
  using Recording::Recording;

  // Reads the next file.
  void Append(const fs::path& file, const MessageSink& sink) {
    std::vector<std::optional<std::uint32_t>> channel_of;
    const auto index = static_cast<std::uint32_t>(parts_.size());
    const MessageSink joined =
        [&](const Channel& channel, StoredMessage place, std::span<const std::uint8_t> bytes) {
          if (place.channel >= channel_of.size()) channel_of.resize(place.channel + 1);
          std::optional<std::uint32_t>& known = channel_of[place.channel];
          if (!known) known = ChannelLike(channel);
          place.channel = *known;
          place.file = index;
          sink(channels()[*known], place, bytes);
        };
    parts_.push_back(ReadPart(file, joined));
    for (const Channel& channel : parts_.back()->channels()) ChannelLike(channel);
    for (const std::string& note : parts_.back()->notes()) AddNote(note);
  }

  Expected<std::vector<std::uint8_t>, std::string> StoredBytes(
      const StoredMessage& message) const override {
    return parts_.at(message.file)->StoredBytes(message);
  }

 private:
  std::uint32_t ChannelLike(const Channel& wanted) {
    const auto known = std::find_if(channels().begin(), channels().end(), [&](const Channel& c) {
      return c.topic == wanted.topic && c.type == wanted.type && c.encoding == wanted.encoding;
    });
    if (known == channels().end()) return AddChannel(wanted);
    return static_cast<std::uint32_t>(known - channels().begin());
  }

  std::vector<std::unique_ptr<Recording>> parts_;
};

}  // namespace

std::unique_ptr<Recording> ReadRosbag2(const fs::path& path,
                                       const std::vector<fs::path>& files,
                                       const MessageSink& sink) {
  auto joined = std::make_unique<JoinedRecording>(path);
  std::optional<InputError> first;
  std::size_t read = 0;
  for (const fs::path& file : files) {
    try {
      joined->Append(file, sink);
      ++read;
    } catch (const InputError& error) {
      if (!first) first = error;
      joined->AddNote(std::string(error.what()) + "; the file is left out");
    }
  }
  if (read == 0 && first) throw InputError(*first);
  return joined;
}

}  // namespace plumbline
