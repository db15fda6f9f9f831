// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/text_rows.h"

#include "tests/e2e/program.h"
#include "tests/support/data_folder.h"
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace stereo_pair_test {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kStereo = "euroc/MH_01_easy_first250";
constexpr std::size_t kFrames = 20;

// Which image of the recording is given as that of a camera: the camera and the number of the frame
// that it comes from.
struct Source {
  int camera;
  std::size_t frame;
};
using Choose = std::function<Source(int camera, std::size_t frame)>;

// A EuRoC folder of some frames from `first` on, whose images are links.
fs::path Folder(const ScratchFolder& scratch,
                const fs::path& recording,
                std::size_t first,
                const Choose& choose) {
  const auto folder_of = [](const fs::path& root, int camera) {
    return root / "mav0" / fmt::format("cam{}", camera);
  };
  std::vector<std::vector<TextRow>> rows;
  for (const int camera : {0, 1}) {
    rows.push_back(ReadRows(folder_of(recording, camera) / "data.csv", ','));
  }
  const fs::path root = scratch / "pair";
  fs::remove_all(root);
  for (const int camera : {0, 1}) {
    const fs::path folder = folder_of(root, camera);
    fs::create_directories(folder / "data");
    fs::create_symlink(folder_of(recording, camera) / "sensor.yaml", folder / "sensor.yaml");
    std::ofstream csv(folder / "data.csv");
    csv << "#timestamp [ns],filename\n";
    for (std::size_t i = first; i < first + kFrames; ++i) {
      const Source source = choose(camera, i);
      const std::string image(
          rows[static_cast<std::size_t>(source.camera)].at(source.frame).fields[1]);
      const std::string name = fmt::format("{}{}", i, fs::path(image).extension().string());
      fs::create_symlink(folder_of(recording, source.camera) / "data" / image,
                         folder / "data" / name);
      csv << rows[0].at(i).fields[0] << ',' << name << '\n';
    }
  }
  return root;
}

struct Told {
  Outcome run;
  Outcome info;
  std::vector<std::string> notes;  // of summary.json
  std::string report;
};

Told Tell(const ScratchFolder& scratch, const fs::path& data, const std::string& options = "") {
  Told told;
  fs::remove_all(scratch / "out");
  told.info = RunProgram(scratch, "info " + Quoted(data));
  told.run = RunProgram(scratch,
                        "run " + Quoted(data) + " --set features.lines=false --out " +
                            Quoted(scratch / "out") + options);
  const auto summary = nlohmann::json::parse(Contents(scratch / "out/summary.json"));
  told.notes = summary.at("notes").get<std::vector<std::string>>();
  told.report = Contents(scratch / "out/report.html");
  return told;
}

void ExpectNote(const Told& told, const std::string& note) {
  EXPECT_LE(told.run.code, 1) << told.run.err;  // 1: no frame of a wrong pair had a pose
  EXPECT_THAT(told.run.err, HasSubstr("plumbline: " + note + "\n"));
  EXPECT_THAT(told.notes, testing::Contains(note));
  EXPECT_THAT(told.report, HasSubstr(note));
  EXPECT_THAT(told.info.out, HasSubstr("note          " + note + "\n"));
}

const Choose kAsRecorded = [](int camera, std::size_t frame) { return Source{camera, frame}; };

TEST(StereoPair, ThatIsWrongIsTold) {
  const auto data = FindData(kStereo);
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const ScratchFolder scratch;
  for (const std::size_t first : {20U, 160U}) {
    ExpectNote(Tell(scratch,
                    Folder(scratch,
                           *data,
                           first,
                           [](int, std::size_t frame) {
                             return Source{0, frame};
                           })),
               "the right images are the left ones: is the left side given twice?");
    ExpectNote(Tell(scratch,
                    Folder(scratch,
                           *data,
                           first,
                           [](int camera, std::size_t frame) {
                             return Source{1 - camera, frame};
                           })),
               "the right images fit as left ones: are the sides swapped?");
    ExpectNote(Tell(scratch,
                    Folder(scratch,
                           *data,
                           first,
                           [](int camera, std::size_t frame) {
                             return Source{camera, camera == 1 ? frame - 1 : frame};
                           })),
               "the right images fit the left ones of the frame before: are the two sides paired "
               "wrongly?");
  }
}

TEST(StereoPair, ThatIsRightIsNot) {
  const auto data = FindData(kStereo);
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const ScratchFolder scratch;
  for (const std::size_t first : {0U, 70U, 150U, 230U}) {
    const Told told = Tell(scratch, Folder(scratch, *data, first, kAsRecorded));
    EXPECT_EQ(told.run.code, 0) << told.run.err;
    for (const std::string& note : told.notes) EXPECT_THAT(note, Not(HasSubstr("right images")));
    EXPECT_THAT(told.run.err, Not(HasSubstr("?\n")));
    EXPECT_THAT(told.info.out, Not(HasSubstr("?\n")));
  }
}

}  // namespace stereo_pair_test
}  // namespace plumbline
