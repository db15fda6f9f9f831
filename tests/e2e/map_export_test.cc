// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/image_file.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/io/trajectory_io.h"

#include "tests/e2e/poster_run.h"
#include "tests/support/data_folder.h"
#include "tests/support/read_colmap.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

Outcome Export(const ScratchFolder& folder, const std::string& form, const std::string& name) {
  return RunProgram(
      folder,
      "map export " + Quoted(Posters().map) + " --to " + form + " --out " + Quoted(folder / name));
}

// What a run writes itself comes out again, in the same bytes.
void ExpectFilesOfTheRun(const ScratchFolder& folder, const fs::path& run) {
  const std::pair<const char*, const char*> files[] = {
      {"ply", "map.ply"}, {"obj", "lines.obj"}, {"dxf", "lines.dxf"}, {"tum", "keyframes.txt"}};
  for (const auto& [form, name] : files) {
    const Outcome outcome = RunProgram(folder,
                                       "map export " + Quoted(run / "map.plb") + " --to " + form +
                                           " --out " + Quoted(folder / name));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, StartsWith((folder / name).string() + ": "));
    EXPECT_TRUE(Contents(folder / name) == Contents(run / name)) << name;
  }
}

TEST(MapExport, GivesTheFilesOfTheRunAgain) {
  const ScratchFolder folder;
  ExpectFilesOfTheRun(folder, Posters().out);
  EXPECT_GT(Contents(folder / "map.ply").size(), 2000U);
}

TEST(MapExport, ReplacesNoPointsOfOthers) {
  const ScratchFolder folder;
  const std::string mesh = "ply\nformat ascii 1.0\ncomment VCGLIB generated\nend_header\n";
  const fs::path file = folder.Write("mesh.ply", mesh);
  const Outcome outcome =
      RunProgram(folder, "map export " + Quoted(Posters().map) + " --to ply --out " + Quoted(file));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(Contents(file), mesh);
}

// Real lines, and the sensors whose images are rectified in other ways.
// The options that the run had decide about the lines of its map.
TEST(MapExport, KnowsTheOptionsOfTheRun) {
  const ScratchFolder folder;
  const Outcome run =
      RunProgram(folder,
                 "run " + Quoted(Posters().sequence) +
                     " --set mapping.line_map.min_keyframes=2 --out " + Quoted(folder / "run"));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(Contents(folder / "run/lines.obj"), Contents(Posters().out / "lines.obj"));
  ExpectFilesOfTheRun(folder, folder / "run");
}

// The COLMAP model of a run, with images in `model` followed by the arguments.
ColmapModel ExportedModel(const ScratchFolder& folder,
                          const fs::path& data,
                          const std::string& arguments) {
  const fs::path out = folder / ("model" + arguments);
  const Outcome outcome =
      RunProgram(folder,
                 "map export " + Quoted(folder / "run/map.plb") + " --to colmap --images " +
                     Quoted(data) + arguments + " --out " + Quoted(out));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(arguments.empty() ? " as delivered (" : " without distort"));
  ColmapModel model = ReadColmapBinary(out / "sparse/0");
  EXPECT_GT(model.points.size(), 100U);
  EXPECT_EQ(FilesOf(out / "images").size(), model.images.size());
  for (const ColmapModel::Point& point : model.points) {
    EXPECT_NEAR(ReprojectionErrorOf(model, point), point.error, 1e-6);
  }
  return model;
}

double MeanError(const ColmapModel& model) {
  double sum = 0;
  for (const ColmapModel::Point& point : model.points) sum += point.error;
  return sum / static_cast<double>(model.points.size());
}

