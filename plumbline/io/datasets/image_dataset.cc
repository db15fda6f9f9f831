// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/image_dataset.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

ImageSize SizeOf(const Camera& camera) { return {camera.width(), camera.height()}; }

class ImageDataset : public Dataset {
 public:
  ImageDataset(DatasetInfo info, std::vector<FrameFiles> files)
      : Dataset(std::move(info)), files_(std::move(files)) {}

  Expected<SensorFrame, ImageFailure> Read(std::size_t i) const override {
    const FrameFiles& files = files_.at(i);
    const ImageSize size = SizeOf(calibration().left);
    const ImageSize right_size = calibration().right ? SizeOf(*calibration().right) : size;
    const auto wanted = [&](ImageSize of) {
      return info().has_calibration ? std::optional(of) : std::nullopt;
    };
    SensorFrame frame;
    frame.stamp_ns = stamp_ns(i);
    const Expected<GrayImage, ImageFailure> left = ReadGrayImage(files.left, wanted(size));
    if (!left) return FailureOf(left.error(), size);
    frame.left = *left;
    if (files.right) {
      const auto right = ReadGrayImage(*files.right, wanted(right_size));
      if (!right) return FailureOf(right.error(), right_size);
      frame.right = *right;
    }
    if (files.depth) {
      const double factor = calibration().depth_factor.value_or(1);
      const auto depth = ReadDepthImage(*files.depth, factor, wanted(size));
      if (!depth) return FailureOf(depth.error(), size);
      frame.depth = *depth;
    }
    frame.left_mask = MaskIn(files.left_mask, frame.left);
    if (frame.right) frame.right_mask = MaskIn(files.right_mask, *frame.right);
    return frame;
  }

  Expected<ColorImage, ImageFailure> ReadColor(std::size_t i) const override {
    const ImageSize size = SizeOf(calibration().left);
    auto image = ReadColorImage(files_.at(i).left,
                                info().has_calibration ? std::optional(size) : std::nullopt);
    if (!image) return FailureOf(image.error(), size);
    return image;
  }

 private:
  // The mask in a file; null without one, and if it cannot be decoded or has another size than its
  // image: what is optional costs no frame.
  static std::shared_ptr<const GrayImage> MaskIn(const std::optional<fs::path>& file,
                                                 const GrayImage& image) {
    if (!file) return nullptr;
    auto read = ReadMask(*file, ImageSize{image.width(), image.height()});
    return read ? std::make_shared<const GrayImage>(*std::move(read)) : nullptr;
  }

  std::vector<FrameFiles> files_;
};

