// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/live/capture_source.h"

#include "plumbline/base/printable.h"
#include "plumbline/image/opencv_modules.h"
#include "plumbline/io/decoder_messages.h"
#include "plumbline/io/raw_pixels.h"
#include "plumbline/live/live_camera.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <system_error>
#include <thread>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

namespace plumbline {
namespace {

constexpr int kTimeoutMs = 10'000;
// A device that is gone is opened again, every kReopenEvery, for kReopenFor.
constexpr std::chrono::seconds kReopenFor(10);
constexpr std::chrono::milliseconds kReopenEvery(500);
constexpr std::int64_t kAfterLossNs = 1'000'000;  // time from the last frame to the missing one
constexpr int kHighestNumber = 999;               // highest number of a device

std::optional<int> DeviceNumber(const std::string& device) {
  int number = 0;
  const auto [end, error] = std::from_chars(device.data(), device.data() + device.size(), number);
  const bool whole = error == std::errc() && end == device.data() + device.size();
  return whole && number >= 0 && number <= kHighestNumber ? std::optional(number) : std::nullopt;
}

bool OpenDevice(VideoCapture& capture, const std::string& device) {
  if (const auto number = DeviceNumber(device)) return capture.Open(*number, cv::CAP_V4L2);
  return capture.Open(device, cv::CAP_V4L2);
}

bool OpenAs(LiveKind kind, VideoCapture& capture, const std::string& what) {
  const DecoderCall call;
  try {
    switch (kind) {
      case LiveKind::kCamera:
        return OpenDevice(capture, what);
      case LiveKind::kNetwork:
        return capture.Open(what,
                            cv::CAP_FFMPEG,
                            {cv::CAP_PROP_OPEN_TIMEOUT_MSEC,
                             kTimeoutMs,
                             cv::CAP_PROP_READ_TIMEOUT_MSEC,
                             kTimeoutMs});
      case LiveKind::kGstreamer:
        return capture.Open(what, cv::CAP_GSTREAMER);
      case LiveKind::kStandardInput:
        break;
    }
  } catch (const cv::Exception&) {
    return false;
  }
  throw BugError("a source that is not captured");
}

std::vector<std::string> PartsOf(const std::string& name, LiveKind kind) {
  if (kind == LiveKind::kCamera) return CameraDevices(name);
  if (kind == LiveKind::kGstreamer) return {GstreamerPipeline(name)};
  return {name};
}

// The times of frames; see OpenCapture.
class FrameClock {
 public:
  // Returns the stamp of a frame. device_ms: its time by the driver's clock; 0 or less if that has
  // none.
  std::int64_t StampOf(double device_ms) {
    const auto now = std::chrono::steady_clock::now();
    if (!start_) {
      start_ = now;
      first_device_ms_ = device_ms;
      const auto time = std::chrono::system_clock::now().time_since_epoch();
      first_ns_ = std::chrono::duration_cast<std::chrono::nanoseconds>(time).count();
    }
    if (first_device_ms_ > 0 && device_ms > 0) {
      return first_ns_ + std::llround(1e6 * (device_ms - first_device_ms_));
    }
    return first_ns_ + std::chrono::duration_cast<std::chrono::nanoseconds>(now - *start_).count();
  }

 private:
  std::optional<std::chrono::steady_clock::time_point> start_;
  std::int64_t first_ns_ = 0;
  double first_device_ms_ = 0;
};

// The images of one instant as the devices deliver them.
struct Taken {
  std::int64_t stamp_ns = 0;
  std::vector<cv::Mat> images;  // an image that could not be read is empty
};

class CaptureDevices {
 public:
  CaptureDevices(const std::string& name, LiveKind kind)
      : kind_(kind), parts_(PartsOf(name, kind)) {
    if (Open()) return;
    throw InputError(fmt::format("{}: expected {}, found none that can be opened",
                                 Printable(WithoutPassword(name), kLongestMessage),
                                 kind == LiveKind::kCamera      ? "a camera"
                                 : kind == LiveKind::kGstreamer ? "a GStreamer pipeline"
                                                                : "a stream"));
  }

  // Opens all devices, for the first time or again; returns false where one of them cannot be
  // opened.
  bool Open() {
    captures_.clear();
    for (const std::string& part : parts_) {
      captures_.push_back(LoadOpenCvModules().NewVideoCapture());
      if (!OpenAs(kind_, *captures_.back(), part)) return false;
    }
    return true;
  }

  // A camera or a stream may come back; a pipeline that has ended does not.
  bool MayComeBack() const { return kind_ != LiveKind::kGstreamer; }

