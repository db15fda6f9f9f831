// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/cameras/camera_file.h"

#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/data_folder.h"
#include "tests/support/euroc_calibration.h"
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr char kMono[] = "model: pinhole\nsize: [640, 480]\nintrinsics: [500, 510, 320.5, 240]\n";

TEST(ParseCamera, ReadsTheExampleOfTheDocuments) {
  const std::string page = Contents(PLUMBLINE_SEEDS "/../../docs/file-formats.md");
  const std::string fence = "```";
  const std::size_t begin = page.find(fence + "yaml\n", page.find("## Camera files"));
  ASSERT_NE(begin, std::string::npos);
  const std::size_t text = begin + fence.size() + 5;
  const std::string example = page.substr(text, page.find(fence, text) - text);
  const Calibration c = ParseCamera(example, "example.yaml");
  ASSERT_TRUE(c.right && c.body_from_left && c.rate_hz);
  EXPECT_DOUBLE_EQ(c.right_from_left.translation.x(), -0.11);
  EXPECT_THAT(example, HasSubstr("\n# baseline: 0.11 "));
}

TEST(ParseCamera, ReadsAMonocularCamera) {
  const Calibration c = ParseCamera(std::string(kMono) +
                                        "distortion: radtan\n"
                                        "distortion_coefficients: [0.1, -0.2, 0.001, -0.002]\n"
                                        "rate_hz: 30\ndepth_factor: 5000\n",
                                    "c.yaml");
  EXPECT_EQ(c.left,
            Camera({.fx = 500,
                    .fy = 510,
                    .cx = 320.5,
                    .cy = 240,
                    .width = 640,
                    .height = 480,
                    .model = DistortionModel::kRadTan,
                    .distortion = {0.1, -0.2, 0.001, -0.002, 0}}));
  EXPECT_EQ(c.rate_hz, 30);
  EXPECT_EQ(c.depth_factor, 5000);
  EXPECT_FALSE(c.right);
  EXPECT_FALSE(c.rectified);
}

TEST(ParseCamera, BaselineMakesARectifiedPair) {
  const Calibration c =
      ParseCamera(std::string(kMono) + "rectified: true\nbaseline: 0.12\n", "c.yaml");
  ASSERT_TRUE(c.right);
  EXPECT_EQ(*c.right, c.left);
  EXPECT_TRUE(c.rectified);
  EXPECT_EQ(c.right_from_left.translation, Eigen::Vector3d(-0.12, 0, 0));
}

TEST(FormatCamera, RoundTripKeepsTheNumbers) {
  Calibration c = EurocCalibration();
  const Calibration read = ParseCamera(FormatCamera(c), "c.yaml");
  EXPECT_EQ(read.left, c.left);
  EXPECT_EQ(read.right, c.right);
  EXPECT_EQ(read.rate_hz, c.rate_hz);
  EXPECT_LT(LogSe3(read.right_from_left * Inverse(c.right_from_left)).norm(), 1e-14);
  EXPECT_LT(LogSe3(*read.body_from_left * Inverse(*c.body_from_left)).norm(), 1e-14);
  c.right.reset();
  c.depth_factor = 1234.5;
  EXPECT_EQ(ParseCamera(FormatCamera(c), "c.yaml").depth_factor, 1234.5);
  EXPECT_FALSE(ParseCamera(FormatCamera(c), "c.yaml").right);
}

