// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/io/datasets/image_dataset.h"
#include "plumbline/io/datasets/raw_pixels.h"
#include "plumbline/io/live/open_live_source.h"
#include "plumbline/io/text_rows.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <deque>
#include <span>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

namespace plumbline {
namespace {

constexpr const char* kName = "standard input";
constexpr std::string_view kFirstLine = "plumbline frames 1";
constexpr std::size_t kLongestLine = 256;
constexpr std::size_t kBufferBytes = 1 << 16;
constexpr double kMillimetres = 1000;
constexpr std::size_t kMostSamples = 60'000;  // of a frame: a minute at 1 kHz

// Reads bytes from a pipe as they come.
class PipeReader {
 public:
  explicit PipeReader(int descriptor) : descriptor_(descriptor), buffer_(kBufferBytes) {}

  // Reads the next line without its end. Returns false if the stream ends before the line does, or
  // the line is too long; `line` then has the bytes read.
  bool Line(std::string& line) {
    line.clear();
    while (line.size() < kLongestLine) {
      if (begin_ == end_ && !Fill()) return false;
      const char c = static_cast<char>(buffer_[begin_++]);
      if (c == '\n') return true;
      line += c;
    }
    return false;
  }

  // Returns false if the stream ends first.
  bool Bytes(std::vector<std::uint8_t>& bytes) {
    std::size_t filled = 0;
    while (filled < bytes.size()) {
      if (begin_ == end_ && !Fill()) return false;
      const std::size_t count = std::min(end_ - begin_, bytes.size() - filled);
      std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
                  count,
                  bytes.begin() + static_cast<std::ptrdiff_t>(filled));
      begin_ += count;
      filled += count;
    }
    return true;
  }

 private:
  bool Fill() {
    ssize_t count = 0;
    do {
      count = ::read(descriptor_, buffer_.data(), buffer_.size());
    } while (count < 0 && errno == EINTR);
    if (count < 0) {
      throw InputError(
          fmt::format("{}: cannot be read: {}", kName, std::generic_category().message(errno)));
    }
    begin_ = 0;
    end_ = static_cast<std::size_t>(count);
    return count > 0;
  }

  int descriptor_;
  std::vector<std::uint8_t> buffer_;
  std::size_t begin_ = 0, end_ = 0;
};

// One of the images of each frame, as the header describes it.
struct Plane {
  std::string encoding;
  std::uint32_t width = 0, height = 0;
  double factor = 0;  // for depth: value per metre; 0: not told

  std::uint32_t step() const { return width * static_cast<std::uint32_t>(PixelBytes(encoding)); }
  std::size_t bytes() const {
    return std::size_t{step()} *
           static_cast<std::size_t>(PixelRows(encoding, static_cast<int>(height)));
  }
  ImageSize size() const { return {static_cast<int>(width), static_cast<int>(height)}; }
  RawPixels Pixels(std::span<const std::uint8_t> data) const {
    return {encoding, width, height, step(), false, data};
  }
};

struct Header {
  // In the order in which their images come.
  std::vector<std::pair<std::string, Plane>> planes;
  bool imu = false;  // samples of an inertial sensor come between the frames

