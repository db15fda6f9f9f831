// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"

#include "tests/io/dataset_fixtures.h"
#include "tests/io/recorded_bag.h"
#include "tests/io/scratch_folder.h"
#include "tests/support/mcap_writer.h"
#include "tests/support/rosbag2_writer.h"
#include <bit>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

TEST(Recordings, ReadsAPairOfABag) {
  const ScratchFolder folder;
  const auto dataset = OpenDataset(Write(folder, StereoBag()));
  EXPECT_EQ(dataset->info().format, DatasetFormat::kBag);
  EXPECT_EQ(dataset->sensor(), SensorKind::kStereo);
  EXPECT_THAT(dataset->info().stamps_ns, ElementsAre(kSecond, 2 * kSecond));
  EXPECT_THAT(dataset->info().notes,
              Contains(HasSubstr("1 images of /cam0/image_raw without one of /cam1/image_raw")));
  EXPECT_NEAR(dataset->calibration().right_from_left.translation.x(), -0.1, 1e-12);
  EXPECT_FALSE(dataset->calibration().rectified);
  EXPECT_THAT(dataset->info().calibration_source,
              HasSubstr("/cam0/camera_info and /cam1/camera_info"));
  const auto frame = dataset->Read(1);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->stamp_ns, 2 * kSecond);
  EXPECT_EQ(frame->left.at(7, 5), 2);
  EXPECT_EQ(frame->right->at(0, 0), 12);
  EXPECT_EQ(OpenDataset(folder / "x.bag", {.sensor = SensorKind::kMono})->size(), 3U);
}

// A topic of masks is none of images, and gives frames those of their moment.
TEST(Recordings, TakeMasksByTopic) {
  const ScratchFolder folder;
  BagWriter bag;
  AddCamera(bag, "/c/camera_info", {});
  for (const int i : {1, 2, 3}) AddImage(bag, "/c/image", Gray(i * kSecond, 'a'));
  AddImage(bag, "/people/mask", Gray(kSecond + 1000, '\xFF'));
  AddImage(bag, "/people/mask", Gray(3 * kSecond, '\0'));
  const std::filesystem::path file = Write(folder, bag);
  EXPECT_EQ(OpenDataset(file)->size(), 3U) << "a topic of masks is none of images";
  EXPECT_THAT(OpenDataset(file)->info().notes, Contains(HasSubstr("/people/mask has masks")));
  const auto dataset = OpenDataset(file, {.masks = {"/people/mask"}});
  EXPECT_EQ(dataset->size(), 3U);
  EXPECT_EQ(dataset->Read(0)->left_mask->at(3, 3), 255);
  EXPECT_EQ(dataset->Read(1)->left_mask, nullptr);
  EXPECT_EQ(dataset->Read(2)->left_mask->at(3, 3), 0);
  EXPECT_THAT(dataset->info().notes, Contains("topics: /c/image, /people/mask"));
  EXPECT_THAT(
      dataset->info().notes,
      Contains(HasSubstr("2 of the 3 images of the data have a mask of /people/mask; they leave "
                         "out 50 % of the image")));
  EXPECT_THAT(MessageOf([&] { OpenDataset(file, {.masks = {"/nobody"}}); }),
              HasSubstr("expected an image file or a topic as a mask, found '/nobody'; topics: "));
  EXPECT_THAT(MessageOf([&] {
                OpenDataset(file, {.masks = {"/people/mask", "/people/mask"}});
              }),
              HasSubstr("expected a topic of masks for each camera, found '/people/mask' twice"));
  EXPECT_THAT(MessageOf([&] { OpenDataset(file, {.masks = {"/c/camera_info"}}); }),
              HasSubstr("/c/camera_info: expected images as masks, found sensor_msgs/CameraInfo"));
}