TEST(ParseCamera, BadFilesAreNamedByLineAndKey) {
  struct Case {
    std::string yaml;
    std::string message;
  };
  const std::string mono = kMono;
  const std::string pair = "right_from_left: [1,0,0,-0.1, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n";
  const std::vector<Case> cases = {
      {"", "c.yaml:1: expected 'key: value' rows, found nothing"},
      {"- 1\n", "c.yaml:1: expected 'key: value' rows, found a list"},
      {"a: [1", "c.yaml:"},
      {mono + "distorsion: none\n",
       "c.yaml:4: unknown key 'distorsion'; did you mean 'distortion'?"},
      {"size: [640, 480]\n", "intrinsics: expected 4 numbers, found no list"},
      {"size: [640]\nintrinsics: [1,1,1,1]\n", "c.yaml:1: size: expected 2 numbers, found 1"},
      {"size: [640, a]\nintrinsics: [1,1,1,1]\n", "c.yaml:1: size: expected 2 numbers, found 'a'"},
      {"size: [640, 0]\nintrinsics: [1,1,1,1]\n",
       "c.yaml:1: size: expected whole numbers from 1 to 100000, found 0"},
      {"size: [640.5, 9]\nintrinsics: [1,1,1,1]\n", "size: expected whole numbers from 1 to"},
      {"size: [640, 480]\nintrinsics: [-5,1,1,1]\n",
       "c.yaml:2: intrinsics: expected fx from 6.4 to 640000 px, found -5"},
      {mono + "distortion: fisheye\n",
       "c.yaml:4: distortion: expected one of none, radtan, equidistant, rational, fov, "
       "double_sphere, eucm, omni, found 'fisheye'"},
      {mono + "distortion: radtan\n", "distortion_coefficients: expected 4 or 5 numbers"},
      {mono + "distortion: equidistant\ndistortion_coefficients: [1, 2, 3, 4, 5]\n",
       "c.yaml:5: distortion_coefficients: expected 4 numbers, found 5"},
      {mono + "distortion_coefficients: [1, 2, 3, 4]\n", "expected none without a distortion"},
      {mono + "rate_hz: 0\n", "c.yaml:4: rate_hz: expected a number above 0, found '0'"},
      {mono + "depth_factor: [1]\n", "c.yaml:4: depth_factor: expected one value"},
      {mono + "rectified: yes\n", "c.yaml:4: rectified: expected true or false, found yes"},
      {mono + "baseline: 0.1\n", "c.yaml:4: baseline: expected `rectified: true`"},
      {mono + "rectified: true\nbaseline: -0.1\n", "baseline: expected a number above 0"},
      {mono + pair, "right_from_left: expected a camera `right` with it"},
      {mono + "right: {size: [640, 480], intrinsics: [500, 500, 1, 1]}\n",
       "c.yaml:4: right: expected right_from_left"},
      {mono + "right: 5\n", "c.yaml:4: right: expected a group of keys, found '5'"},
      {mono + "right:\n  siez: [640, 480]\n", "c.yaml:5: unknown key 'right.siez'"},
      {mono + "right:\n  size: [640, 480]\n" + pair, "right.intrinsics: expected 4 numbers"},
      {mono + "body_from_left: [2,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n",
       "c.yaml:4: body_from_left: expected a rigid motion"},
      {mono + "rectified: true\nright: {size: [640, 480], intrinsics: [500, 500, 1, 1]}\n"
              "right_from_left: [1,0,0,-0.1, 0,1,0,0.01, 0,0,1,0, 0,0,0,1]\n",
       "c.yaml:6: right_from_left: expected a motion along -x"},
  };
  for (const Case& c : cases) {
    EXPECT_THAT(MessageOf([&] { ParseCamera(c.yaml, "c.yaml"); }), HasSubstr(c.message)) << c.yaml;
  }
}

