// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/live/live_source.h"

#include "plumbline/io/live/open_live_source.h"

#include "tests/io/scratch_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

TEST(LiveKindOf, TellsSourcesFromPaths) {
  EXPECT_EQ(LiveKindOf("-"), LiveKind::kStandardInput);
  EXPECT_EQ(LiveKindOf("camera:0,1"), LiveKind::kCamera);
  EXPECT_EQ(LiveKindOf("rtsp://host/a"), LiveKind::kNetwork);
  EXPECT_EQ(LiveKindOf("rtsps://host/a"), LiveKind::kNetwork);
  EXPECT_EQ(LiveKindOf("gst:videotestsrc"), LiveKind::kGstreamer);
  for (const char* path : {"", "--", "data/-", "./camera:0", "camera", "http://host/a", "gst"}) {
    EXPECT_EQ(LiveKindOf(path), std::nullopt) << path;
  }
}

TEST(OpenLiveSource, SaysThatThereIsNone) {
  const LiveOptions options{.camera = "euroc"};
  EXPECT_THAT(MessageOf([&] { OpenLiveSource("camera:987", options); }),
              HasSubstr("camera:987: expected a camera, found none that can be opened"));
  EXPECT_THAT(MessageOf([&] { OpenLiveSource("rtsp://me:secret@127.0.0.1:1/a", options); }),
              HasSubstr("rtsp://me:***@127.0.0.1:1/a: expected a stream"));
  EXPECT_THAT(MessageOf([&] { OpenLiveSource("gst:filesrc location=/none", options); }),
              HasSubstr("expected a GStreamer pipeline, found none that can be opened"));
}

TEST(WithoutPassword, HidesIt) {
  EXPECT_EQ(WithoutPassword("rtsp://me:se:cr@et@host:554/a@b"), "rtsp://me:***@host:554/a@b");
  for (const char* name : {"rtsp://me@host/a", "rtsp://host:554/a", "camera:0", "a/b", ""}) {
    EXPECT_EQ(WithoutPassword(name), name);
  }
}

// A pipeline may have several, in URLs and in properties of its elements.
TEST(WithoutPassword, HidesAllOfAPipeline) {
  EXPECT_EQ(WithoutPassword("gst:rtspsrc location=rtsp://me:one@a/x ! b location=rtsp://me:two@c "
                            "! d uri=http://e:80/f name=g@h"),
            "gst:rtspsrc location=rtsp://me:***@a/x ! b location=rtsp://me:***@c "
            "! d uri=http://e:80/f name=g@h");
  EXPECT_EQ(WithoutPassword("gst:rtspsrc user-id=me user-pw=se!cret proxy-pw = \"a \\\" b\" ! c"),
            "gst:rtspsrc user-id=me user-pw=*** proxy-pw = *** ! c");
  EXPECT_EQ(WithoutPassword("gst:a passwd='x y' ! b password=z"),
            "gst:a passwd=*** ! b password=***");
  EXPECT_EQ(WithoutPassword("gst:a password= "), "gst:a password= ***");
  EXPECT_EQ(WithoutPassword("rtsp://me:se cret@host/a"), "rtsp://me:***@host/a");
}

TEST(PassedFrames, HaveNoImages) {
  DatasetInfo info;
  info.stamps_ns = {1, 2};
  const PassedFrames frames(info);
  EXPECT_EQ(frames.size(), 2U);
  EXPECT_FALSE(frames.Read(0));
}

}  // namespace
}  // namespace plumbline