TEST(Recordings, TakeMasksThatAreCompressedOrBroken) {
  const ScratchFolder folder;
  BagWriter bag;
  AddCamera(bag, "/c/camera_info", {});
  for (const int i : {1, 2}) AddImage(bag, "/c/image", Gray(i * kSecond, 'a'));
  const auto add = [&](int second, const std::string& bytes) {
    bag.Add("/people/mask/compressed",
            "sensor_msgs/CompressedImage",
            second * kSecond,
            CompressedImageMessage(Dialect::kRos1, {second * kSecond, "png", 0, 0, 0, bytes}));
  };
  add(1, Png(8, 6, '\x01'));
  add(2, Png(9, 6, '\0'));
  const auto dataset = OpenDataset(Write(folder, bag), {.masks = {"/people/mask"}});
  EXPECT_EQ(dataset->Read(0)->left_mask->at(3, 3), 255);
  ASSERT_TRUE(dataset->Read(1)) << "a mask of another size costs no frame";
  EXPECT_EQ(dataset->Read(1)->left_mask, nullptr);
  EXPECT_THAT(dataset->info().notes,
              Contains(EndsWith("; 1 cannot be used, and its image is used whole: " +
                                (folder / "x.bag").string() +
                                ": /people/mask/compressed: expected a mask of 8x6 pixels as the "
                                "images, found 9x6")));
}

TEST(Recordings, TellThatNoMessageOfATopicOfMasksCanBeRead) {
  const ScratchFolder folder;
  const TestImage image{kSecond, "mono8", 8, 6, 8, std::string(48, 'a')};
  {
    Rosbag2Writer writer(folder / "x.db3");
    writer.Add("/c/image", "sensor_msgs/msg/Image", 1, RawImageMessage(Dialect::kCdr, image));
    writer.Add("/people/mask", "sensor_msgs/msg/Image", 2, "damaged");
  }
  EXPECT_THAT(
      MessageOf([&] { OpenDataset(folder / "x.db3", {.masks = {"/people/mask"}}); }),
      EndsWith("x.db3: /people/mask: expected images as masks, found no message that can be read "
               "as sensor_msgs/msg/Image"));
}

TEST(Recordings, ReadsMcapOfAllDialects) {
  const std::map<Dialect, std::vector<std::string>> names = {
      {Dialect::kRos1,
       {"ros1", "sensor_msgs/Image", "sensor_msgs/CompressedImage", "sensor_msgs/CameraInfo"}},
      {Dialect::kCdr,
       {"cdr",
        "sensor_msgs/msg/Image",
        "sensor_msgs/msg/CompressedImage",
        "sensor_msgs/msg/CameraInfo"}},
      {Dialect::kProtobuf,
       {"protobuf",
        "foxglove.RawImage",
        "foxglove.CompressedImage",
        "foxglove.CameraCalibration"}}};
  for (const auto& [dialect, words] : names) {
    const ScratchFolder folder;
    McapWriter file("zstd");
    file.Add("/camera/info", words[3], words[0], 1, CalibrationMessageOf(dialect, {}));
    file.Add("/camera/image", words[1], words[0], 2, RawImageMessage(dialect, Gray(kSecond, 'a')));
    const std::string png = Png(8, 6, 'b');
    file.Add("/camera/image",
             words[2],
             words[0],
             3,
             CompressedImageMessage(dialect, {2 * kSecond, "png", 0, 0, 0, png}));
    const auto dataset = OpenDataset(folder.Write("x.mcap", file.Finish()));
    EXPECT_EQ(dataset->info().format, DatasetFormat::kMcap);
    EXPECT_EQ(dataset->sensor(), SensorKind::kMono);
    ASSERT_THAT(dataset->info().stamps_ns, ElementsAre(kSecond, 2 * kSecond));
    EXPECT_EQ(dataset->Read(0)->left.at(3, 3), 'a');
    EXPECT_EQ(dataset->Read(1)->left.at(3, 3), 'b');
    EXPECT_EQ(dataset->calibration().left.intrinsics().fx, 5);
  }
}