// The features of both exports of a run show the same, and the points are as near to them.
void ExpectSamePatches(const ScratchFolder& folder,
                       const ColmapModel& delivered,
                       const ColmapModel& pinhole) {
  ASSERT_EQ(delivered.points.size(), pinhole.points.size());
  const double scale = pinhole.camera.parameters[0] / delivered.camera.parameters[0];
  EXPECT_NEAR(scale * MeanError(delivered), MeanError(pinhole), 0.15 * MeanError(pinhole));
  const auto image_of = [&](const char* out, const std::string& name) {
    return ToGray(*ReadColorImage(folder / out / "images" / name));
  };
  std::vector<int> differences;
  for (std::size_t i = 0; i < delivered.images.size(); ++i) {
    const std::string& name = delivered.images[i].name;
    const GrayImage a = image_of("model", name), b = image_of("model --undistort", name);
    for (std::size_t k = 0; k < delivered.images[i].keypoints.size(); ++k) {
      const Eigen::Vector2i p = delivered.images[i].keypoints[k].px.cast<int>();
      const Eigen::Vector2i q = pinhole.images[i].keypoints[k].px.cast<int>();
      ASSERT_TRUE(p.minCoeff() >= 0 && p.x() < a.width() && p.y() < a.height());
      differences.push_back(std::abs(a.at(p.x(), p.y()) - b.at(q.x(), q.y())));
    }
  }
  ASSERT_GT(differences.size(), 1000U);
  std::nth_element(
      differences.begin(), differences.begin() + std::ssize(differences) / 2, differences.end());
  EXPECT_LT(differences[differences.size() / 2], 12);  // corners: a pixel beside differs by more
}

TEST(MapExport, OfRealSequences) {
  const std::tuple<const char*, const char*, bool, const char*> runs[] = {
      {"euroc/MH_01_easy_first250", "--to 30", true, "OPENCV"},
      {"euroc/MH_01_easy_first250", "--sensor mono --from 60 --to 110", false, "OPENCV"},
      {"tum/rgbd_dataset_freiburg1_floor_first90", "--to 30", false, "FULL_OPENCV"}};
  for (const auto& [sequence, frames, has_lines, lens] : runs) {
    const auto data = FindData(sequence);
    if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
    const ScratchFolder folder;
    const Outcome run = RunProgram(
        folder, "run " + Quoted(*data) + " " + frames + " --quiet --out " + Quoted(folder / "run"));
    ASSERT_EQ(run.code, 0) << run.err;
    ExpectFilesOfTheRun(folder, folder / "run");
    if (has_lines) {
      EXPECT_GT(Contents(folder / "lines.obj").size(), 1000U);
    }
    const ColmapModel delivered = ExportedModel(folder, *data, "");
    const ColmapModel pinhole = ExportedModel(folder, *data, " --undistort");
    EXPECT_EQ(delivered.camera.model, lens);
    EXPECT_EQ(pinhole.camera.model, "PINHOLE");
    ExpectSamePatches(folder, delivered, pinhole);
  }
}

TEST(MapExport, ColmapModelsHaveTheErrorsOfTheMap) {
  const ScratchFolder folder;
  const Outcome outcome = Export(folder, "colmap", "model");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("--images PATH writes them"));
  EXPECT_EQ(FilesOf(folder / "model"), (std::set<std::string>{"lines", "sparse"}));
  EXPECT_EQ(FilesOf(folder / "model/sparse/0").size(), 6U);
  EXPECT_EQ(FilesOf(folder / "model/lines"),
            (std::set<std::string>{"alltracks.txt", "detections.txt", "image_list.txt"}));
  const ColmapModel text = ReadColmapText(folder / "model/sparse/0");
  const ColmapModel binary = ReadColmapBinary(folder / "model/sparse/0");
  const SavedMap saved = LoadMap(Posters().map);
  EXPECT_EQ(text.images.size(), saved.map.keyframes().size());
  EXPECT_GT(text.points.size(), saved.map.points().size() / 2);
  EXPECT_THAT(
      outcome.out,
      HasSubstr(fmt::format("), {} points ({} of one image or unknown distance left out), {} lines",
                            text.points.size(),
                            saved.map.points().size() - text.points.size(),
                            saved.map.lines().size())));
  ASSERT_EQ(binary.points.size(), text.points.size());
  for (std::size_t i = 0; i < text.points.size(); ++i) {
    EXPECT_EQ(text.points[i].error, binary.points[i].error);
    EXPECT_EQ(text.points[i].track, binary.points[i].track);
    EXPECT_NEAR(ReprojectionErrorOf(text, text.points[i]), text.points[i].error, 1e-6);
  }
  for (const auto& [model, files] : {std::pair{"text", 3U}, std::pair{"binary", 3U}}) {
    EXPECT_EQ(Export(folder, std::string("colmap --model ") + model, model).code, 0);
    EXPECT_EQ(FilesOf(folder / model / "sparse/0").size(), files);
  }
  EXPECT_TRUE(fs::exists(folder / "text/sparse/0/images.txt"));
  EXPECT_TRUE(fs::exists(folder / "binary/sparse/0/images.bin"));
}