TEST(ParseCamera, NumbersThatNoCameraHasAreNamedByLineAndKey) {
  struct Case {
    std::string yaml;
    std::string message;
  };
  const std::string mono = kMono;
  const auto intrinsics = [](const std::string& numbers) {
    return "size: [640, 480]\nintrinsics: [" + numbers + "]\n";
  };
  const auto pair = [&](const std::string& motion) {
    return mono + "right: {size: [640, 480], intrinsics: [500, 500, 320, 240]}\n" +
           "right_from_left: [" + motion + ", 0,0,0,1]\n";
  };
  const std::string lens = mono + "distortion: radtan\ndistortion_coefficients: ";
  const std::vector<Case> cases = {
      {intrinsics("1e300, 500, 320, 240"),
       "c.yaml:2: intrinsics: expected fx from 6.4 to 640000 px"},
      {intrinsics("500, 1e-300, 320, 240"),
       "c.yaml:2: intrinsics: expected fy from 6.4 to 640000 px"},
      {intrinsics("500, 500, 1e300, 240"),
       "c.yaml:2: intrinsics: expected cx from -6400 to 7040 px"},
      {intrinsics("500, 500, 320, nan"), "c.yaml:2: intrinsics: expected 4 numbers, found 'nan'"},
      {"size: [30000, 30000]\nintrinsics: [500, 500, 1, 1]\n",
       "c.yaml:1: size: expected an image of at most 100 million pixels, found one of 30000x30000"},
      {lens + "[1e300, 0, 0, 0]\n",
       "c.yaml:5: distortion_coefficients: expected coefficients from -1e+06 to 1e+06, found"},
      {lens + "[-40, 0, 0, 0]\n",
       "c.yaml:5: distortion_coefficients: expected a distortion that has a ray for the pixels"},
      {mono + "rate_hz: 1e300\n", "c.yaml:4: rate_hz: expected a rate from 0.0001 to 100000 Hz"},
      {mono + "rate_hz: 1e-300\n", "c.yaml:4: rate_hz: expected a rate from 0.0001 to 100000 Hz"},
      {mono + "depth_factor: 1e-300\n", "c.yaml:4: depth_factor: expected a depth factor from"},
      {mono + "rectified: true\nbaseline: 0\n", "c.yaml:5: baseline: expected a number above 0"},
      {mono + "rectified: true\nbaseline: 1e-9\n",
       "c.yaml:5: baseline: expected a baseline from 0.0001 to 1000 m, found 1e-09"},
      {mono + "rectified: true\nbaseline: 1e30\n",
       "c.yaml:5: baseline: expected a baseline from 0.0001 to 1000 m, found 1e+30"},
      {mono + "rectified: true\ndistortion: radtan\ndistortion_coefficients: [0.1, 0, 0, 0]\n",
       "c.yaml:4: rectified: expected no lens distortion"},
      {pair("1,0,0,0, 0,1,0,0, 0,0,1,0"),
       "c.yaml:5: right_from_left: expected the right camera to the right (+x) of the left one, "
       "found it at (0, 0, 0) m"},
      {pair("1,0,0,0, 0,1,0,-0.1, 0,0,1,0"), "found it at (0, 0.1, 0) m"},
      {pair("1,0,0,0.1, 0,1,0,0, 0,0,1,0"), "found it at (-0.1, 0, 0) m"},
      {pair("-1,0,0,0.1, 0,1,0,0, 0,0,-1,0"), "found its axis 180 degrees off"},
      {pair("1,0,0,-0.1, 0,1,0,0, 0,0,1,0") + "body_from_left: [1,0,0,1e99, 0,1,0,0, 0,0,1,0, "
                                              "0,0,0,1]\n",
       "c.yaml:6: body_from_left: expected a body at most 10000 m from the camera"},
  };
  for (const Case& c : cases) {
    EXPECT_THAT(MessageOf([&] { ParseCamera(c.yaml, "c.yaml"); }), HasSubstr(c.message)) << c.yaml;
  }
}

// A rig whose second camera is no right one of ours has a left camera all the same.
TEST(ParseCamera, APairThatIsNotUsedMayStandAnyhow) {
  const std::string vertical = std::string(kMono) +
                               "right: {size: [640, 480], intrinsics: [500, 500, 320, 240]}\n" +
                               "right_from_left: [1,0,0,0, 0,1,0,-0.1, 0,0,1,0, 0,0,0,1]\n";
  EXPECT_EQ(ParseCamera(vertical, "c.yaml", false).left.intrinsics().fx, 500);
  EXPECT_THAT(MessageOf([&] { ParseCamera(vertical, "c.yaml", true); }),
              HasSubstr("c.yaml:5: right_from_left: expected the right camera to the right"));
}

TEST(ParseCamera, KeysAndDocumentsComeOnce) {
  EXPECT_THAT(MessageOf([] { ParseCamera(std::string(kMono) + "size: [1, 1]\n", "c.yaml"); }),
              HasSubstr("c.yaml:4: expected each key once, found 'size' again"));
  EXPECT_THAT(MessageOf([] { ParseCamera(std::string(kMono) + "---\n" + kMono, "c.yaml"); }),
              HasSubstr("c.yaml:4: expected one YAML document, found a second one"));
}