  const Plane* Find(std::string_view role) const {
    for (const auto& [name, plane] : planes) {
      if (name == role) return &plane;
    }
    return nullptr;
  }
};

[[noreturn]] void FailAtLine(int line, const std::string& expected, const std::string& found) {
  throw InputError(
      fmt::format("{}:{}: expected {}, found {}", kName, line, expected, InQuotes(found)));
}

std::vector<std::string> Words(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

template <class Number>
std::optional<Number> Parse(const std::string& word) {
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return number;
}

// Parses lines such as "left mono8 752 480" or "depth 16UC1 752 480 1000".
Plane ParsePlane(const std::vector<std::string>& words, int line, const std::string& text) {
  const bool depth = words[0] == "depth";
  const auto contents = words.size() > 1 ? ContentsOfEncoding(words[1]) : std::nullopt;
  const ImageContents wanted = depth ? ImageContents::kDepth : ImageContents::kGray;
  if (contents != wanted) {
    FailAtLine(line, (depth ? "depth as " : "images as ") + EncodingsOf(wanted), text);
  }
  const auto width = words.size() > 2 ? Parse<std::uint32_t>(words[2]) : std::nullopt;
  const auto height = words.size() > 3 ? Parse<std::uint32_t>(words[3]) : std::nullopt;
  if (!width || !height || words.size() > (depth ? 5U : 4U)) {
    FailAtLine(line, "an encoding, a width and a height", text);
  }
  if (const auto fault = SizeFault(*width, *height)) {
    throw InputError(fmt::format("{}:{}: {}", kName, line, *fault));
  }
  Plane plane{words[1], *width, *height, 0};
  if (words.size() > 4) {
    const auto factor = Parse<double>(words[4]);
    if (!factor) FailAtLine(line, "the value of depth per metre", text);
    if (const auto fault = DepthFactorFault(*factor)) {
      throw InputError(fmt::format("{}:{}: {}", kName, line, *fault));
    }
    plane.factor = *factor;
  }
  return plane;
}

Header ReadHeader(PipeReader& pipe) {
  Header header;
  std::string line;
  for (int number = 1;; ++number) {
    if (!pipe.Line(line)) FailAtLine(number, "a whole header", line);
    if (number == 1) {
      if (line != kFirstLine) FailAtLine(1, InQuotes(kFirstLine), line);
      continue;
    }
    const std::vector<std::string> words = Words(line);
    const std::string role = words.empty() ? "" : words[0];
    if (role == "end") break;
    if (line == "imu" && !header.imu) {
      header.imu = true;
      continue;
    }
    if ((role != "left" && role != "right" && role != "depth") || header.Find(role) != nullptr) {
      FailAtLine(number, "'left', 'right', 'depth' or 'imu', each once, or 'end'", line);
    }
    header.planes.emplace_back(role, ParsePlane(words, number, line));
  }
  if (header.Find("left") == nullptr) {
    throw InputError(std::string(kName) + ": expected a left image in the header, found none");
  }
  return header;
}

class RawStream : public LiveSource {
 public:
  RawStream(DatasetInfo info, PipeReader pipe, Header header)
      : LiveSource(std::move(info)), pipe_(std::move(pipe)), header_(std::move(header)) {}

  LiveEvent Next() override {
    std::string line;
    std::vector<std::string> words;
    do {
      if (!pipe_.Line(line)) {
        if (line.empty()) return SourceEnd{};
        if (line.size() >= kLongestLine) FailAtFrame(line);
        return EndsInFrame();
      }
      words = Words(line);
    } while (TakeSample(words));
    const auto stamp_ns = words.size() == 2 ? ParseNanoseconds(words[1]) : std::nullopt;
    if (!stamp_ns || (words[0] != "frame" && words[0] != "missing")) FailAtFrame(line);
    ++frames_;
    if (words[0] == "missing") {
      return MissingFrame{*stamp_ns, "image_unreadable", "the sender has no image"};
    }
    return ReadFrame(*stamp_ns);
  }

  bool HasInertial() const override { return header_.imu; }
  std::vector<InertialSample> TakeInertial() override {
    const std::deque<InertialSample> taken = std::exchange(inertial_, {});
    return {taken.begin(), taken.end()};
  }
  UnusableSamples UnusableInertial() const override { return unusable_; }

 private:
  // Returns false for a line that is no sample. Lines of samples that cannot be used are counted.
  bool TakeSample(const std::vector<std::string>& words) {
    if (!header_.imu || words.empty() || words[0] != "imu") return false;
    const auto sample = ParseInertialSample(std::span(words).subspan(1));
    if (sample) {
      if (inertial_.size() == kMostSamples) inertial_.pop_front();
      inertial_.push_back(*sample);
    } else if (unusable_.count++ == 0) {
      unusable_.first = fmt::format("{}: behind {} frames: {}", kName, frames_, sample.error());
    }
    return true;
  }

  [[noreturn]] void FailAtFrame(const std::string& line) const {
    if (!header_.imu && line.starts_with("imu ")) {
      throw InputError(fmt::format(
          "{}: behind {} frames: expected 'imu' in the header, as samples come, found none",
          kName,
          frames_));
    }
    throw InputError(
        fmt::format("{}: behind {} frames: expected 'frame' or 'missing' and a stamp in "
                    "nanoseconds{}, found {}",
                    kName,
                    frames_,
                    header_.imu ? ", or 'imu' and a sample" : "",
                    InQuotes(line)));
  }

  LiveEvent EndsInFrame() const {
    return SourceEnd{fmt::format("{} ends in the middle of a frame, behind {} whole ones",
                                 kName,
                                 frames_ == 0 ? 0 : frames_ - 1)};
  }

  LiveEvent ReadFrame(std::int64_t stamp_ns) {
    SensorFrame frame;
    frame.stamp_ns = stamp_ns;
    for (const auto& [role, plane] : header_.planes) {
      bytes_.resize(plane.bytes());
      if (!pipe_.Bytes(bytes_)) return EndsInFrame();
      const RawPixels pixels = plane.Pixels(bytes_);
      if (role == "left") {
        frame.left = *GrayOfPixels(kName, pixels, std::nullopt);
      } else if (role == "right" && info().sensor == SensorKind::kStereo) {
        frame.right = *GrayOfPixels(kName, pixels, std::nullopt);
      } else if (role == "depth" && info().sensor == SensorKind::kRgbd) {
        frame.depth = *DepthOfPixels(kName, pixels, *info().calibration.depth_factor, std::nullopt);
      }
    }
    return frame;
  }

  PipeReader pipe_;
  Header header_;
  std::vector<std::uint8_t> bytes_;
  std::size_t frames_ = 0;               // number of frames that have begun
  std::deque<InertialSample> inertial_;  // not taken yet
  UnusableSamples unusable_;
};

std::vector<SensorKind> Available(const Header& header) {
  std::vector<SensorKind> available;
  if (header.Find("right") != nullptr) available.push_back(SensorKind::kStereo);
  if (header.Find("depth") != nullptr) available.push_back(SensorKind::kRgbd);
  available.push_back(SensorKind::kMono);
  return available;
}

void CheckSizes(const Header& header, const DatasetInfo& info) {
  CheckLiveSize(kName, header.Find("left")->size(), info.calibration.left);
  if (info.sensor == SensorKind::kStereo) {
    CheckLiveSize(kName, header.Find("right")->size(), *info.calibration.right);
  }
  if (info.sensor == SensorKind::kRgbd) {
    CheckLiveSize(kName, header.Find("depth")->size(), info.calibration.left);
  }
}

}  // namespace

std::unique_ptr<LiveSource> OpenRawStream(int descriptor, const LiveOptions& options) {
  PipeReader pipe(descriptor);
  Header header = ReadHeader(pipe);
  DatasetInfo info = DescribeLive(kName, Available(header), options);
  if (info.sensor == SensorKind::kRgbd) {
    const Plane& depth = *header.Find("depth");
    std::optional<double>& factor = info.calibration.depth_factor;
    if (depth.factor > 0) factor = depth.factor;
    if (!factor) factor = kMillimetres;
  }
  CheckSizes(header, info);
  return std::make_unique<RawStream>(std::move(info), std::move(pipe), std::move(header));
}

}  // namespace plumbline
