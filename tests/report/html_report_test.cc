// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/html_report.h"

#include "plumbline/base/base64.h"
#include "plumbline/base/options_io.h"
#include "plumbline/io/datasets/image_file.h"
#include "plumbline/report/sample_image.h"
#include "plumbline/slam/atlas_context.h"

#include "tests/io/scratch_folder.h"
#include "tests/report/poster_run.h"
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <regex>
#include <span>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using testing::HasSubstr;
using testing::Not;

// What a browser hands to the scripts as the data of the page.
nlohmann::json DataOf(const std::string& page) {
  const std::string open = "<script id=\"run-data\" type=\"application/json\">";
  const std::size_t begin = page.find(open) + open.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

std::string Decode(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : base64) {
    const std::size_t value = digits.find(c);
    if (value == std::string::npos) break;
    bits = bits << 6 | static_cast<unsigned>(value);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes += static_cast<char>(bits >> count & 255U);
    }
  }
  return bytes;
}

std::vector<float> FloatsOf(const nlohmann::json& base64) {
  const std::string bytes = Decode(base64.get<std::string>());
  std::vector<float> values(bytes.size() / sizeof(float));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

std::string OptionsYaml(SlamOptions options = {}) { return OptionTable(options).Dump(); }

ReportContext ContextOf(const PosterRun& run) {
  return {
      {"0.1.0", "some/folder", OptionsYaml(), 3, {"some/folder", "--quiet"}},
      {.wall_seconds = 1.5, .first_pose_seconds = 0.5, .cpu_seconds = 2.5, .peak_memory_mb = 30},
      "2026-01-02 03:04 UTC",
      {run.sample()}};
}

TEST(Base64, EncodesEveryLengthAsTheStandardSays) {
  // RFC 4648, section 10.
  EXPECT_EQ(EncodeBase64(""), "");
  EXPECT_EQ(EncodeBase64("f"), "Zg==");
  EXPECT_EQ(EncodeBase64("fo"), "Zm8=");
  EXPECT_EQ(EncodeBase64("foo"), "Zm9v");
  EXPECT_EQ(EncodeBase64("foob"), "Zm9vYg==");
  EXPECT_EQ(EncodeBase64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(EncodeBase64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(EncodeBase64("\xff\xfe\xfd"), "//79");
}

TEST(HtmlReport, SaysWhatInterruptedTheRun) {
  const PosterRun run;
  ReportContext context = ContextOf(run);
  context.description.frames_chosen = 6;
  const auto whole = DataOf(FormatHtmlReport(run.result(), PosterDataset(6), context));
  EXPECT_TRUE(whole["run"]["interrupted"].is_null());
  context.description.interrupted = "SIGHUP";
  context.description.frames_chosen = 50;
  const std::string page = FormatHtmlReport(run.result(), PosterDataset(6), context);
  EXPECT_EQ(DataOf(page)["run"]["interrupted"], "SIGHUP");
  EXPECT_EQ(DataOf(page)["run"]["frames_chosen"], 50);
  EXPECT_THAT(page, HasSubstr("Interrupted by ${interrupted}"));
  EXPECT_THAT(page, HasSubstr("after the last frame. Poses of frames before the map"));
}

TEST(HtmlReport, HoldsTheWholeRun) {
  const PosterRun run;
  const auto json = DataOf(FormatHtmlReport(run.result(), PosterDataset(6), ContextOf(run)));
  EXPECT_EQ(json["run"]["date"], "2026-01-02 03:04 UTC");
  EXPECT_EQ(json["run"]["command"], "plumbline run some/folder --quiet");
  EXPECT_EQ(json["run"]["peak_memory_mb"], 30);
  EXPECT_EQ(json["counts"]["frames"], 6);
  EXPECT_EQ(json["counts"]["tracked"], 4);
  const auto& frames = json["frames"];
  for (const auto& [name, column] : frames.items()) EXPECT_EQ(column.size(), 6U) << name;
  EXPECT_EQ(json["shown_every"], 1);
  EXPECT_EQ(frames["number"], nlohmann::json({0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(frames["state"],
            nlohmann::json({"tracked", "tracked", "skipped", "tracked", "lost", "tracked"}));
  EXPECT_NEAR(frames["seconds"][5], 0.25, 1e-9);
  EXPECT_EQ(frames["reason"][2], "image_unreadable");
  EXPECT_TRUE(frames["map"][2].is_null());
  for (const auto& stage : json["stages"]) {
    EXPECT_EQ(stage["milliseconds"].size(), 6U) << stage["name"];
    EXPECT_TRUE(stage["milliseconds"][2].is_null());
  }
}

// Where a run is longer than a page can show, the page names frames by their rows, and its figures
// count all frames.
TEST(HtmlReport, ShowsEveryNthFrameOfALongRun) {
  const PosterRun run;
  ReportContext context = ContextOf(run);
  context.most_frames = 1;
  const std::string page = FormatHtmlReport(run.result(), PosterDataset(6), context);
  const auto json = DataOf(page);
  EXPECT_EQ(json["shown_every"], 6);
  // The first and the last, those around a change of state, and that of the image.
  EXPECT_EQ(json["frames"]["number"], nlohmann::json({0, 1, 2, 3, 5}));
  EXPECT_EQ(json["frames"]["state"],
            nlohmann::json({"tracked", "tracked", "skipped", "tracked", "tracked"}));
  for (const auto& [name, column] : json["frames"].items()) EXPECT_EQ(column.size(), 5U) << name;
  for (const auto& stage : json["stages"]) EXPECT_EQ(stage["milliseconds"].size(), 5U);
  EXPECT_EQ(json["counts"]["frames"], 6);
  EXPECT_EQ(json["counts"]["lost"], 1);
  const auto& map = json["scene"]["maps"][0];
  EXPECT_EQ(map["pose_count"], 4);
  EXPECT_EQ(map["frames"], nlohmann::json({0, 1, 3, 4}));
  EXPECT_EQ(map["error"]["frames"], map["frames"]);
  EXPECT_EQ(FloatsOf(map["positions"]).size(), 12U);
  EXPECT_EQ(json["samples"][0]["frame"], 3);
  EXPECT_THAT(page, HasSubstr("are shown one by one: one in ${whole(every)}"));

  context.samples.clear();
  const auto fewer = DataOf(FormatHtmlReport(run.result(), PosterDataset(6), context));
  EXPECT_EQ(fewer["frames"]["number"], nlohmann::json({0, 1, 2, 5}));
  EXPECT_EQ(fewer["scene"]["maps"][0]["frames"], nlohmann::json({0, 1, 3}));
  EXPECT_EQ(fewer["scene"]["maps"][0]["pose_count"], 4);
  EXPECT_EQ(FloatsOf(fewer["scene"]["maps"][0]["positions"]).size(), 9U);
  EXPECT_EQ(fewer["scene"]["maps"][0]["error"]["position"].size(), 3U);
}

TEST(HtmlReport, HoldsTheMapRelativeToItsOrigin) {
  const PosterRun run;
  const auto json = DataOf(FormatHtmlReport(run.result(), PosterDataset(6), ContextOf(run)));
  const auto& scene = json["scene"];
  ASSERT_EQ(scene["maps"].size(), 1U);
  EXPECT_EQ(scene["main"], 0);
  const auto& map = scene["maps"][0];
  EXPECT_EQ(map["frames"], nlohmann::json({0, 1, 3, 5}));
  EXPECT_EQ(FloatsOf(map["points"]).size(), 3U * map["point_count"].get<std::size_t>());
  EXPECT_EQ(FloatsOf(map["lines"]).size(), 6U * map["line_count"].get<std::size_t>());
  EXPECT_EQ(FloatsOf(map["keyframes"]).size(), 7U * map["keyframe_frames"].size());
  EXPECT_EQ(map["point_count"], json["counts"]["points"]);
  EXPECT_EQ(map["keyframe_count"], json["counts"]["keyframes"]);
  const auto positions = FloatsOf(map["positions"]);
  ASSERT_EQ(positions.size(), 12U);
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(positions[static_cast<std::size_t>(axis)], 0);
  EXPECT_NEAR(positions[9] + scene["origin"][0].get<double>(), 5 * MovingPoster::kStep, 0.01);
  EXPECT_EQ(FloatsOf(scene["reference"]).size(), 18U);
  EXPECT_EQ(map["error"]["frames"], map["frames"]);
  EXPECT_EQ(map["error"]["position"].size(), 4U);
  EXPECT_LT(map["error"]["ate"]["rmse"], 0.01);
}

TEST(HtmlReport, CountsTheKeyframesOfEarlierRunsInTheMapOfTwo) {
  SlamOptions options;
  options.slam.mode = RunMode::kInline;
  const MovingPoster poster;
  System first(MovingPoster::MakeCalibration(), options);
  for (int i = 0; i < 40; ++i) first.Process(poster.Frame(i));
  const RunResult made = first.Finish();
  System second(MovingPoster::MakeCalibration(), options);
  second.Continue({made.atlas, made.context}, true);
  for (int i = 10; i < 20; ++i) second.Process(poster.Frame(i));
  const RunResult result = second.Finish();
  const std::string page = FormatHtmlReport(result, PosterDataset(20), {});
  const auto json = DataOf(page);
  const auto& map = json["scene"]["maps"][0];
  EXPECT_EQ(map["keyframe_count"], made.atlas.maps().begin()->second.keyframes().size());
  EXPECT_EQ(map["keyframe_count"], json["counts"]["keyframes"]);
  EXPECT_TRUE(map["keyframe_frames"].empty());
  EXPECT_THAT(page, HasSubstr("plural(map.keyframe_count, \"keyframe\")"));
}

TEST(HtmlReport, TellsOfPlacesThatWereSeenAgain) {
  const PosterRun run;
  const auto plain = DataOf(FormatHtmlReport(run.result(), PosterDataset(6), ContextOf(run)));
  EXPECT_EQ(plain["scene"]["events"], nlohmann::json::array());

  // A camera that begins in a saved map is found by what it sees.
  System second(MovingPoster::MakeCalibration(), {});
  second.Continue({run.result().atlas, run.result().context}, false);
  for (int i = 0; i < 6; ++i) second.Process(MovingPoster().Frame(i));
  const RunResult result = second.Finish();
  const std::string page = FormatHtmlReport(result, PosterDataset(6), ContextOf(run));
  const auto events = DataOf(page)["scene"]["events"];
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0]["kind"], "relocalization");
  EXPECT_LE(events[0]["frame"], 4);
  EXPECT_EQ(events[0]["map"], 0);
  EXPECT_GT(events[0]["points"], 20);
  EXPECT_EQ(events[0]["older_at"].size(), 3U);
  EXPECT_FALSE(events[0].contains("moved"));
  EXPECT_THAT(page, HasSubstr("function buildEvents()"));
  EXPECT_THAT(page, HasSubstr("--loop:"));
}

TEST(HtmlReport, TellsTheOptionsThatDifferFromTheDefaults) {
  SlamOptions options;
  options.slam.lag = 3;
  System system(MovingPoster::MakeCalibration(), options);
  const auto json = DataOf(FormatHtmlReport(system.Finish(), PosterDataset(6), {}));
  std::vector<std::string> different;
  for (const auto& option : json["run"]["options"]) {
    if (option["value"] != option["default"]) different.push_back(option["key"]);
    EXPECT_NE(option["help"], "") << option["key"];
  }
  EXPECT_THAT(different, testing::ElementsAre("slam.lag"));
}

TEST(HtmlReport, NamesThePresetAboveTheOptions) {
  const PosterRun run;
  ReportContext context = ContextOf(run);
  EXPECT_TRUE(
      DataOf(FormatHtmlReport(run.result(), PosterDataset(6), context))["run"]["preset"].is_null());
  context.description.preset = "rippl";
  const std::string page = FormatHtmlReport(run.result(), PosterDataset(6), context);
  EXPECT_EQ(DataOf(page)["run"]["preset"], "rippl");
  EXPECT_THAT(page, HasSubstr("The options begin with those of the preset"));
}

TEST(HtmlReport, ShowsSampleImagesWithTheirFeatures) {
  const PosterRun run;
  const auto json = DataOf(FormatHtmlReport(run.result(), PosterDataset(6), ContextOf(run)));
  ASSERT_EQ(json["samples"].size(), 1U);
  const auto& sample = json["samples"][0];
  EXPECT_EQ(sample["frame"], 3);
  EXPECT_EQ(sample["file"], "overlay_000003.png");
  EXPECT_EQ(sample["width"], MovingPoster::kWidth);
  const std::string start = "data:image/jpeg;base64,";
  ASSERT_EQ(sample["image"].get<std::string>().substr(0, start.size()), start);
  EXPECT_EQ(Decode(sample["image"].get<std::string>().substr(start.size())).substr(0, 2),
            "\xff\xd8");
  const auto matched = FloatsOf(sample["matched_points"]);
  // Inliers of the frame before that are not in the map yet show no landmark.
  EXPECT_GT(matched.size(), 200);
  EXPECT_LE(matched.size(), 2U * json["frames"]["inlier_points"][3].get<std::size_t>());
  for (const float x : matched) {
    EXPECT_GE(x, 0);
    EXPECT_LE(x, MovingPoster::kWidth);
  }
}

TEST(HtmlReport, HasSamplesOfImagesThatAreVeryFlatOrVeryHigh) {
  struct Sizes {
    ImageSize image, sample;
  };
  for (const Sizes& sizes : {Sizes{{4000, 1}, {1280, 1}}, Sizes{{2, 66'000}, {2, 65'500}}}) {
    FrameView view;
    view.images.left = GrayImage(sizes.image.width, sizes.image.height, 77);
    view.frame.indexed = std::make_shared<const FrameFeatures>();
    const SampleImage sample = MakeSampleImage(view, "overlay_000000.png");
    EXPECT_EQ(sample.width, sizes.image.width);
    EXPECT_EQ(sample.height, sizes.image.height);
    const std::span jpeg(reinterpret_cast<const std::uint8_t*>(sample.jpeg.data()),
                         sample.jpeg.size());
    EXPECT_TRUE(SizeInHeader(jpeg) == sizes.sample);
  }
}

TEST(HtmlReport, EscapesNamesFromOutside) {
  const PosterRun run;
  const std::string hostile = "</script><script>alert('x')</script>&\"<!--{{TITLE}}{{DATA}}";
  ReportContext context = ContextOf(run);
  context.description.data_path = "/data/" + hostile;
  context.description.arguments = {hostile, "it's"};
  const PosterDataset dataset(6, true, hostile);
  const std::string page = FormatHtmlReport(run.result(), dataset, context);
  EXPECT_THAT(page, Not(HasSubstr("alert('x')</script>")));
  EXPECT_THAT(page, HasSubstr("<title>&lt;/script&gt;&lt;script&gt;alert(&#39;x&#39;)"));
  EXPECT_THAT(page, Not(HasSubstr("<!--{{")));
  const auto json = DataOf(page);
  EXPECT_EQ(json["run"]["name"], hostile);
  EXPECT_EQ(json["run"]["path"], "/data/" + hostile);
  EXPECT_THAT(json["run"]["command"].get<std::string>(), HasSubstr("'it'\\''s'"));
}

TEST(HtmlReport, RepairsNamesThatAreNotUtf8) {
  const PosterRun run;
  ReportContext context = ContextOf(run);
  context.description.data_path = "/data/\xff\xfe";
  const auto json = DataOf(FormatHtmlReport(run.result(), PosterDataset(6), context));
  EXPECT_EQ(json["run"]["path"], "/data/\uFFFD\uFFFD");
  EXPECT_NO_THROW(nlohmann::json::parse(
      FormatSummary(context.description, run.result(), PosterDataset(6), {})));
}

TEST(HtmlReport, NeedsNothingFromElsewhere) {
  const PosterRun run;
  const std::string page = FormatHtmlReport(run.result(), PosterDataset(6), ContextOf(run));
  for (const char* word : {"http:", "https:", "src=\"/", "@import", "url(", "fetch(", "{{"}) {
    EXPECT_THAT(page, Not(HasSubstr(word)));
  }
  // Style and scripts stand in the page itself.
  EXPECT_THAT(page, HasSubstr("--estimate:"));
  EXPECT_THAT(page, HasSubstr("class MapView"));
  EXPECT_THAT(page, HasSubstr("class Plot"));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
}

TEST(HtmlReport, HasScriptsThatParse) {
  if (std::system("node --version > /dev/null 2>&1") != 0) {  // NOLINT(concurrency-mt-unsafe)
    GTEST_SKIP() << "node is not installed";
  }
  const PosterRun run;
  const std::string page = FormatHtmlReport(run.result(), PosterDataset(6), ContextOf(run));
  const std::size_t begin = page.rfind("<script>") + 8;
  const ScratchFolder folder;
  const auto file =
      folder.Write("page.js", page.substr(begin, page.find("</script>", begin) - begin));
  const std::string command = "node --check '" + file.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);  // NOLINT(concurrency-mt-unsafe)
}

TEST(HtmlReport, SaysThatThereIsNoGroundTruth) {
  const PosterRun run;
  const auto json = DataOf(FormatHtmlReport(run.result(), PosterDataset(6, false), ContextOf(run)));
  EXPECT_EQ(json["scene"]["has_ground_truth"], false);
  EXPECT_TRUE(json["scene"]["maps"][0]["error"].is_null());
  EXPECT_EQ(json["scene"]["reference"], "");
  EXPECT_EQ(json["scene"]["up"], nlohmann::json({0, -1, 0}));
}

// Ground truth scales the map of one camera, so that its lengths are metres.
TEST(HtmlReport, LengthsOfOneCameraAreMetresOnlyBesideGroundTruth) {
  const PosterRun run;
  const auto metric = [&](SensorKind sensor, bool with_truth) -> bool {
    DatasetInfo info = PosterDataset(6, with_truth).info();
    info.sensor = sensor;
    const auto json = DataOf(FormatHtmlReport(run.result(), PosterDataset(info), ContextOf(run)));
    return json["scene"]["maps"][0]["metric"];
  };
  EXPECT_TRUE(metric(SensorKind::kStereo, false));
  EXPECT_TRUE(metric(SensorKind::kRgbd, false));
  EXPECT_FALSE(metric(SensorKind::kMono, false));
  EXPECT_TRUE(metric(SensorKind::kMono, true));
}

// What the pages write about lengths, by the functions that they share.
TEST(HtmlReport, WritesUnitsWhereLengthsAreNoMetres) {
  if (std::system("node --version > /dev/null 2>&1") != 0) {  // NOLINT(concurrency-mt-unsafe)
    GTEST_SKIP() << "node is not installed";
  }
  const PosterRun run;
  const std::string page = FormatHtmlReport(run.result(), PosterDataset(6), ContextOf(run));
  const std::size_t begin = page.find("// A number with `count` significant digits");
  const std::size_t end = page.find("// A value that tells its listeners", begin);
  ASSERT_NE(end, std::string::npos);
  const ScratchFolder folder;
  const auto file = folder.Write(
      "lengths.js",
      page.substr(begin, end - begin) +
          "const found = [lengthInMap(0.2, true), lengthInMap(0.02, true), lengthInMap(0.2, false),"
          " lengthInMap(0.02, false)].join('; ');\n"
          "process.exit(found === '0.200 m; 20.0 mm; 0.200 units; 0.0200 units' ? 0 : 1);\n");
  const std::string command = "node '" + file.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);  // NOLINT(concurrency-mt-unsafe)
  // No label has a metre of its own.
  for (const char* label : {"[m]`", " m.`", "+ \" m\""}) EXPECT_THAT(page, Not(HasSubstr(label)));
}

TEST(HtmlReport, IsMadeWithoutAnyFrame) {
  const RunResult result = System(MovingPoster::MakeCalibration(), {}).Finish();
  const auto json = DataOf(FormatHtmlReport(result, PosterDataset(6), {}));
  EXPECT_TRUE(json["scene"]["main"].is_null());
  EXPECT_TRUE(json["scene"]["maps"].empty());
  EXPECT_TRUE(json["stages"].empty());
  EXPECT_TRUE(json["samples"].empty());
  EXPECT_TRUE(json["frames"]["seconds"].empty());
}

TEST(HtmlReport, IsMadeForOneFrameAndWithoutLines) {
  SlamOptions options;
  options.features.lines = false;
  System system(MovingPoster::MakeCalibration(), options);
  system.Process(MovingPoster().Frame(0));
  const RunResult result = system.Finish();
  const auto json = DataOf(FormatHtmlReport(result, PosterDataset(6), {}));
  EXPECT_EQ(json["counts"]["lines"], 0);
  EXPECT_EQ(json["scene"]["maps"][0]["lines"], "");
  EXPECT_EQ(json["scene"]["maps"][0]["frames"], nlohmann::json({0}));
  EXPECT_TRUE(json["scene"]["maps"][0]["error"].is_null());  // three poses are needed
}

TEST(HtmlReport, IsWrittenWithTheDate) {
  const PosterRun run;
  const ScratchFolder folder;
  WriteHtmlReport(run.result(), PosterDataset(6), ContextOf(run), folder.path());
  const auto json = DataOf(Contents(folder / "report.html"));
  const std::string date = json["run"]["date"];
  EXPECT_TRUE(std::regex_match(date, std::regex(R"(20\d\d-\d\d-\d\d \d\d:\d\d UTC)"))) << date;
  EXPECT_NE(date, "2026-01-02 03:04 UTC");
  const std::string message = MessageOf(
      [&] { WriteHtmlReport(run.result(), PosterDataset(6), ContextOf(run), folder / "nowhere"); });
  EXPECT_THAT(message, HasSubstr("report.html"));
}

}  // namespace
}  // namespace plumbline