// The stereo pair of EuRoC as other programs write it down. The ORB-SLAM2 form holds a
// rectification computed by OpenCV, with other numbers of decimals than the rest.
constexpr char kKalibr[] = R"(cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]
  distortion_model: radtan
  intrinsics: [458.654, 457.296, 367.215, 248.375]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
cam1:
  T_cn_cnm1:
  - [0.99999725647745, 0.00231206719242016, 0.000376008102350993, -0.110073808127139]
  - [-0.00231713572328462, 0.999898048506528, 0.0140898358466973, 0.000399121547014457]
  - [-0.000343393120588828, -0.0140906684526704, 0.999900662638179, -0.000853702503351319]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [0]
  camera_model: pinhole
  distortion_coeffs: [-0.28368365, 0.07451284, -0.00010473, -3.55590700e-05]
  distortion_model: radtan
  intrinsics: [457.587, 456.134, 379.999, 255.238]
  resolution: [752, 480]
  rostopic: /cam1/image_raw
)";
constexpr char kOrbSlam3[] = R"(%YAML:1.0
File.version: "1.0"
Camera.type: "PinHole"
Camera1.fx: 458.654
Camera1.fy: 457.296
Camera1.cx: 367.215
Camera1.cy: 248.375
Camera1.k1: -0.28340811
Camera1.k2: 0.07395907
Camera1.p1: 0.00019359
Camera1.p2: 1.76187114e-05
Camera2.fx: 457.587
Camera2.fy: 456.134
Camera2.cx: 379.999
Camera2.cy: 255.238
Camera2.k1: -0.28368365
Camera2.k2: 0.07451284
Camera2.p1: -0.00010473
Camera2.p2: -3.55590700e-05
Camera.width: 752
Camera.height: 480
Camera.fps: 20
Camera.RGB: 1
Stereo.ThDepth: 60.0
Stereo.T_c1_c2: !!opencv-matrix
  rows: 4
  cols: 4
  dt: f
  data: [0.999997256477797,-0.002317135723275,-0.000343393120620,0.110074137800478,
         0.002312067192432,0.999898048506528,-0.014090668452683,-0.000156612054392,
         0.000376008102320,0.014089835846691,0.999900662638081,0.000889382785432,
         0,0,0,1.000000000000000]
ORBextractor.nFeatures: 1200
)";
constexpr char kOrbSlam2[] = R"(%YAML:1.0

#---- rectified camera
Camera.fx: 435.2046959714599
Camera.fy: 435.2046959714599
Camera.cx: 367.4517211914062
Camera.cy: 252.2008514404297
Camera.k1: 0.0
Camera.k2: 0.0
Camera.p1: 0.0
Camera.p2: 0.0
Camera.width: 752
Camera.height: 480
Camera.fps: 20.0
Camera.bf: 47.90639384423901
Camera.RGB: 1
ThDepth: 35
LEFT.height: 480
LEFT.width: 752
LEFT.D: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data:[-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05, 0.0]
LEFT.K: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [458.654, 0.0, 367.215, 0.0, 457.296, 248.375, 0.0, 0.0, 1.0]
LEFT.R:  !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [0.999966347530033, -0.001422739138722922, 0.008079580483432283, 0.001365741834644127, 0.9999741760894847, 0.007055629199258132, -0.008089410156878961, -0.007044357138835809, 0.9999424675829176]
LEFT.P:  !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [435.2046959714599, 0, 367.4517211914062, 0,  0, 435.2046959714599, 252.2008514404297, 0,  0, 0, 1, 0]
RIGHT.height: 480
RIGHT.width: 752
RIGHT.D: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data:[-0.28368365, 0.07451284, -0.00010473, -3.555907e-05, 0.0]
RIGHT.K: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [457.587, 0.0, 379.999, 0.0, 456.134, 255.238, 0.0, 0.0, 1]
RIGHT.R:  !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [0.9999633526194376, -0.003625811871560086, 0.007755443660172947, 0.003680398547259526, 0.9999684752771629, -0.007035845251224894, -0.007729688520722713, 0.007064130529506649, 0.999945173484644]
RIGHT.P:  !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [435.2046959714599, 0, 367.4517211914062, -47.90639384423901, 0, 435.2046959714599, 252.2008514404297, 0, 0, 0, 1, 0]
)";

