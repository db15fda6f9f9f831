// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/checkpoint_io.h"

#include "plumbline/base/byte_stream.h"
#include "plumbline/base/error.h"
#include "plumbline/io/map_io.h"

#include "tests/io/map_fixture.h"
#include "tests/io/scratch_folder.h"
#include <cstdint>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// With more state than one section takes, part of which packs badly.
SavedRun MakeSavedRun() {
  SavedRun run{MakeSavedAtlas(), std::string(3'000'000, 'x'), "--from 3 --blur 5"};
  for (std::size_t i = 0; i < 2000; ++i) run.state[i] = static_cast<char>(i * i * 37 / 11);
  return run;
}

struct SavedFile {
  ScratchFolder folder;
  std::filesystem::path path = folder / "c.plbrun";
  std::string bytes;

  SavedFile() {
    SaveCheckpoint(path, MakeSavedRun());
    bytes = Contents(path);
  }
  void ExpectRefused(const std::string& contents, const std::string& why) const {
    const std::filesystem::path other = folder.Write("other.plbrun", contents);
    try {
      LoadCheckpoint(other);
      FAIL() << why;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), StartsWith(other.string() + ": "));
      EXPECT_THAT(error.what(), HasSubstr(why));
    }
  }
};

TEST(LoadCheckpoint, GivesBackAllThatWasSaved) {
  const SavedFile file;
  const SavedRun saved = MakeSavedRun();
  const SavedRun loaded = LoadCheckpoint(file.path);
  EXPECT_TRUE(loaded.state == saved.state);
  EXPECT_EQ(loaded.input, saved.input);
  EXPECT_EQ(loaded.maps.context.options_yaml, saved.maps.context.options_yaml);
  EXPECT_EQ(loaded.maps.atlas.active_id(), MapId{0});
  SaveAtlas(file.folder / "a.plb", saved.maps.atlas, saved.maps.context);
  SaveAtlas(file.folder / "b.plb", loaded.maps.atlas, loaded.maps.context);
  EXPECT_TRUE(Contents(file.folder / "a.plb") == Contents(file.folder / "b.plb"));
  SaveCheckpoint(file.folder / "again.plbrun", loaded);
  EXPECT_TRUE(Contents(file.folder / "again.plbrun") == file.bytes);
}

TEST(LoadCheckpoint, MayHaveNoMapsAndNoState) {
  const ScratchFolder folder;
  SavedRun run;
  run.maps.context.camera = kMapCamera;
  SaveCheckpoint(folder / "c.plbrun", run);
  const SavedRun loaded = LoadCheckpoint(folder / "c.plbrun");
  EXPECT_TRUE(loaded.maps.atlas.empty());
  EXPECT_EQ(loaded.state, "");
}

TEST(LoadCheckpoint, RefusesAFileCutShortAnywhere) {
  const SavedFile file;
  for (std::size_t size = 0; size < file.bytes.size();
       size += size < 40 ? 1 : file.bytes.size() / 61) {
    file.ExpectRefused(file.bytes.substr(0, size), "");
  }
  file.ExpectRefused(file.bytes.substr(0, file.bytes.size() - 1), "ends early");
  file.ExpectRefused(file.bytes + '\0', "expected the end, found more bytes");
}

TEST(LoadCheckpoint, RefusesAFileWithAnyByteChanged) {
  const SavedFile file;
  for (std::size_t at = 0; at < file.bytes.size(); at += at < 60 ? 1 : file.bytes.size() / 61) {
    std::string changed = file.bytes;
    changed[at] ^= 4;
    file.ExpectRefused(changed, "");
  }
}

TEST(LoadCheckpoint, SaysWhatIsWrong) {
  const SavedFile file;
  std::string newer = file.bytes;
  newer[8] = 7;
  file.ExpectRefused(newer, "expected a checkpoint of version 6, found version 7");
  SaveAtlas(file.folder / "m.plb", MakeSavedAtlas().atlas, MakeSavedAtlas().context);
  file.ExpectRefused(Contents(file.folder / "m.plb"),
                     "expected a Plumbline checkpoint, found another file");
  EXPECT_THROW(LoadCheckpoint(file.folder / "none.plbrun"), InputError);
}

TEST(SaveCheckpoint, WithoutAFolderSaysSo) {
  const ScratchFolder folder;
  try {
    SaveCheckpoint(folder / "none/c.plbrun", MakeSavedRun());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), StartsWith("cannot write "));
  }
}

}  // namespace
}  // namespace plumbline