TEST(Recordings, AreKnownByTheirFirstBytesWhateverTheirNames) {
  const ScratchFolder folder;
  const std::string bag = StereoBag().Finish();
  McapWriter mcap;
  mcap.Add("/camera/info",
           "sensor_msgs/CameraInfo",
           "ros1",
           1,
           CalibrationMessageOf(Dialect::kRos1, {}));
  mcap.Add("/camera/image",
           "sensor_msgs/Image",
           "ros1",
           2,
           RawImageMessage(Dialect::kRos1, Gray(kSecond, 'a')));
  const std::string other = mcap.Finish();
  for (const char* name : {"x.bag", "x.mcap", "x.avi", "x"}) {
    EXPECT_EQ(FindFormat(folder.Write(name, bag)), DatasetFormat::kBag) << name;
    EXPECT_EQ(OpenDataset(folder / name)->size(), 2U) << name;
    EXPECT_EQ(FindFormat(folder.Write(name, other)), DatasetFormat::kMcap) << name;
    EXPECT_EQ(OpenDataset(folder / name)->size(), 1U) << name;
  }
  // Neither's: the name tells.
  EXPECT_EQ(FindFormat(folder.Write("y.bag", "damaged")), DatasetFormat::kBag);
  EXPECT_EQ(FindFormat(folder.Write("y.mcap", "damaged")), DatasetFormat::kMcap);
  EXPECT_EQ(FindFormat(folder.Write("y.avi", "damaged")), DatasetFormat::kVideo);
}

TEST(Recordings, TurnsColourIntoGreyAsImageFilesDo) {
  const ScratchFolder folder;
  BagWriter bag;
  AddCamera(bag, "/c/camera_info", {});
  const std::vector<std::pair<std::string, std::string>> pixels = {{"bgr8", "\x10\x50\xA0"},
                                                                   {"rgb8", "\xA0\x50\x10"},
                                                                   {"bgra8", "\x10\x50\xA0\xFF"},
                                                                   {"rgba8", "\xA0\x50\x10\xFF"}};
  std::int64_t stamp = 0;
  for (const auto& [encoding, pixel] : pixels) {
    TestImage image{stamp += kSecond, encoding, 8, 6, 0, ""};
    image.step = static_cast<std::uint32_t>(8 * pixel.size() + 3);  // rows have a margin
    for (int y = 0; y < 6; ++y) {
      for (int x = 0; x < 8; ++x) image.data += pixel;
      image.data += "***";
    }
    AddImage(bag, "/c/image", image);
  }
  const auto dataset = OpenDataset(Write(folder, bag));
  // 0.299 R + 0.587 G + 0.114 B
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(dataset->Read(i)->left.at(7, 5), 97) << i;
    EXPECT_TRUE((dataset->ReadColor(i)->at(7, 5) == Color{0xA0, 0x50, 0x10})) << i;
  }
}

TEST(Recordings, GivesColoursOfCompressedImages) {
  const ScratchFolder folder;
  BagWriter bag;
  AddCamera(bag, "/c/camera_info", {});
  std::vector<std::uint8_t> png;
  cv::imencode(".png", cv::Mat(6, 8, CV_8UC3, cv::Scalar(16, 80, 160)), png);
  AddPacked(bag, "/c/image/compressed", {kSecond, "png", 8, 6, 8, {png.begin(), png.end()}});
  AddPacked(bag, "/c/image/compressed", {2 * kSecond, "png", 8, 6, 8, Png(8, 6, 7)});
  const auto dataset = OpenDataset(Write(folder, bag));
  EXPECT_TRUE((dataset->ReadColor(0)->at(7, 5) == Color{160, 80, 16}));
  EXPECT_TRUE((dataset->ReadColor(1)->at(7, 5) == Color{7, 7, 7}));
}