std::string_view DigitRun(std::string_view text) {
  const auto end = std::find_if_not(
      text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  return text.substr(0, static_cast<std::size_t>(end - text.begin()));
}

// Meaning of digits after "<digit>.", for all names of a folder.
enum class DigitsBehindPoint { kNumber, kFraction };

// Returns true if digits after "<digit>." begin at this position of a name.
bool IsBehindPoint(std::string_view name, std::size_t place) {
  return place >= 2 && name[place - 1] == '.' && !DigitRun(name.substr(place - 2)).empty();
}

// Decides about the digits behind a point. Times in seconds are often written without the zeros at
// their end, so that 0.05, 0.1 and 0.15 follow each other; a counter behind the number of a camera
// goes from 1.9 to 1.10. A counter soon comes to a number that ends with zero, which such a time
// never does; in 1.2.3 there is no fraction at all.
DigitsBehindPoint DigitsBehindPointOf(const std::vector<std::string>& names) {
  for (const std::string_view name : names) {
    for (std::size_t i = 0; i < name.size(); ++i) {
      const std::string_view run = DigitRun(name.substr(i));
      if (run.empty()) continue;
      const std::size_t end = i + run.size();
      if (IsBehindPoint(name, i)) {
        const bool another = end + 1 < name.size() && IsBehindPoint(name, end + 1) &&
                             !DigitRun(name.substr(end + 1)).empty();
        if (another || (run.size() > 1 && run.back() == '0')) return DigitsBehindPoint::kNumber;
      }
      i = end;
    }
  }
  return DigitsBehindPoint::kFraction;
}

// Returns less than 0 if a comes first, and more than 0 if b does; 0 for names that differ at most
// in zeros before numbers, for example 1 and 01.
int NaturalOrder(std::string_view a, std::string_view b, DigitsBehindPoint behind_point) {
  const std::string_view name = a;  // as far as the names are the same, both are like this one
  while (!a.empty() && !b.empty()) {
    std::string_view run_a = DigitRun(a);
    std::string_view run_b = DigitRun(b);
    if (run_a.empty() || run_b.empty()) {
      if (a.front() != b.front()) return a.front() < b.front() ? -1 : 1;
      a.remove_prefix(1);
      b.remove_prefix(1);
      continue;
    }
    const bool fraction =
        behind_point == DigitsBehindPoint::kFraction && IsBehindPoint(name, name.size() - a.size());
    a.remove_prefix(run_a.size());
    b.remove_prefix(run_b.size());
    if (fraction) {
      if (run_a != run_b) return run_a < run_b ? -1 : 1;
      continue;
    }
    run_a.remove_prefix(std::min(run_a.find_first_not_of('0'), run_a.size()));
    run_b.remove_prefix(std::min(run_b.find_first_not_of('0'), run_b.size()));
    const auto key = [](std::string_view run) { return std::tuple(run.size(), run); };
    if (run_a != run_b) return key(run_a) < key(run_b) ? -1 : 1;
  }
  return a.empty() == b.empty() ? 0 : a.empty() ? -1 : 1;
}

// Sorts the names of the images in a folder. Refuses names with the same number: it is ambiguous
// which of 3.png, 000003.png and 3.jpg is the image of that number.
void SortByNumbers(const fs::path& folder, std::vector<std::string>& names) {
  const DigitsBehindPoint behind_point = DigitsBehindPointOf(names);
  std::sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
    const int order = NaturalOrder(a, b, behind_point);
    return order != 0 ? order < 0 : a < b;
  });
  const auto stem = [](const std::string& name) { return fs::path(name).stem().string(); };
  for (std::size_t i = 1; i < names.size(); ++i) {
    if (NaturalOrder(stem(names[i - 1]), stem(names[i]), behind_point) != 0) continue;
    throw InputError(fmt::format("{}: expected one image of each number, found {} and {}",
                                 folder.string(),
                                 names[i - 1],
                                 names[i]));
  }
}

std::string NameOf(const fs::path& path) {
  const fs::path clean = path.lexically_normal();
  return (clean.has_filename() ? clean : clean.parent_path()).filename().string();
}

// Returns the folder of masks of this name of a data set, if there is one: that in mav0 if there is
// none beside it. Notes a file of this name, and the other folder of two.
std::optional<fs::path> MaskFolder(const std::string& name, DatasetInfo& info) {
  std::error_code error;
  std::optional<fs::path> found;
  for (const fs::path& parent : {info.path, info.path / "mav0"}) {
    if (fs::is_directory(parent / name, error)) {
      if (found) {
        info.notes.push_back(fmt::format(
            "{} is not used, since there is {}", (parent / name).string(), found->string()));
      } else {
        found = parent / name;
      }
    }
    if (found) continue;
    for (const fs::path& file : {parent / name, parent / (name + ".png")}) {
      if (!fs::is_regular_file(file, error)) continue;
      info.notes.push_back(
          fmt::format("{} is not used: expected a folder with a mask for each image; --mask {} "
                      "uses it for all images",
                      file.string(),
                      file.string()));
    }
  }
  return found;
}

