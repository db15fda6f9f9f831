// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"

#include "tests/io/dataset_fixtures.h"
#include "tests/io/scratch_folder.h"
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

// One file of a good data set replaced (or removed, nullopt), and part of the message expected.
struct Fault {
  std::string file;
  std::optional<std::string> content;
  std::string message;
};

void ExpectErrors(void (*write)(const ScratchFolder&),
                  const std::vector<Fault>& faults,
                  const DatasetOptions& options = {}) {
  for (const Fault& fault : faults) {
    const ScratchFolder folder;
    write(folder);
    if (fault.content) {
      folder.Write(fault.file, *fault.content);
    } else {
      std::filesystem::remove_all(folder / fault.file);
    }
    EXPECT_THAT(MessageOf([&] { OpenDataset(folder.path(), options); }), HasSubstr(fault.message))
        << fault.file << ": " << fault.content.value_or("(removed)");
  }
}

std::string SensorOfSize(const std::string& size) {
  std::string yaml = EurocSensorYaml(0.5, 0);
  const std::string good = "[8, 6]";
  return yaml.replace(yaml.find(good), good.size(), size);
}

TEST(OpenDataset, NamesFaultsOfEuroc) {
  const std::string csv = "mav0/cam0/data.csv";
  ExpectErrors(
      WriteEuroc,
      {{csv,
        "#h\n100,1.png\n200\n",
        "cam0/data.csv:3: expected a time stamp and a file name, "
        "found 1 columns"},
       {csv, "100,1.png,x\n", "cam0/data.csv:1: expected a time stamp and a file name"},
       {csv, "100,\n", "cam0/data.csv:1: expected a time stamp and a file name"},
       {csv, "1e2,1.png\n", "data.csv:1: expected a time stamp in whole nanoseconds, found '1e2'"},
       {csv, "#timestamp [ns],filename\n", "cam0/data.csv: expected images, found no rows"},
       {csv, "", "cam0/data.csv: expected images, found no rows"},
       {csv, std::nullopt, "cam0/data.csv: no such file"},
       {csv, "105,1.png\n", "expected equal time stamps in cam0/data.csv and cam1/data.csv"},
       {"mav0/cam1/data.csv", "x,1.png\n", "cam1/data.csv:1: expected a time stamp"},
       {"mav0/cam1/data.csv",
        std::nullopt,
        "cam1/data.csv: expected a list of the right images, found none; with the sensor mono it "
        "is not needed"},
       {"mav0/cam1/sensor.yaml",
        EurocSensorYaml(0.5, 0),
        "cam1/sensor.yaml:2: T_BS: expected the right camera to the right (+x) of the left one, "
        "found it at (0, 0, 0) m"},
       {"mav0/cam1/sensor.yaml", EurocSensorYaml(0.5, 0.1), "found it at (0, 0.1, 0) m"},
       {"mav0/cam1/sensor.yaml", EurocSensorYaml(0.4, 0), "found it at (-0.1, 0, 0) m"},
       // Where the cameras have different sizes, the images tell which camera's size is wrong.
       {"mav0/cam0/sensor.yaml",
        SensorOfSize("[9, 6]"),
        "cam0/sensor.yaml:6: resolution: expected 8x6 pixels as the images have, found 9x6"},
       {"mav0/cam1/sensor.yaml",
        SensorOfSize("[9, 6]"),
        "cam1/sensor.yaml:6: resolution: expected a right camera of 8x6 pixels like the left one, "
        "found 9x6"},
       {"mav0/cam0", std::nullopt, "expected a EuRoC folder, found no mav0/cam0"},
       {"mav0/cam0/data", std::nullopt, "expected images, found none of the 3 listed"},
       {"mav0/cam0/sensor.yaml", std::nullopt, "cam0/sensor.yaml: no such file"},
       {"mav0/cam1/sensor.yaml", "a: 1\n", "cam1/sensor.yaml:1: camera_model: expected a value"}});
}