TEST(Recordings, FindDepthByItsEncoding) {
  for (const std::string encoding : {"16UC1", "mono16", "32FC1", "16UC1; compressedDepth png"}) {
    const ScratchFolder folder;
    BagWriter bag;
    AddCamera(bag, "/camera/rgb/camera_info", {});
    AddImage(bag, "/camera/rgb/image_color", Gray(kSecond, 'a'));
    TestImage depth{kSecond + 15'000'000, encoding, 8, 6, 16, ""};
    for (int i = 0; i < 48; ++i) {
      const float metres = i == 0 ? std::numeric_limits<float>::quiet_NaN() : 1.5F;
      depth.data += encoding == "32FC1" ? LittleEndian(std::bit_cast<std::uint32_t>(metres), 4)
                                        : LittleEndian(i == 0 ? 0 : 1500, 2);
    }
    if (encoding == "32FC1") depth.step = 32;
    if (encoding.size() > 6) {
      depth.data = std::string(12, '\0') + Png(8, 6, 1500);
      AddPacked(bag, "/camera/depth/image/compressedDepth", depth);
    } else {
      AddImage(bag, "/camera/depth/image", depth);
    }
    const auto path = Write(folder, bag);
    const auto dataset = OpenDataset(path);
    ASSERT_EQ(dataset->sensor(), SensorKind::kRgbd) << encoding;
    const auto frame = dataset->Read(0);
    ASSERT_TRUE(frame) << frame.error().why;
    EXPECT_EQ(frame->depth->at(7, 5), 1.5F);
    EXPECT_EQ(frame->depth->at(0, 0), encoding.size() <= 6 ? 0.0F : 1.5F);
    EXPECT_EQ(OpenDataset(path, {.sensor = SensorKind::kMono})->sensor(), SensorKind::kMono);
  }
}

TEST(Recordings, SayWhereDepthIsOfAnotherCamera) {
  const auto notes_for = [](const std::string& image_frame, const std::string& depth_frame) {
    const ScratchFolder folder;
    BagWriter bag;
    AddCamera(bag, "/camera/color/camera_info", {});
    TestImage image = Gray(kSecond, 'a');
    image.frame = image_frame;
    AddImage(bag, "/camera/color/image_raw", image);
    TestImage depth{kSecond, "16UC1", 8, 6, 16, std::string(96, '\1'), depth_frame};
    AddImage(bag, "/camera/depth/image_rect_raw", depth);
    return OpenDataset(Write(folder, bag))->info().notes;
  };
  const auto about_frames = Contains(HasSubstr("must be registered"));
  EXPECT_THAT(notes_for("color", "depth"),
              Contains("the depth of /camera/depth/image_rect_raw is in the frame depth, its image "
                       "in color: depth must be registered to the image"));
  EXPECT_THAT(notes_for("color", "color"), Not(about_frames));
  EXPECT_THAT(notes_for("color", ""), Not(about_frames));
}

// 3000 / (v + 10) metres.
TEST(Recordings, UnpackDepthInMetres) {
  const ScratchFolder folder;
  BagWriter bag;
  AddCamera(bag, "/camera/rgb/camera_info", {});
  cv::Mat levels(6, 8, CV_16UC1, cv::Scalar(1990));
  levels.at<std::uint16_t>(0, 0) = 0;
  std::vector<std::uint8_t> png;
  cv::imencode(".png", levels, png);
  const std::string header = std::string(4, '\0') +
                             LittleEndian(std::bit_cast<std::uint32_t>(3000.0F), 4) +
                             LittleEndian(std::bit_cast<std::uint32_t>(-10.0F), 4);
  for (const int i : {1, 2}) {
    AddImage(bag, "/camera/rgb/image_color", Gray(i * kSecond, 'a'));
    TestImage depth{i * kSecond, "32FC1; compressedDepth png", 0, 0, 0, header.substr(0, 11)};
    if (i == 1) depth.data = header + std::string(png.begin(), png.end());
    AddPacked(bag, "/camera/depth/image/compressedDepth", depth);
  }
  const auto dataset = OpenDataset(Write(folder, bag));
  ASSERT_EQ(dataset->sensor(), SensorKind::kRgbd);
  const auto frame = dataset->Read(0);
  ASSERT_TRUE(frame) << frame.error().why;
  EXPECT_EQ(frame->depth->at(7, 5), 1.5F);
  EXPECT_EQ(frame->depth->at(0, 0), 0.0F);
  const auto cut = dataset->Read(1);
  ASSERT_FALSE(cut);
  EXPECT_THAT(cut.error().why, HasSubstr("the message ends early"));
}