// Finds the masks of the frames of one camera, and notes what they are.
//
// A file that cannot be used costs its mask, not the frame: a note says which one, and why.
void FindMasks(const char* name,
               std::optional<fs::path> FrameFiles::*mask,
               const std::function<const fs::path*(const FrameFiles&)>& image_of,
               std::vector<FrameFiles>& files,
               DatasetInfo& info) {
  if (files.empty() || image_of(files.front()) == nullptr) return;
  const std::optional<fs::path> folder = MaskFolder(name, info);
  if (!folder) return;
  const std::optional<ImageSize> wanted = SizeOfCamera(info, mask == &FrameFiles::right_mask);
  std::size_t bad = 0;
  std::vector<fs::path> found;
  std::string first_fault;
  for (FrameFiles& frame : files) {
    const fs::path file = *folder / (image_of(frame)->stem().string() + ".png");
    if (!PathExists(file)) continue;
    const Expected<ImageSize, ImageFailure> size = ReadImageSize(file);
    if (size && (!wanted || *size == *wanted)) {
      frame.*mask = file;
      found.push_back(file);
    } else if (bad++ == 0) {
      const ImageFailure fault = size ? ImageFailure{file, {}, *size} : size.error();
      first_fault = fmt::format("{}: {}", file.string(), MaskFailureOf(fault, wanted).why);
    }
  }
  if (bad > 0) {
    info.notes.push_back(fmt::format("{}; {} cannot be used, and the images are used whole",
                                     first_fault,
                                     bad == 1 ? "this mask" : fmt::format("{} masks", bad)));
  }
  NoteMasks(
      {found.size(), files.size(), "in " + folder->string()},
      [&](std::size_t i) { return ReadMask(found[i], wanted); },
      info);
}

}  // namespace

std::optional<ImageSize> SizeOfCamera(const DatasetInfo& info, bool right) {
  if (!info.has_calibration || (right && !info.calibration.right)) return std::nullopt;
  return SizeOf(right ? *info.calibration.right : info.calibration.left);
}

double MaskedShare(const GrayImage& mask) {
  const std::int64_t pixels = std::int64_t{mask.width()} * mask.height();
  const auto black = std::count(mask.data(), mask.data() + pixels, std::uint8_t{0});
  return static_cast<double>(black) / static_cast<double>(pixels);
}

void NoteMasks(const FoundMasks& masks,
               const std::function<Expected<GrayImage, ImageFailure>(std::size_t)>& read,
               DatasetInfo& info) {
  constexpr std::size_t kMost = 20;
  const std::size_t looked = std::min(kMost, masks.masks);
  std::size_t bad = 0;
  double share = 0;
  std::string first_fault;
  for (std::size_t i = 0; i < looked; ++i) {
    const auto mask = read(i * masks.masks / looked);
    if (mask) {
      share += MaskedShare(*mask);
    } else if (bad++ == 0) {
      first_fault = fmt::format("{}: {}", mask.error().path.string(), mask.error().why);
    }
  }
  std::string note = fmt::format("{} of the {} images of the data {} a mask {}",
                                 masks.masks,
                                 masks.images,
                                 masks.masks == 1 ? "has" : "have",
                                 masks.place);
  const std::string of = looked == masks.masks ? "" : fmt::format(" (in {} of them)", looked);
  if (looked > bad) {
    share /= static_cast<double>(looked - bad);
    const bool one = masks.masks == 1;
    note += fmt::format("; {} {:.3g} % of the image{}{}",
                        one ? "it leaves out" : "they leave out",
                        100 * share,
                        of,
                        share <= 0.5 ? ""
                        : one        ? "; is it inverted? What is black is not used"
                                     : "; are they inverted? What is black is not used");
  }
  if (bad > 0) {
    note += fmt::format("; {} cannot be used{}, and {} used whole: {}",
                        bad,
                        of,
                        bad == 1 ? "its image is" : "their images are",
                        first_fault);
  }
  info.notes.push_back(std::move(note));
}

bool PathExists(const fs::path& path) {
  std::error_code error;
  const bool exists = fs::exists(path, error);
  if (error) throw InputError(path.string() + ": cannot be read: " + error.message());
  return exists;
}

std::vector<ListedImage> InOrderOfTime(const fs::path& list,
                                       const std::vector<ListedImage>& images,
                                       std::vector<std::string>& notes) {
  std::vector<StampedRow> rows;
  rows.reserve(images.size());
  for (const ListedImage& image : images) rows.push_back(image.row);
  std::vector<ListedImage> ordered;
  for (const std::size_t i : OrderOfTime(list, rows, notes)) ordered.push_back(images[i]);
  return ordered;
}