TEST(ParseCamera, TheSameRigInEveryFormatIsTheSameCalibration) {
  const Calibration expected = EurocCalibration();
  for (const std::string& text : {FormatCamera(expected),
                                  std::string(kKalibr),
                                  std::string(kOrbSlam3),
                                  std::string(kOrbSlam2)}) {
    const Calibration c = ParseCamera(text, "rig.yaml");
    EXPECT_EQ(c.left, expected.left) << text;
    EXPECT_EQ(c.right, expected.right) << text;
    EXPECT_LT(LogSe3(c.right_from_left * Inverse(expected.right_from_left)).norm(), 1e-6) << text;
    EXPECT_FALSE(c.rectified);
    EXPECT_FALSE(c.depth_factor);
  }
}

TEST(ParseCamera, ASensorOfEurocIsOneCamera) {
  const Calibration c = ParseCamera(
      "T_BS: {rows: 4, cols: 4, data: [1,0,0,2, 0,1,0,0, 0,0,1,0, 0,0,0,1]}\n"
      "camera_model: pinhole\nrate_hz: 20\nresolution: [752, 480]\nintrinsics: [450, 460, 7, 8]\n"
      "distortion_model: radial-tangential\ndistortion_coefficients: [0.1, 0.2, 0, 0]\n",
      "sensor.yaml");
  EXPECT_EQ(c.left.intrinsics().fy, 460);
  EXPECT_EQ(c.body_from_left->translation.x(), 2);
  EXPECT_EQ(c.rate_hz, 20);
  EXPECT_FALSE(c.right);
}

TEST(ParseCamera, AKittiCalibrationIsNamedAsOne) {
  EXPECT_EQ(MessageOf([] { ParseCamera("P0: 1 0 0\nP1: 1 0 0\n", "calib.txt"); }),
            "calib.txt:1: P0: expected a camera file, found a KITTI calib.txt; it is read with the "
            "images of its folder, as it has no image size");
}

TEST(FindCamera, KnowsTheBuiltInCameras) {
  EXPECT_THAT(BuiltInCameras(),
              ElementsAre("euroc",
                          "icl_nuim",
                          "kitti_00",
                          "kitti_03",
                          "kitti_04",
                          "tum_fr1",
                          "tum_fr2",
                          "tum_fr3",
                          "tum_vi_512"));
  for (const std::string& name : BuiltInCameras()) {
    const auto [c, source] = FindCamera(name);
    const bool rgbd = name.starts_with("tum_fr") || name == "icl_nuim";
    EXPECT_TRUE(c.rate_hz) << name;
    EXPECT_EQ(c.depth_factor, rgbd ? std::optional(5000.0) : std::nullopt) << name;
    EXPECT_EQ(c.right.has_value(), !rgbd) << name;
    EXPECT_EQ(c.rectified, name.starts_with("kitti")) << name;
    EXPECT_EQ(source, name + " (built-in camera)");
  }
  EXPECT_EQ(FindCamera("tum_fr1").calibration.left.intrinsics().fx, 517.306408);
  EXPECT_EQ(FindCamera("icl_nuim").calibration.left.intrinsics().fy, 480);
  EXPECT_THAT(
      MessageOf([] { FindCamera("tum_fr4"); }),
      HasSubstr("tum_fr4: no such camera file; built-in cameras: euroc, icl_nuim, kitti_00"));
}

// Data are often in a folder that has the name of their camera.
TEST(FindCamera, AFolderHidesNoBuiltInCamera) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder / "euroc");
  std::filesystem::create_directories(folder / "none");
  folder.Write("tum_fr1", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\n");
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  EXPECT_EQ(MessageOf([] { EXPECT_EQ(FindCamera("euroc").source, "euroc (built-in camera)"); }),
            "no error");
  EXPECT_EQ(FindCamera("tum_fr1").calibration.left.intrinsics().fx, 5);
  EXPECT_THAT(MessageOf([] { FindCamera("none"); }), HasSubstr("none: "));
  std::filesystem::current_path(before);
}