TEST(MapExport, ImagesComeWithTheModel) {
  const ScratchFolder folder;
  const std::string images = " --images " + Quoted(Posters().sequence);
  for (const char* form : {"colmap", "nerfstudio"}) {
    const Outcome outcome = Export(folder, form + images, form);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out.find("--images"), std::string::npos);
  }
  EXPECT_EQ(FilesOf(folder / "nerfstudio"),
            (std::set<std::string>{"images", "points.ply", "transforms.json"}));
  const ColmapModel model = ReadColmapText(folder / "colmap/sparse/0");
  const auto json = nlohmann::json::parse(Contents(folder / "nerfstudio/transforms.json"));
  ASSERT_EQ(json["frames"].size(), model.images.size());
  std::set<int> greys;
  for (const ColmapModel::Point& point : model.points) greys.insert(point.color.r);
  EXPECT_GT(greys.size(), 20U);
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    const std::string name = "images/" + model.images[i].name;
    EXPECT_EQ(json["frames"][i]["file_path"], name);
    EXPECT_GT(fs::file_size(folder / "colmap" / name), 1000U);
    EXPECT_EQ(Contents(folder / "colmap" / name), Contents(folder / "nerfstudio" / name));
  }
  EXPECT_EQ(FilesOf(folder / "colmap/images").size(), model.images.size());
}

// Gives a poster sequence left images in colour.
void PaintLeftImages(const fs::path& sequence) {
  for (int i = 0; i < 12; ++i) {
    const fs::path file = sequence / fmt::format("mav0/cam0/data/{}.png", i);
    ColorImage image = ToColor(MovingPoster().Frame(i).left);
    for (int y = 0; y < image.height(); ++y) {
      std::fill(image.blue.row(y), image.blue.row(y) + image.width(), std::uint8_t{40});
    }
    WriteColorPng(file, image);
  }
}

// Where a point of a model lies in an image.
Eigen::Vector2d PlaceIn(const ColmapModel& model,
                        const ColmapModel::Image& image,
                        const Eigen::Vector3d& position) {
  return read_colmap_detail::Project(model.camera, image.cam_from_world * position);
}

// All frames of a run, in the colours of the data: what a point looks like where it is projected
// into the images between keyframes is what the model says of it.
TEST(MapExport, HasAllFramesInColour) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 24);
  PaintLeftImages(sequence);
  const fs::path map = folder / "out/map.plb";
  const std::string images = " --images " + Quoted(sequence);
  const auto export_to = [&](const std::string& form, const std::string& name) {
    const Outcome outcome = RunProgram(
        folder,
        "map export " + Quoted(map) + images + " --to " + form + " --out " + Quoted(folder / name));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.out;
  };
  const Outcome run =
      RunProgram(folder, "run " + Quoted(sequence) + " --quiet --out " + Quoted(folder / "out"));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(export_to("colmap --frames all", "colmap"), HasSubstr(": 24 images, "));
  export_to("nerfstudio --frames all", "nerfstudio");
  export_to("nerfstudio --frames every:5", "every");
  export_to("ply", "map.ply");
  const std::size_t keyframes = LoadMap(map).map.keyframes().size();
  ASSERT_LT(keyframes, 20U);
  const ColmapModel model = ReadColmapBinary(folder / "colmap/sparse/0");
  ASSERT_EQ(model.images.size(), 24U);
  EXPECT_EQ(FilesOf(folder / "colmap/images").size(), 24U);
  const auto json = nlohmann::json::parse(Contents(folder / "nerfstudio/transforms.json"));
  EXPECT_EQ(json["frames"].size(), 24U);
  EXPECT_EQ(FilesOf(folder / "nerfstudio/images").size(), 24U);
  const auto every = nlohmann::json::parse(Contents(folder / "every/transforms.json"));
  EXPECT_GE(every["frames"].size(), keyframes);
  EXPECT_LE(every["frames"].size(), keyframes + 5);
  std::size_t inside = 0, alike = 0;
  for (std::size_t i = keyframes; i < model.images.size(); ++i) {
    EXPECT_TRUE(model.images[i].keypoints.empty());
    const auto image = ReadColorImage(folder / "colmap/images" / model.images[i].name);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->at(7, 9).b, 40);
    for (const ColmapModel::Point& point : model.points) {
      EXPECT_EQ(point.color.b, 40);
      EXPECT_EQ(point.color.r, point.color.g);
      const Eigen::Vector2d px = PlaceIn(model, model.images[i], point.position);
      if (px.minCoeff() < 0 || px.x() >= image->width() || px.y() >= image->height()) continue;
      const Color seen = image->at(static_cast<int>(px.x()), static_cast<int>(px.y()));
      ++inside;
      alike += std::abs(int{seen.r} - int{point.color.r}) < 40 ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 1000U);
  // Points are corners: a pixel beside, some have the level of the other side.
  EXPECT_GT(static_cast<double>(alike), 0.6 * static_cast<double>(inside));
  EXPECT_THAT(Contents(folder / "map.ply"), HasSubstr(" 40\n"));
  EXPECT_EQ(Contents(folder / "map.ply").find(" 128 128 128\n"), std::string::npos);
}