  // Returns nullopt when there are no more images.
  std::optional<Taken> Take() {
    const DecoderCall call;
    Taken taken;
    try {
      for (const auto& capture : captures_) {
        if (!capture->Grab()) return std::nullopt;
        if (&capture != captures_.data()) continue;
        const bool camera = kind_ == LiveKind::kCamera;
        taken.stamp_ns = clock_.StampOf(camera ? capture->Get(cv::CAP_PROP_POS_MSEC) : 0);
      }
      for (const auto& capture : captures_) {
        taken.images.emplace_back();
        if (!capture->Retrieve(taken.images.back())) taken.images.back().release();
      }
    } catch (const cv::Exception&) {
      return std::nullopt;
    }
    return taken;
  }

 private:
  LiveKind kind_;
  std::vector<std::string> parts_;  // names of what is opened
  std::vector<std::unique_ptr<VideoCapture>> captures_;
  FrameClock clock_;
};

// Returns the image of a camera, which is a half of it where one image has those of both.
cv::Mat ImageOf(const Taken& taken, int camera, bool side_by_side) {
  if (!side_by_side) return taken.images[static_cast<std::size_t>(camera)];
  const cv::Mat& both = taken.images[0];
  const int width = both.cols / 2;
  return both.empty() ? both : both(cv::Rect(camera * width, 0, width, both.rows));
}

// What is known when a source is open.
struct Opened {
  CaptureDevices devices;
  std::optional<Taken> first;
};

// Opens a source within a time limit. GStreamer waits for ever for a pipeline that cannot start, so
// that a thread opens it, which may be left behind.
Opened OpenPatiently(const std::string& name, LiveKind kind, std::chrono::milliseconds patience) {
  LoadOpenCvModules();  // loaded here, since the program may end while that thread goes on
  std::packaged_task<Opened()> open([name, kind] {
    CaptureDevices devices(name, kind);
    std::optional<Taken> first = devices.Take();
    return Opened{std::move(devices), std::move(first)};
  });
  std::future<Opened> opened = open.get_future();
  std::thread(std::move(open)).detach();
  if (opened.wait_for(patience) == std::future_status::ready) return opened.get();
  throw InputError(fmt::format(
      "{}: expected a first frame within {} s, found none{}",
      Printable(WithoutPassword(name), kLongestMessage),
      static_cast<double>(patience.count()) / 1000,
      kind == LiveKind::kGstreamer ? "; gst-launch-1.0 tells whether all elements are there" : ""));
}

void CheckSizes(const Taken& first, bool side_by_side, const DatasetInfo& info) {
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
  if (!color && image.type() != CV_8UC1) return ImageFailure{"", "expected 8 bits a colour"};
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
    std::optional<Taken> taken = lost_    ? TakeAgain()
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

  // Returns the first frame of a device that came back; nullopt where it does not come back in
  // time.
  std::optional<Taken> TakeAgain() {
    const auto end = std::chrono::steady_clock::now() + kReopenFor;
    do {
      std::this_thread::sleep_for(kReopenEvery);
      if (!devices_.Open()) continue;
      if (auto taken = devices_.Take()) return taken;
    } while (std::chrono::steady_clock::now() < end);
    return std::nullopt;
  }

  LiveEvent FrameOf(const Taken& taken) const {
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
    return MissingFrame{
        stamp_ns, failure.other_size ? "image_size" : "image_unreadable", failure.why};
  }

  CaptureDevices devices_;
  bool side_by_side_;
  std::optional<Taken> first_;
  bool lost_ = false;
  std::int64_t last_ns_ = 0;  // stamp of the last frame
};

}  // namespace

std::vector<std::string> CameraDevices(const std::string& name) {
  std::vector<std::string> devices;
  std::string rest = name.substr(name.find(':') + 1);
  while (true) {
    const std::size_t comma = rest.find(',');
    devices.push_back(rest.substr(0, comma));
    if (comma == std::string::npos) break;
    rest = rest.substr(comma + 1);
  }
  const bool good = std::all_of(devices.begin(), devices.end(), [](const std::string& device) {
    return device.starts_with('/') || DeviceNumber(device).has_value();
  });
  if (good && devices.size() <= 2) return devices;
  throw InputError("expected camera:N or camera:N,M with numbers or paths of devices, found " +
                   InQuotes(name));
}

std::string GstreamerPipeline(const std::string& name) {
  std::string pipeline = name.substr(name.find(':') + 1);
  if (pipeline.find("appsink") == std::string::npos) pipeline += " ! videoconvert ! appsink";
  return pipeline;
}

std::unique_ptr<LiveSource> OpenCapture(const std::string& name,
                                        LiveKind kind,
                                        const LiveOptions& options) {
  const std::size_t count = PartsOf(name, kind).size();
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
  Opened opened = OpenPatiently(name, kind, options.patience);
  if (!opened.first) throw InputError(shown + ": expected frames, found none");
  CheckSizes(*opened.first, options.side_by_side, info);
  return std::make_unique<CaptureSource>(std::move(info), std::move(opened), options.side_by_side);
}

}  // namespace plumbline