// The right camera lies within a few degrees and millimetres of the left camera's x axis.
TEST(FindCamera, BuiltInPairsStandSideBySide) {
  for (const char* name : {"euroc", "kitti_00", "kitti_03", "kitti_04", "tum_vi_512"}) {
    const Rigid3 motion = FindCamera(name).calibration.right_from_left;
    const double baseline = motion.translation.norm();
    EXPECT_GT(-motion.translation.x() / baseline, 0.999) << name;
    EXPECT_NEAR(baseline, std::string_view(name).starts_with("kitti") ? 0.5372 : 0.105, 0.006);
    EXPECT_LT(AngularDistance(motion.rotation, Eigen::Quaterniond::Identity()), 0.05) << name;
  }
}

TEST(FindCamera, BuiltInNumbersAreThoseOfTheData) {
  struct Case {
    const char* name;
    const char* data;
  };
  for (const Case& c :
       {Case{"euroc", "euroc/MH_01_easy_first250"}, {"kitti_04", "kitti/06_first51"}}) {
    const auto folder = FindData(c.data);
    if (!folder) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
    const Calibration expected = OpenDataset(*folder)->calibration();
    const Calibration found = FindCamera(c.name).calibration;
    EXPECT_EQ(found.left, expected.left) << c.name;
    EXPECT_EQ(found.right, expected.right) << c.name;
    EXPECT_EQ(found.rectified, expected.rectified) << c.name;
    EXPECT_LT(LogSe3(found.right_from_left * Inverse(expected.right_from_left)).norm(), 1e-12);
    EXPECT_EQ(found.body_from_left.has_value(), expected.body_from_left.has_value());
    if (!found.body_from_left) continue;
    EXPECT_EQ(found.rate_hz, expected.rate_hz) << c.name;
    EXPECT_LT(LogSe3(*found.body_from_left * Inverse(*expected.body_from_left)).norm(), 1e-12);
  }
}

TEST(FormatCamera, WritesEveryModel) {
  for (const DistortionForm& form : kDistortionForms) {
    CameraIntrinsics in{.fx = 300, .fy = 301, .cx = 320, .cy = 240, .width = 640, .height = 480};
    in.model = form.model;
    // Numbers that are valid for every model.
    for (std::size_t i = 0; i < form.most; ++i)
      in.distortion[i] = 0.1 + 0.01 * static_cast<double>(i);
    Calibration calibration;
    calibration.left = Camera(in);
    const std::string text = FormatCamera(calibration);
    EXPECT_EQ(ParseCamera(text, "c.yaml").left.intrinsics(), in) << text;
  }
  EXPECT_EQ(MessageOf([] {
              ParseCamera(
                  std::string(kMono) + "distortion: eucm\ndistortion_coefficients: [0.5, -1]\n",
                  "c.yaml");
            }),
            "c.yaml:5: distortion_coefficients: eucm: expected beta above 0, found -1");
}

TEST(FindCamera, ReadsAFileAndTellsItsFormat) {
  const ScratchFolder folder;
  const std::string ours = folder.Write("my.yaml", kMono).string();
  const std::string kalibr = folder.Write("camchain.yaml", kKalibr).string();
  EXPECT_EQ(FindCamera(ours).calibration.left.intrinsics().fx, 500);
  EXPECT_EQ(FindCamera(ours).source, ours + " (Plumbline camera file)");
  EXPECT_EQ(FindCamera(kalibr).source, kalibr + " (Kalibr camchain)");
}

TEST(CameraFileIn, PrefersOurName) {
  const ScratchFolder folder;
  EXPECT_FALSE(CameraFileIn(folder.path()));
  folder.Write("camchain.yaml", kKalibr);
  EXPECT_EQ(CameraFileIn(folder.path()), folder / "camchain.yaml");
  folder.Write("camera.yaml", kMono);
  EXPECT_EQ(CameraFileIn(folder.path()), folder / "camera.yaml");
}

}  // namespace
}  // namespace plumbline