void CheckSecondList(const fs::path& list, const char* images) {
  if (PathExists(list)) return;
  throw InputError(
      fmt::format("{}: expected a list of the {} images, found none; with the sensor "
                  "mono it is not needed",
                  list.string(),
                  images));
}

ImageFailure MaskFailureOf(ImageFailure failure, std::optional<ImageSize> wanted) {
  if (!failure.other_size || !wanted) return failure;
  failure.why = fmt::format("expected a mask of {}x{} pixels as the images, found {}x{}",
                            wanted->width,
                            wanted->height,
                            failure.other_size->width,
                            failure.other_size->height);
  return failure;
}

ImageFailure FailureOf(ImageFailure failure, ImageSize wanted) {
  if (!failure.other_size) return failure;
  failure.why = fmt::format("expected an image of {}x{} pixels as in the calibration, found {}x{}",
                            wanted.width,
                            wanted.height,
                            failure.other_size->width,
                            failure.other_size->height);
  return failure;
}

void CheckFirstFrame(const Dataset& dataset) {
  constexpr int kManyOfAnotherSize = 10;
  std::optional<ImageFailure> first, of_another_size;
  int others = 0;
  for (std::size_t i = 0; i < dataset.size() && others < kManyOfAnotherSize; ++i) {
    const Expected<SensorFrame, ImageFailure> frame = dataset.Read(i);
    if (frame) return;
    if (!first) first = frame.error();
    if (!frame.error().other_size) continue;
    if (!of_another_size) of_another_size = frame.error();
    ++others;
  }
  if (of_another_size) {
    throw InputError(of_another_size->path.string() + ": " + of_another_size->why);
  }
  throw InputError(fmt::format("{}: expected images, found none of {} that can be read: {}: {}",
                               dataset.info().path.string(),
                               dataset.size(),
                               first->path.string(),
                               first->why));
}

std::unique_ptr<Dataset> MakeImageDataset(DatasetInfo info, std::vector<FrameFiles> files) {
  PLUMBLINE_CHECK(files.size() == info.stamps_ns.size(), "one stamp for each frame");
  if (files.empty()) throw InputError(info.path.string() + ": expected frames, found none");
  std::size_t missing_left = 0;
  std::size_t missing_other = 0;
  for (const FrameFiles& frame : files) {
    missing_left += PathExists(frame.left) ? 0 : 1;
    missing_other += frame.right && !PathExists(*frame.right) ? 1 : 0;
    missing_other += frame.depth && !PathExists(*frame.depth) ? 1 : 0;
  }
  if (missing_left == files.size()) {
    throw InputError(
        fmt::format("{}: expected images, found none of the {} listed (the first is {})",
                    info.path.string(),
                    files.size(),
                    files.front().left.string()));
  }
  const char* other = info.sensor == SensorKind::kStereo ? "right" : "depth";
  if (missing_other == files.size()) {
    throw InputError(fmt::format("{}: expected {} images, found none of the {} listed",
                                 info.path.string(),
                                 other,
                                 missing_other));
  }
  if (missing_left > 0) {
    info.notes.push_back(fmt::format("{} of {} {}images do not exist",
                                     missing_left,
                                     files.size(),
                                     info.sensor == SensorKind::kStereo ? "left " : ""));
  }
  if (missing_other > 0) {
    info.notes.push_back(
        fmt::format("{} of {} {} images do not exist", missing_other, files.size(), other));
  }
  const auto first = std::find_if(
      files.begin(), files.end(), [](const FrameFiles& frame) { return PathExists(frame.left); });
  if (first != files.end()) NoteBits(BrightestOf16Bits(first->left), info);
  NoteRate(info);
  FindMasks(
      "mask0", &FrameFiles::left_mask, [](const FrameFiles& f) { return &f.left; }, files, info);
  FindMasks(
      "mask1",
      &FrameFiles::right_mask,
      [](const FrameFiles& f) { return f.right ? &*f.right : nullptr; },
      files,
      info);
  auto dataset = std::make_unique<ImageDataset>(std::move(info), std::move(files));
  CheckFirstFrame(*dataset);
  return dataset;
}