TEST(Recordings, TakeThePictureThatIsNotPacked) {
  const ScratchFolder folder;
  BagWriter bag;
  AddCamera(bag, "/c/camera_info", {});
  AddImage(bag, "/c/image", Gray(kSecond, 'a'));
  AddPacked(bag, "/c/image/compressed", {kSecond, "png", 0, 0, 0, Png(8, 6, 'b')});
  const auto path = Write(folder, bag);
  EXPECT_EQ(OpenDataset(path)->Read(0)->left.at(0, 0), 'a');
  EXPECT_EQ(OpenDataset(path, {.topics = {"/c/image/compressed"}})->Read(0)->left.at(0, 0), 'b');
}

TEST(Recordings, TellOnceOfImagesOf16Bits) {
  const ScratchFolder folder;
  BagWriter bag;
  AddCamera(bag, "/c/camera_info", {});
  for (const int i : {1, 2}) {
    AddPacked(bag, "/c/image/compressed", {i * kSecond, "png", 0, 0, 0, Png(8, 6, 4095)});
  }
  const auto dataset = OpenDataset(Write(folder, bag));
  EXPECT_THAT(dataset->info().notes,
              ElementsAre("topics: /c/image/compressed",
                          "the images have 16 bits, of which 12 are used (the brightest level of 2 "
                          "images is 4095): levels are divided by 16"));
  EXPECT_EQ(dataset->Read(0)->left.at(0, 0), 255);
}

TEST(Recordings, TakeAPairOf16BitsForImages) {
  const ScratchFolder folder;
  const auto path = Write(folder, DeepBag({"/cam0/image_raw", "/cam1/image_raw"}, {800, 900}));
  const auto dataset = OpenDataset(path, {.camera = PairFile(folder)});
  ASSERT_EQ(dataset->sensor(), SensorKind::kStereo);
  EXPECT_THAT(dataset->info().notes,
              Contains("the images have 16 bits, of which 10 are used (the brightest level of 4 "
                       "images is 900): levels are divided by 4"));
  EXPECT_EQ(dataset->Read(0)->left.at(0, 5), 200);
  EXPECT_EQ(dataset->Read(1)->right->at(7, 5), 112);
}

TEST(Recordings, ScaleLevelsOf16BitsByWhatIsSeen) {
  const std::map<int, int> expected = {{100, 100},
                                       {255, 255},
                                       {256, 64},
                                       {1023, 255},
                                       {1024, 64},
                                       {4095, 255},
                                       {4096, 64},
                                       {65535, 255}};
  for (const auto& [level, gray] : expected) {
    const ScratchFolder folder;
    const auto path = Write(folder, DeepBag({"/depth"}, {level}));
    const auto dataset = OpenDataset(path, {.camera = PairFile(folder), .topics = {"/depth"}});
    EXPECT_EQ(dataset->Read(0)->left.at(0, 0), gray) << level;
  }
}

