// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"
#include "plumbline/image/opencv_modules.h"
#include "plumbline/io/datasets/raw_pixels.h"
#include "plumbline/io/live/call_or_abandon.h"
#include "plumbline/io/live/capture_devices.h"
#include "plumbline/io/live/open_live_source.h"

#include <chrono>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>

namespace plumbline {
namespace {

// A device that is gone is opened again, every kReopenEvery, for kReopenFor.
constexpr std::chrono::seconds kReopenFor(10);
constexpr std::chrono::milliseconds kReopenEvery(500);
constexpr std::int64_t kAfterLossNs = 1'000'000;  // time from the last frame to the missing one

// Returns the image of a camera: half of the delivered image if that shows both cameras.
cv::Mat ImageOf(const CapturedImages& taken, int camera, bool side_by_side) {
  if (!side_by_side) return taken.images[static_cast<std::size_t>(camera)];
  const cv::Mat& both = taken.images[0];
  const int width = both.cols / 2;
  return both.empty() ? both : both(cv::Rect(camera * width, 0, width, both.rows));
}

// Description of an open source.
struct Opened {
  CaptureDevices devices;
  std::optional<CapturedImages> first;
};

// Opens a source within a time limit: GStreamer waits for ever for a pipeline that cannot start.
Opened OpenPatiently(const std::string& name,
                     LiveKind kind,
                     const std::vector<ImageSize>& sizes,
                     std::chrono::milliseconds patience) {
  LoadOpenCvModules();  // loaded here, since the program may end while that thread goes on
  const auto end = std::chrono::steady_clock::now() + patience;
  auto opened = CallOrAbandon<Opened>(
      [name, kind, sizes] {
        CaptureDevices devices(name, kind, sizes);
        std::optional<CapturedImages> first = devices.Take();
        return Opened{std::move(devices), std::move(first)};
      },
      [end] { return std::chrono::steady_clock::now() < end; });
  if (opened) return *std::move(opened);
  throw InputError(fmt::format(
      "{}: expected a first frame within {} s, found none{}",
      Printable(WithoutPassword(name), kLongestMessage),
      static_cast<double>(patience.count()) / 1000,
      kind == LiveKind::kGstreamer ? "; gst-launch-1.0 tells whether all elements are there" : ""));
}

void CheckSizes(const CapturedImages& first, bool side_by_side, const DatasetInfo& info) {
  const auto check = [&](int camera, const Camera& wanted) {
    const cv::Mat image = ImageOf(first, camera, side_by_side);
    if (!image.empty()) CheckLiveSize(info.name, {image.cols, image.rows}, wanted);
  };
  check(0, info.calibration.left);
  if (info.calibration.right) check(1, *info.calibration.right);
}

Expected<GrayImage, ImageFailure> GrayOf(const cv::Mat& image, ImageSize wanted) {
  if (image.empty()) return ImageFailure{"", "no image came"};
  const bool color = image.type() == CV_8UC3;
  if (!color && image.type() != CV_8UC1) {
    return ImageFailure{"",
                        fmt::format("expected 1 or 3 channels of 8 bits, found {} of {} bits",
                                    image.channels(),
                                    8 * image.elemSize1())};
  }
  const RawPixels pixels{color ? "bgr8" : "mono8",
                         static_cast<std::uint32_t>(image.cols),
                         static_cast<std::uint32_t>(image.rows),
                         static_cast<std::uint32_t>(image.step),
                         false,
                         {image.data, static_cast<std::size_t>(image.dataend - image.data)}};
  return GrayOfPixels("", pixels, wanted);
}

class CaptureSource : public LiveSource {
 public:
  CaptureSource(DatasetInfo info, Opened opened, bool side_by_side)
      : LiveSource(std::move(info)),
        devices_(std::move(opened.devices)),
        side_by_side_(side_by_side),
        first_(std::move(opened.first)) {}

  LiveEvent Next() override {
    std::optional<CapturedImages> taken = lost_    ? TakeAgain()
                                          : first_ ? std::exchange(first_, std::nullopt)
                                                   : devices_.Take();
    if (!taken && !lost_ && devices_.MayComeBack()) {
      lost_ = true;
      return MissingFrame{
          last_ns_ + kAfterLossNs,
          "source_lost",
          fmt::format("no more frames come; it is opened again for {} s", kReopenFor.count())};
    }
    if (!taken) {
      return SourceEnd{info().name +
                       ": no more frames: the stream has ended, or the device is gone"};
    }
    lost_ = false;
    last_ns_ = taken->stamp_ns;
    return FrameOf(*taken);
  }

 private:
  static ImageSize SizeOf(const Camera& camera) { return {camera.width(), camera.height()}; }

  // Returns the first frame of a device that came back; nullopt if it does not come back in time.
  std::optional<CapturedImages> TakeAgain() {
    const auto end = std::chrono::steady_clock::now() + kReopenFor;
    do {
      std::this_thread::sleep_for(kReopenEvery);
      if (!devices_.Open()) continue;
      if (auto taken = devices_.Take()) return taken;
    } while (std::chrono::steady_clock::now() < end);
    return std::nullopt;
  }

  LiveEvent FrameOf(const CapturedImages& taken) const {
    SensorFrame frame;
    frame.stamp_ns = taken.stamp_ns;
    const Calibration& calibration = info().calibration;
    const auto left = GrayOf(ImageOf(taken, 0, side_by_side_), SizeOf(calibration.left));
    if (!left) return Missing(frame.stamp_ns, left.error());
    frame.left = *left;
    if (calibration.right) {
      const auto right = GrayOf(ImageOf(taken, 1, side_by_side_), SizeOf(*calibration.right));
      if (!right) return Missing(frame.stamp_ns, right.error());
      frame.right = *right;
    }
    return frame;
  }

  static LiveEvent Missing(std::int64_t stamp_ns, const ImageFailure& failure) {
    return MissingFrame{stamp_ns, failure.reason(), failure.why};
  }

  CaptureDevices devices_;
  bool side_by_side_;
  std::optional<CapturedImages> first_;
  bool lost_ = false;
  std::int64_t last_ns_ = 0;  // stamp of the last frame
};

}  // namespace

std::unique_ptr<LiveSource> OpenCapture(const std::string& name,
                                        LiveKind kind,
                                        const LiveOptions& options) {
  const std::size_t count = CapturesOf(name, kind).size();
  const bool two = count == 2;
  if (two && options.side_by_side) {
    throw InputError("--side-by-side: expected one camera whose images are of both, found two");
  }
  std::vector<SensorKind> available = {SensorKind::kMono};
  if (two || options.side_by_side) available.insert(available.begin(), SensorKind::kStereo);
  const std::string shown = Printable(WithoutPassword(name), kLongestMessage);
  DatasetInfo info = DescribeLive(shown, std::move(available), options);
  if (two) {
    info.notes.emplace_back(
        "the cameras are read one after the other: only a trigger outside makes them a pair");
  }
  const auto sizes = DeviceSizes(info.calibration, options.side_by_side);
  Opened opened = OpenPatiently(name, kind, sizes, options.patience);
  if (!opened.first) throw InputError(shown + ": expected frames, found none");
  CheckSizes(*opened.first, options.side_by_side, info);
  return std::make_unique<CaptureSource>(std::move(info), std::move(opened), options.side_by_side);
}

}  // namespace plumbline