void NoteBits(std::optional<int> brightest, DatasetInfo& info) {
  if (!brightest) return;
  info.notes.push_back(
      fmt::format("the images have 16 bits, of which the upper 8 are used: the brightest level of "
                  "the first one, {} of 65535, becomes {} of 255",
                  *brightest,
                  *brightest / 256));
}

void NoteRate(DatasetInfo& info) {
  constexpr std::int64_t kShortestNs = 1'000'000;
  constexpr std::size_t kFewest = 10;
  std::vector<std::int64_t> intervals;
  for (std::size_t i = 1; i < info.stamps_ns.size(); ++i) {
    intervals.push_back(info.stamps_ns[i] - info.stamps_ns[i - 1]);
  }
  if (intervals.size() < kFewest) return;
  const auto median = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), median, intervals.end());
  if (*median >= kShortestNs) return;
  info.notes.push_back(
      fmt::format("the time stamps are those of {:.0f} frames a second, which no camera takes: are "
                  "they in another unit than nanoseconds?",
                  1e9 / static_cast<double>(*median)));
}

DatasetInfo DescribeDataset(const fs::path& path,
                            DatasetFormat format,
                            std::vector<SensorKind> available,
                            const DatasetOptions& options) {
  DatasetInfo info;
  info.name = NameOf(path);
  info.path = path;
  info.format = format;
  info.sensor = options.sensor.value_or(available.front());
  info.available = std::move(available);
  if (std::find(info.available.begin(), info.available.end(), info.sensor) ==
      info.available.end()) {
    std::vector<std::string> names;
    for (const SensorKind kind : info.available) names.push_back(SensorName(kind));
    throw MissingSensor(fmt::format("{}: expected data for {}, found data for {} only",
                                    path.string(),
                                    SensorName(info.sensor),
                                    fmt::join(names, ", ")));
  }
  return info;
}

std::optional<CameraFile> GivenCamera(const fs::path& folder,
                                      const DatasetOptions& options,
                                      std::optional<SensorKind> sensor) {
  const std::optional<fs::path> file = CameraFileIn(folder);
  if (!options.camera && !file) return std::nullopt;
  const bool stereo = sensor == SensorKind::kStereo;
  CameraFile camera =
      options.camera ? FindCamera(*options.camera, stereo) : ReadCameraFile(*file, stereo);
  if (stereo && !camera.calibration.right) {
    throw InputError((options.camera ? *options.camera : file->string()) +
                     ": expected a stereo camera, found one camera");
  }
  return camera;
}

void UseCamera(CameraFile camera, DatasetInfo& info) {
  info.has_calibration = true;
  info.calibration = std::move(camera.calibration);
  info.calibration_source = std::move(camera.source);
  if (info.sensor != SensorKind::kStereo) info.calibration.right.reset();
  if (info.sensor != SensorKind::kRgbd) info.calibration.depth_factor.reset();
}

std::string SensorName(SensorKind sensor) {
  for (const auto& [kind, name] : EnumNames(std::type_identity<SensorKind>{})) {
    if (kind == sensor) return name;
  }
  throw BugError("a sensor without a name");
}

std::vector<std::string> ListImages(const fs::path& folder) {
  constexpr std::array<std::string_view, 10> kExtensions = {
      ".png", ".jpg", ".jpeg", ".webp", ".pgm", ".ppm", ".bmp", ".tif", ".tiff", ".pnm"};
  std::error_code error;
  if (!fs::is_directory(folder, error)) throw InputError(folder.string() + ": no such folder");
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    // Hidden files are no images of the folder: macOS leaves a "._1.png" beside "1.png".
    const std::string name = entry.path().filename().string();
    if (name.starts_with('.')) continue;
    std::string extension = entry.path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) {
      return static_cast<char>(std::tolower(c));
    });
    if (std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end()) {
      names.push_back(name);
    }
  }
  if (error) throw InputError(folder.string() + ": cannot be listed: " + error.message());
  SortByNumbers(folder, names);
  return names;
}

std::string NoCalibration(const fs::path& path) {
  return fmt::format(
      "{}: expected a calibration, found none: give --camera FILE, or put a "
      "camera.yaml into the folder (built-in cameras: {})",
      path.string(),
      fmt::join(BuiltInCameras(), ", "));
}

}  // namespace plumbline