TEST(Recordings, TakeWhatIsNamedInItsOrder) {
  const ScratchFolder folder;
  BagWriter bag = DeepBag({"/ir", "/other", "/depth"}, {2000});
  AddImage(bag, "/right/image", Gray(kSecond, 'r'));
  AddImage(bag, "/left/image", Gray(kSecond, 'l'));
  TestImage metres{kSecond, "32FC1", 8, 6, 32, std::string(192, '\0')};
  AddImage(bag, "/metres", metres);
  const auto path = Write(folder, bag);
  const auto open = [&](const std::vector<std::string>& topics,
                        std::optional<SensorKind> sensor = std::nullopt) {
    return OpenDataset(path, {.sensor = sensor, .camera = PairFile(folder), .topics = topics});
  };
  // Whatever the names say.
  const auto swapped = open({"/right/image", "/left/image"});
  EXPECT_EQ(swapped->Read(0)->left.at(0, 0), 'r');
  EXPECT_EQ(swapped->Read(0)->right->at(0, 0), 'l');
  EXPECT_EQ(open({"/ir"})->sensor(), SensorKind::kMono);
  EXPECT_EQ(open({"/ir", "/other"})->sensor(), SensorKind::kStereo);
  EXPECT_EQ(open({"/ir", "/other"}, SensorKind::kRgbd)->sensor(), SensorKind::kRgbd);
  EXPECT_EQ(open({"/ir", "/depth"})->sensor(), SensorKind::kRgbd);
  EXPECT_EQ(open({"/ir", "/depth"}, SensorKind::kStereo)->sensor(), SensorKind::kStereo);
  EXPECT_EQ(open({"/ir", "/metres"})->Read(0)->left.at(0, 0), 125);
  EXPECT_EQ(open({"/left/image", "/ir"})->sensor(), SensorKind::kRgbd);
  EXPECT_EQ(open({"/left/image", "/ir"})->Read(0)->depth->at(0, 0), 2.0F);
  EXPECT_EQ(open({"/left/image", "/right/image", "/ir"})->info().available.size(), 3U);
  const std::vector<std::vector<std::string>> wrong = {{"/metres"},
                                                       {"/metres", "/left/image"},
                                                       {"/depth", "/left/image"},
                                                       {"/left/image", "/metres", "/right/image"},
                                                       {"/ir", "/left/image", "/depth"},
                                                       {"/ir", "/other", "/depth", "/metres"}};
  for (const auto& topics : wrong) {
    EXPECT_THAT(
        MessageOf([&] { open(topics); }),
        HasSubstr("expected --topic to name images in the order left, right, depth, found " +
                  topics[0]));
  }
}

TEST(Recordings, ReadCamerasAsTheyAreCalibrated) {
  const ScratchFolder folder;
  const auto opened =
      [&](const TestCamera& left, const TestCamera& right, const std::string& image) {
        BagWriter bag;
        AddCamera(bag, "/left/camera_info", left);
        AddCamera(bag, "/right/camera_info", right);
        AddImage(bag, "/left/" + image, Gray(kSecond, 'a'));
        AddImage(bag, "/right/" + image, Gray(kSecond, 'b'));
        return OpenDataset(Write(folder, bag))->calibration();
      };
  TestCamera left, right = RightCamera();
  left.d = {0.1, -0.02, 0.001, 0.002, 0.003};
  left.p[0] = left.p[5] = right.p[0] = right.p[5] = 4;
  right.p[3] = -0.4;
  // Turned by 0.1 about y: the rectified pair lies along the left camera's axis.
  const double c = 0.995004165278026, s = 0.099833416646828;
  right.r = {c, 0, -s, 0, 1, 0, s, 0, c};
  right.model = "equidistant";
  right.d = {0.01, 0.02, 0.003, 0.004};
  const Calibration raw = opened(left, right, "image_raw");
  EXPECT_EQ(raw.left.intrinsics().model, DistortionModel::kRadTan);
  EXPECT_EQ(raw.left.intrinsics().distortion[4], 0.003);
  EXPECT_EQ(raw.right->intrinsics().model, DistortionModel::kEquidistant);
  EXPECT_EQ(raw.left.intrinsics().fx, 5);
  EXPECT_FALSE(raw.rectified);
  // In the frame of the right camera, whose x axis is turned.
  EXPECT_NEAR(raw.right_from_left.translation.norm(), 0.1, 1e-9);
  EXPECT_NEAR(raw.right_from_left.translation.x(), -0.1 * c, 1e-9);
  EXPECT_NEAR(raw.right_from_left.translation.z(), 0.1 * s, 1e-9);
  const Calibration rectified = opened(left, right, "image_rect");
  EXPECT_TRUE(rectified.rectified);
  EXPECT_EQ(rectified.left.intrinsics().fx, 4);
  EXPECT_TRUE(rectified.left.IsIdeal());
  EXPECT_NEAR(rectified.right_from_left.translation.x(), -0.1, 1e-12);

  const auto message = [&](const TestCamera& a, const TestCamera& b) {
    return MessageOf([&] { opened(a, b, "image_raw"); });
  };
  TestCamera odd = left;
  odd.model = "thin_prism";
  EXPECT_THAT(message(odd, right),
              HasSubstr("/left/camera_info: expected distortion plumb_bob or equidistant, found "
                        "'thin_prism': give --camera FILE"));
  odd = left;
  odd.binning = 2;
  EXPECT_THAT(message(odd, right), HasSubstr("expected whole images, found binned"));
  odd = left;
  odd.r = {};
  EXPECT_THAT(message(odd, right), HasSubstr("expected a rotation in R"));
  odd = right;
  odd.p[3] = 0;
  EXPECT_THAT(message(left, odd), HasSubstr("/right/camera_info: expected the baseline in P"));
  odd.p[3] = 0.4;
  EXPECT_THAT(message(left, odd), HasSubstr("expected the right camera to the right"));
  odd = left;
  odd.k[0] = -1;
  EXPECT_THAT(message(odd, right), HasSubstr("/left/camera_info: expected fx"));
}