// Poses of frames are those of the run that made the map, or there is no export.
TEST(MapExport, NeedsTheTrajectoryOfTheRunForAllFrames) {
  const ScratchFolder folder;
  fs::copy_file(Posters().map, folder / "map.plb");
  const std::string command = "map export " + Quoted(folder / "map.plb") +
                              " --to colmap --images " + Quoted(Posters().sequence) +
                              " --frames all --out " + Quoted(folder / "x");
  ExpectRefusal(
      RunProgram(folder, command),
      "--frames: expected the poses of all frames in " + (folder / "trajectory.txt").string());
  const std::string given = " --trajectory " + Quoted(Posters().out / "trajectory.txt");
  EXPECT_EQ(RunProgram(folder, command + given).code, 0);
  EXPECT_EQ(FilesOf(folder / "x/images").size(), 24U);
  fs::remove_all(folder / "x");
  WriteTum(folder / "trajectory.txt",
           TimeReversed(ReadTrajectory(Posters().out / "trajectory.txt").poses, 3'150'000'000));
  ExpectRefusal(
      RunProgram(folder, command),
      "trajectory.txt: expected the poses of the run that made the map, found another one");
  EXPECT_FALSE(fs::exists(folder / "x"));
}

TEST(MapExport, WritesTheSameBytesAgain) {
  const ScratchFolder folder;
  for (const char* name : {"a", "b"}) EXPECT_EQ(Export(folder, "colmap", name).code, 0);
  for (const auto& entry : fs::recursive_directory_iterator(folder / "a")) {
    if (!entry.is_regular_file()) continue;
    EXPECT_TRUE(Contents(entry.path()) ==
                Contents(folder / "b" / fs::relative(entry.path(), folder / "a").string()))
        << entry.path();
  }
}

// Half the sum of the squared reprojection errors of a model for each of its residuals, and the
// root of it: what COLMAP calls the cost of a bundle adjustment.
double ColmapCost(const ColmapModel& model) {
  double sum = 0;
  std::size_t residuals = 0;
  for (ColmapModel::Point point : model.points) {
    const std::vector<ColmapModel::View> track = point.track;
    for (const ColmapModel::View& view : track) {
      point.track = {view};
      const double error = ReprojectionErrorOf(model, point);
      sum += error * error / 2;
      residuals += 2;
    }
  }
  return std::sqrt(sum / static_cast<double>(residuals));
}

// What the program colmap prints.
std::string Colmap(const ScratchFolder& folder, const std::string& arguments) {
  const std::string command = "colmap " + arguments + " > " + Quoted(folder / "said") + " 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;  // NOLINT(concurrency-mt-unsafe)
  return Contents(folder / "said");
}

// COLMAP itself, where it is installed, counts what is there and projects the points to where the
// map has them.
TEST(MapExport, ColmapReadsTheModel) {
  if (std::system("command -v colmap > /dev/null 2>&1") != 0) {  // NOLINT(concurrency-mt-unsafe)
    GTEST_SKIP() << "the program colmap is not installed";
  }
  const ScratchFolder folder;
  for (const char* files : {"text", "binary"}) {
    ASSERT_EQ(Export(folder, std::string("colmap --model ") + files, files).code, 0);
    const fs::path path = folder / files / "sparse/0";
    const ColmapModel model =
        files == std::string("text") ? ReadColmapText(path) : ReadColmapBinary(path);
    double error = 0;
    for (const ColmapModel::Point& point : model.points) error += point.error;
    error /= static_cast<double>(model.points.size());
    const std::string counts = Colmap(folder, "model_analyzer --path " + Quoted(path));
    EXPECT_THAT(counts, HasSubstr("Cameras: 1\n"));
    EXPECT_THAT(counts, HasSubstr(fmt::format("Images: {}\n", model.images.size())));
    EXPECT_THAT(counts, HasSubstr(fmt::format("Points: {}\n", model.points.size())));
    EXPECT_THAT(counts, HasSubstr(fmt::format("Mean reprojection error: {:.4f}", error)));
    fs::create_directories(folder / "adjusted");
    const std::string adjustment =
        Colmap(folder,
               "bundle_adjuster --input_path " + Quoted(path) + " --output_path " +
                   Quoted(folder / "adjusted") + " --BundleAdjustment.max_num_iterations 1");
    const std::string title = "Initial cost : ";
    ASSERT_THAT(adjustment, HasSubstr(title));
    EXPECT_NEAR(std::stod(adjustment.substr(adjustment.find(title) + title.size())),
                ColmapCost(model),
                1e-5);
  }
}

// Gives a poster sequence of 12 frames its images in reverse, at the same times.
void ShowBackwards(const ScratchFolder& folder) {
  std::string list = "#timestamp [ns],filename\n";
  for (int i = 0; i < 12; ++i) list += fmt::format("{},{}.png\n", MovingPoster::StampNs(i), 11 - i);
  for (const char* camera : {"cam0", "cam1"}) {
    folder.Write(fmt::format("sequence/mav0/{}/data.csv", camera), list);
  }
}

// The times of a keyframe are in the data, but what it saw then is not: the keyframe is
// of another session of the map.
TEST(MapExport, RefusesImagesThatAreNotThoseOfTheKeyframes) {
  const ScratchFolder first, second;
  const std::string a = Quoted(WritePosterSequence(first, 12));
  const std::string b = Quoted(WritePosterSequence(second, 12));
  ShowBackwards(second);
  const auto run = [&](const std::string& arguments, const char* name) {
    const Outcome outcome =
        RunProgram(first, "run " + arguments + " --quiet --out " + Quoted(first / name));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return first / name / "map.plb";
  };
  const auto export_with = [&](const fs::path& map, const std::string& data) {
    return RunProgram(first,
                      "map export " + Quoted(map) + " --to nerfstudio --images " + data +
                          " --out " + Quoted(first / "data"));
  };
  const fs::path forwards = run(a, "forwards");
  const fs::path continued = run(b + " --map " + Quoted(forwards), "continued");
  const std::string message =
      "sequence: expected the images that the map was made of, found another one at 1.000000000 s, "
      "where the map has keyframe 0 (another session?)";
  ExpectRefusal(export_with(continued, b), message);
  EXPECT_FALSE(fs::exists(first / "data"));
  EXPECT_EQ(export_with(forwards, a).code, 0);
}

// The camera of a run on smaller or turned images is that of the images that are exported.
TEST(MapExport, GivesImagesAsTheRunUsedThem) {
  const ScratchFolder folder;
  const std::string sequence = Quoted(WritePosterSequence(folder, 24));
  const auto run = [&](const std::string& arguments) {
    fs::remove_all(folder / "run");
    return RunProgram(folder, "run " + sequence + arguments + " --out " + Quoted(folder / "run"));
  };
  const auto export_with = [&](const std::string& arguments) {
    fs::remove_all(folder / "data");
    return RunProgram(folder,
                      "map export " + Quoted(folder / "run/map.plb") +
                          " --to nerfstudio --images " + sequence + arguments + " --out " +
                          Quoted(folder / "data"));
  };
  const auto expect_size = [&](int width, int height) {
    const auto transforms = nlohmann::json::parse(Contents(folder / "data/transforms.json"));
    EXPECT_EQ(transforms["w"], width);
    EXPECT_EQ(transforms["h"], height);
    const std::string name = transforms["frames"][0]["file_path"];
    const std::string png = Contents(folder / "data" / name);
    EXPECT_EQ(
        SizeInHeader(std::span(reinterpret_cast<const std::uint8_t*>(png.data()), png.size())),
        (ImageSize{width, height}));
  };
  const Outcome smaller = run(" --max-width 200");
  ASSERT_EQ(smaller.code, 0) << smaller.err;
  EXPECT_THAT(smaller.err, HasSubstr("images of 400x300 pixels are reduced to 200x150"));
  ASSERT_EQ(export_with("").code, 0);
  expect_size(200, 150);
  const Outcome turned = run(" --sensor mono --rotate 90");
  ASSERT_EQ(turned.code, 0) << turned.err;
  EXPECT_THAT(turned.err, HasSubstr("images are turned by 90 degrees clockwise"));
  ASSERT_EQ(export_with(" --rotate 90").code, 0);
  expect_size(300, 400);
  ExpectRefusal(export_with(""),
                "expected the camera that the map was made with, found another one: images of "
                "300x400 and 400x300 pixels, one of them turned");
  ExpectRefusal(run(" --rotate 90"), "sequence: expected one camera whose images can be turned");
  ExpectRefusal(run(" --rotate 45"), "--rotate: expected auto, none, 90, 180 or 270, found 45");
  ExpectRefusal(run(" --max-width 3"), "--max-width: expected a whole number from 16 to 100000");
}

// A map of a run with --view-angle, of a lens that keeps its size without.
TEST(MapExport, FindsTheViewAngleOfTheRun) {
  const ScratchFolder folder;
  const std::string sequence = Quoted(WritePosterSequence(folder, 24));
  const Outcome run = RunProgram(
      folder,
      "run " + sequence + " --view-angle 55 --max-width 360 --out " + Quoted(folder / "run"));
  ASSERT_EQ(run.code, 0) << run.err;
  const auto export_with = [&](const std::string& arguments) {
    return RunProgram(folder,
                      "map export " + Quoted(folder / "run/map.plb") + " --to colmap --images " +
                          sequence + arguments + " --out " + Quoted(folder / "data"));
  };
  ExpectRefusal(export_with(" --view-angle 45"), "view angles of 55 and 45 degrees");
  ExpectRefusal(RunProgram(folder,
                           "run " + sequence + " --view-angle 45 --max-width 360 --map " +
                               Quoted(folder / "run/map.plb") + " --out " + Quoted(folder / "on")),
                "map.plb: expected a map of the same rectified camera, found view angles of 55 and "
                "45 degrees");
  ExpectRefusal(RunProgram(folder,
                           "map export " + Quoted(folder / "run/map.plb") +
                               " --to colmap --images " + sequence + " --out " + sequence + "/exp"),
                "which is read; choose another folder");
  const Outcome outcome = export_with("");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const ColmapModel model = ReadColmapText(folder / "data/sparse/0");
  EXPECT_EQ(model.camera.width, 360);
  for (const ColmapModel::Point& point : model.points) {
    EXPECT_NEAR(ReprojectionErrorOf(model, point), point.error, 1e-6);
  }
}

// An image that cannot be read ends an export without a trace.
TEST(MapExport, LeavesNothingWhenAnImageIsBroken) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 24);
  folder.Write("sequence/mav0/cam0/data/0.png", "text");
  const Outcome outcome = Export(folder, "nerfstudio --images " + Quoted(sequence), "data");
  ExpectRefusal(outcome, "cam0/data/0.png: not an image this program can decode");
  EXPECT_EQ(FilesOf(folder.path()), (std::set<std::string>{"sequence", "stderr", "stdout"}));
}

// Nor does one that a signal stops, unless it was done by then.
TEST(MapExport, ASignalLeavesNothing) {
  const ScratchFolder folder;
  const pid_t child = StartProgram({"map",
                                    "export",
                                    Posters().map.string(),
                                    "--to",
                                    "colmap",
                                    "--images",
                                    Posters().sequence.string(),
                                    "--out",
                                    (folder / "model").string()});
  const fs::path images = folder / fmt::format(".model.{}.tmp/images", child);
  for (int i = 0; i < 60000 && !fs::exists(images) && !fs::exists(folder / "model"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ::kill(child, SIGINT);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 0) {
    EXPECT_EQ(FilesOf(folder.path()), std::set<std::string>{"model"});
  } else {
    EXPECT_EQ(WEXITSTATUS(status), 130);
    EXPECT_TRUE(FilesOf(folder.path()).empty());
  }
}

}  // namespace
}  // namespace plumbline