TEST(OpenDataset, NamesFaultsOfKitti) {
  ExpectErrors(
      WriteKitti,
      {{"calib.txt", std::nullopt, "calib.txt: no such file"},
       {"calib.txt", "P0: 1 2 3\n", "calib.txt:1: expected 12 numbers after P0:, found 3"},
       {"calib.txt",
        "P0: 700 0 4 0 0 x 3 0 0 0 1 0\n",
        "calib.txt:1: expected a number in column 7"},
       {"calib.txt", "P0: 700 0 4 0 0 710 3 0 0 0 1 0\n", "calib.txt: expected a row 'P1:'"},
       {"calib.txt", "P0: 700 9 4 0 0 710 3 0 0 0 1 0\n", "the projection of a rectified camera"},
       {"calib.txt",
        "P0: 700 0 4 0 0 710 3 0 0 0 1 0\nP1: 700 0 4 380 0 710 3 0 0 0 1 0\n",
        "calib.txt:2: expected P1 to be P0 with a baseline above 0, found a baseline of -0.542857 "
        "m"},
       {"calib.txt",
        "P0: 700 0 4 0 0 710 3 0 0 0 1 0\nP1: 700 0 5 -380 0 710 3 0 0 0 1 0\n",
        "found fx 700 fy 710 cx 5 cy 3 beside fx 700 fy 710 cx 4 cy 3"},
       {"calib.txt",
        "P0: 700 0 4 0 0 710 3 0 0 0 1 0\nP0: 700 0 5 0 0 710 3 0 0 0 1 0\n",
        "calib.txt:2: expected one row 'P0:', found another one after that of line 1"},
       {"calib.txt",
        "P0: 700 0 4 0 0 710 3 0 0 0 1 0\nP1: 700 0 4 -1e-9 0 710 3 0 0 0 1 0\n",
        "calib.txt:2: expected a baseline from 0.0001 to 1000 m, found 1.42857e-12"},
       {"calib.txt",
        "P0: 1e300 0 4 0 0 710 3 0 0 0 1 0\n",
        "calib.txt:1: expected fx from 0.08 to 8000 px, found 1e+300"},
       {"times.txt", std::nullopt, "times.txt: no such file"},
       {"times.txt", "0\n1 2\n", "times.txt:2: expected one time, found 2 columns"},
       {"times.txt", "0\nx\n", "times.txt:2: expected a time stamp in seconds, found 'x'"},
       {"times.txt",
        "0\n1\n",
        "times.txt: expected a time for each image up to 000002.png, found 2"},
       {"image_0", std::nullopt, "image_0: no such folder"},
       {"image_0/left.png", "x", "left.png: expected a number as file name"},
       {"image_0/2.png",
        Png(8, 6, 1),
        "image_0: expected one image of each number, found 000002.png and 2.png"},
       // The other images say which size is right, also where it is the first one that is wrong.
       {"image_0/000000.png", Png(4, 3, 1), "no error"}});
}

TEST(OpenDataset, NamesTheListThatAnotherFolderHasNot) {
  const ScratchFolder folder;
  WriteEuroc(folder);
  DatasetOptions options;
  options.format = DatasetFormat::kTum;
  EXPECT_EQ(MessageOf([&] { OpenDataset(folder.path(), options); }),
            folder.path().string() + ": expected a TUM or ICL folder, found no rgb.txt in it");
}

TEST(OpenDataset, NamesFaultsOfTum) {
  ExpectErrors(
      WriteTumFolder,
      {{"rgb.txt", "# nothing\n", "rgb.txt: expected images, found no rows"},
       {"rgb.txt", "1.0\n", "rgb.txt:1: expected a time stamp and a file name, found 1 columns"},
       {"rgb.txt", "one a.png\n", "rgb.txt:1: expected a time stamp in seconds, found 'one'"},
       {"rgb", std::nullopt, "expected images, found none of the 2 listed"},
       {"depth.txt", "9.0 a.png\n", "expected depth images within 20 ms of colour images"},
       {"depth.txt", "9.0 a b c\n", "depth.txt:1: expected a time stamp and a file name"},
       {"depth.txt", std::nullopt, "depth.txt: expected a list of the depth images, found none"},
       {"camera.yaml", std::nullopt, "expected a calibration, found none: give --camera FILE"},
       {"camera.yaml", "size: 5\n", "camera.yaml:1: size: expected 2 numbers"}});
}