// Orbbec's driver sends a rational model that is none, RealSense's a name without distortion.
TEST(Recordings, TakeModelsOfMoreNumbersThatAreZero) {
  for (const Dialect dialect : {Dialect::kCdr, Dialect::kProtobuf}) {
    const bool cdr = dialect == Dialect::kCdr;
    const std::string package = cdr ? "sensor_msgs/msg/" : "foxglove.";
    const auto opened = [&](const std::string& model, const std::vector<double>& d) {
      const ScratchFolder folder;
      McapWriter file;
      TestCamera camera;
      camera.model = model;
      camera.d = d;
      file.Add("/c/camera_info",
               package + (cdr ? "CameraInfo" : "CameraCalibration"),
               cdr ? "cdr" : "protobuf",
               1,
               CalibrationMessageOf(dialect, camera));
      file.Add("/c/image",
               package + (cdr ? "Image" : "RawImage"),
               cdr ? "cdr" : "protobuf",
               2,
               RawImageMessage(dialect, Gray(kSecond, 'a')));
      return OpenDataset(folder.Write("x.mcap", file.Finish()))->calibration().left.intrinsics();
    };
    EXPECT_EQ(opened("rational_polynomial", {0.1, -0.02, 0, 0, 0.003, 0, 0, 0}).distortion[4],
              0.003);
    EXPECT_EQ(opened("kannala_brandt", {0.1, -0.02, 0, 0}).model, DistortionModel::kEquidistant);
    EXPECT_EQ(opened("Inverse Brown Conrady", {0, 0, 0, 0, 0}).model, DistortionModel::kNone);
    EXPECT_EQ(opened("", {}).model, DistortionModel::kNone);
    EXPECT_THAT(MessageOf([&] {
                  opened("Inverse Brown Conrady", {0.1, 0, 0, 0, 0});
                }),
                HasSubstr("/c/camera_info: expected plumb_bob or equidistant, found 'Inverse Brown "
                          "Conrady', whose numbers undo a distortion"));
  }
}

TEST(Recordings, OrderImagesByTheSensorsStamps) {
  const ScratchFolder folder;
  BagWriter bag;
  AddCamera(bag, "/c/camera_info", {});
  AddImage(bag, "/c/image", Gray(3 * kSecond, 'c'));
  AddImage(bag, "/c/image", Gray(kSecond, 'a'));
  AddImage(bag, "/c/image", Gray(kSecond, 'x'));
  bag.Add(
      "/c/image", "sensor_msgs/Image", 2 * kSecond, RawImageMessage(Dialect::kRos1, Gray(0, 'b')));
  const auto dataset = OpenDataset(Write(folder, bag));
  EXPECT_THAT(dataset->info().stamps_ns, ElementsAre(kSecond, 2 * kSecond, 3 * kSecond));
  EXPECT_EQ(dataset->Read(0)->left.at(0, 0), 'a');
  EXPECT_EQ(dataset->Read(1)->left.at(0, 0), 'b');
  EXPECT_THAT(dataset->info().notes, Contains(HasSubstr("1 images of /c/image have no stamp")));
  EXPECT_THAT(dataset->info().notes,
              Contains(HasSubstr("1 images of /c/image have the stamp of another")));
}

// The frames of images with these stamps that are recorded one each second from 100 s on.
std::vector<std::int64_t> FramesOfStamps(const std::vector<std::int64_t>& stamps_ns) {
  const ScratchFolder folder;
  BagWriter bag;
  AddCamera(bag, "/c/camera_info", {});
  std::int64_t logged_ns = 100 * kSecond;
  for (const std::int64_t stamp_ns : stamps_ns) {
    bag.Add("/c/image",
            "sensor_msgs/Image",
            logged_ns,
            RawImageMessage(Dialect::kRos1, Gray(stamp_ns, 'a')));
    logged_ns += kSecond;
  }
  return OpenDataset(Write(folder, bag))->info().stamps_ns;
}

// Such stamps come from clocks that were not set, and from messages that were not filled in.
TEST(Recordings, TakeTheTimeOfRecordingForStampsThatAreNoTime) {
  const ScratchFolder folder;
  McapWriter file;
  file.Add("/c/camera_info",
           "sensor_msgs/msg/CameraInfo",
           "cdr",
           1,
           CalibrationMessageOf(Dialect::kCdr, {}));
  for (const int i : {1, 2, 3}) {
    std::string message = RawImageMessage(Dialect::kCdr, Gray(i * kSecond, 'a'));
    if (i > 1) message.replace(4, 4, LittleEndian(0xFFFFFFFEU, 4));  // -2 s
    file.Add("/c/image", "sensor_msgs/msg/Image", "cdr", i * kSecond + 7, message);
  }
  const auto dataset = OpenDataset(folder.Write("x.mcap", file.Finish()));
  EXPECT_THAT(dataset->info().stamps_ns, ElementsAre(kSecond, 2 * kSecond + 7, 3 * kSecond + 7));
  EXPECT_THAT(dataset->info().notes, Contains(HasSubstr("2 images of /c/image have no stamp")));
  EXPECT_THAT(FramesOfStamps({99 * kSecond, 4'294'967'295 * kSecond}),
              ElementsAre(99 * kSecond, 101 * kSecond));
}

TEST(Recordings, SayThatNoCameraIsSoFast) {
  const auto notes = [](std::int64_t interval_ns) {
    const ScratchFolder folder;
    BagWriter bag;
    AddCamera(bag, "/c/camera_info", {});
    for (int i = 0; i < 12; ++i) AddImage(bag, "/c/image", Gray(kSecond + i * interval_ns, 'a'));
    return OpenDataset(Write(folder, bag))->info().notes;
  };
  EXPECT_THAT(notes(50'000),
              Contains("the time stamps are those of 20000 frames a second, which no "
                       "camera takes: are they in another unit than nanoseconds?"));
  EXPECT_THAT(notes(1'000'000), Not(Contains(HasSubstr("frames a second"))));
}

// A simulation begins at 0; elsewhere 0 means that nobody set the stamp.
TEST(Recordings, MayBeginAtZero) {
  EXPECT_THAT(FramesOfStamps({0, kSecond / 20, kSecond / 10}),
              ElementsAre(0, kSecond / 20, kSecond / 10));
  EXPECT_THAT(FramesOfStamps({0, 0, 0}), ElementsAre(100 * kSecond, 101 * kSecond, 102 * kSecond));
  EXPECT_THAT(FramesOfStamps({0, 103 * kSecond, 104 * kSecond}),
              ElementsAre(100 * kSecond, 103 * kSecond, 104 * kSecond));
  EXPECT_THAT(FramesOfStamps({0}), ElementsAre(100 * kSecond));
}

}  // namespace
}  // namespace plumbline