TEST(OpenDataset, NamesFaultsOfImageFolders) {
  ExpectErrors([](const ScratchFolder& folder) { folder.Write("1.png", Png(8, 6, 1)); },
               {{"camera.yaml", std::nullopt, "expected a calibration, found none"},
                {"camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\n", "expected rate_hz"},
                {"1.png",
                 std::nullopt,
                 "expected a EuRoC folder (mav0/), a TUM or ICL folder (rgb.txt), a KITTI sequence "
                 "(image_0/, calib.txt) or a drive of KITTI raw (image_00/timestamps.txt), a "
                 "folder of ros2 bag (.db3, .mcap) or a folder of images, found none of them"}});
}

TEST(OpenDataset, ANumberComesOnceInAFolderOfImages) {
  const auto write = [](const ScratchFolder& folder) {
    folder.Write("camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrate_hz: 3\n");
    for (const char* name : {"a_09.png", "a_10.png", "b.png"}) folder.Write(name, Png(8, 6, 1));
  };
  ExpectErrors(write,
               {{"none", "", "no error"},
                {"a_9.png",
                 Png(8, 6, 1),
                 ": expected one image of each number, found a_09.png and "
                 "a_9.png"},
                {"a_010.png", Png(8, 6, 1), "found a_010.png and a_10.png"},
                {"b.jpg", Png(8, 6, 1), "found b.jpg and b.png"}});
}

// 30000x30000 pixels take 1.8 GB as 16 bits; the file has a few bytes.
TEST(OpenDataset, AnImageIsNotDecodedBeforeItsSizeIsRight) {
  const std::string bomb = "P5\n30000 30000\n255\n";
  ExpectErrors(
      [](const ScratchFolder& folder) { folder.Write("1.png", Png(8, 6, 1)); },
      {{"camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrate_hz: 3\n", "no error"}});
  ExpectErrors(
      [](const ScratchFolder& folder) {
        folder.Write("camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrate_hz: 3\n");
      },
      {{"1.pgm", bomb, "1.pgm: an image of 30000x30000 pixels, expected at most 100 million"},
       {"1.pgm",
        "P5\n9000 9000\n255\n",
        "1.pgm: expected an image of 8x6 pixels as in the calibration, found 9000x9000"}});
}

TEST(OpenDataset, APipeIsNotWaitedFor) {
  const ScratchFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(MessageOf([&] { OpenDataset(folder / "pipe"); }),
              HasSubstr("pipe: expected a folder or a file, found a pipe"));
  EXPECT_THAT(MessageOf([] { OpenDataset("/dev/null"); }),
              HasSubstr("/dev/null: expected a folder or a file, found a device"));
  ExpectErrors(WriteEuroc, {{"none", "", "no error"}});
  WriteEuroc(folder);
  for (const char* name : {"mav0/cam0/data.csv", "mav0/cam0/sensor.yaml"}) {
    std::filesystem::rename(folder / name, folder / "kept");
    ASSERT_EQ(::mkfifo((folder / name).c_str(), 0600), 0);
    EXPECT_THAT(MessageOf([&] { OpenDataset(folder.path()); }),
                HasSubstr(std::string(name) + ": expected a file, found a pipe"));
    std::filesystem::rename(folder / "kept", folder / name);
  }
}

TEST(OpenDataset, NamesWrongPathsAndWishes) {
  const ScratchFolder folder;
  WriteEuroc(folder);
  const auto message = [&](const std::string& path, const DatasetOptions& options) {
    return MessageOf([&] { OpenDataset(folder / path, options); });
  };
  EXPECT_THAT(message("none", {}), HasSubstr("none: no such file or folder"));
  EXPECT_THAT(message("mav0/cam0/data.csv", {}),
              HasSubstr("expected a folder or a video, found a file"));
  EXPECT_THAT(message("", {.sensor = SensorKind::kRgbd}),
              HasSubstr("expected data for rgbd, found data for stereo, mono only"));
  EXPECT_THAT(message("", {.format = DatasetFormat::kKitti}), HasSubstr("no such file"));
  EXPECT_THAT(message("", {.camera = "tum_fr1"}), HasSubstr("expected a stereo camera"));
  EXPECT_THAT(message("", {.camera = "none.yaml"}), HasSubstr("none.yaml: no such camera file"));
}

}  // namespace
}  // namespace plumbline
