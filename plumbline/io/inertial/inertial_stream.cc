// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/inertial/inertial_stream.h"

#include "plumbline/base/printable.h"
#include "plumbline/inertial/inertial_samples.h"
#include "plumbline/io/datasets/rosbag2_files.h"
#include "plumbline/io/recordings/image_message.h"
#include "plumbline/io/recordings/recording_formats.h"
#include "plumbline/io/text_rows.h"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/core.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

class RowStream : public InertialStream {
 public:
  explicit RowStream(const fs::path& file) : file_(file), rows_(file, ',') {}

  std::optional<InertialSample> Next() override {
    while (const auto row = rows_.Next()) {
      const auto sample = ParseInertialSample(row->fields);
      if (sample) return *sample;
      if (unusable_.count++ > 0) continue;
      unusable_.first = fmt::format("{}:{}: {}", file_.string(), row->line, sample.error());
    }
    return std::nullopt;
  }

 private:
  fs::path file_;
  TextRowReader rows_;
};

InertialReading ReadingOf(const Channel& channel,
                          const StoredMessage& place,
                          const std::optional<InertialMessage>& message) {
  const auto is_time = [](std::int64_t ns) { return ns > 0 && ns <= kLatestStampNs; };
  InertialReading reading{channel.topic, std::nullopt, false, false};
  InertialSample sample;
  sample.stamp_ns = message && is_time(message->stamp_ns) ? message->stamp_ns : place.logged_ns;
  if (!message || !is_time(sample.stamp_ns)) return reading;
  sample.angular_rate = Eigen::Map<const Eigen::Vector3d>(message->angular_rate.data());
  sample.specific_force = Eigen::Map<const Eigen::Vector3d>(message->specific_force.data());
  if (!IsPlausible(sample)) return reading;
  reading.has_rate = message->has_rate && !sample.angular_rate.isZero(0);
  reading.has_force = message->has_force && !sample.specific_force.isZero(0);
  reading.sample = sample;
  return reading;
}

// Ends the reading of a recording from within its sink.
struct EnoughRead {};

// Messages from a thread to another one, of which only so many wait.
class ReadingQueue {
 public:
  // Waits for room. Returns false once nobody takes any more.
  bool Add(InertialReading reading) {
    constexpr std::size_t kMostWaiting = 4096;
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || waiting_.size() < kMostWaiting; });
    if (closed_) return false;
    waiting_.push_back(std::move(reading));
    changed_.notify_all();
    return true;
  }
  void End() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_all();
  }
  // Waits for a message; nullopt after the last one.
  std::optional<InertialReading> Take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return ended_ || !waiting_.empty(); });
    if (waiting_.empty()) return std::nullopt;
    InertialReading reading = std::move(waiting_.front());
    waiting_.pop_front();
    changed_.notify_all();
    return reading;
  }
  void Close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<InertialReading> waiting_;
  bool ended_ = false, closed_ = false;
};

class TopicStream : public InertialStream {
 public:
  TopicStream(const fs::path& path, DatasetFormat format, const InertialTopics& topics)
      : topics_(topics), joiner_(topics.gyroscope_leads), reader_([this, path, format] {
          try {
            ReadInertialMessages(path, format, [this](InertialReading reading) {
              const bool wanted =
                  reading.topic == topics_.gyroscope || reading.topic == topics_.accelerometer;
              return !wanted || queue_.Add(std::move(reading));
            });
          } catch (const InputError&) {  // it was read whole before, and has changed since
          }
          queue_.End();
        }) {}
  ~TopicStream() override { queue_.Close(); }

  std::optional<InertialSample> Next() override {
    const bool apart = topics_.gyroscope != topics_.accelerometer;
    while (true) {
      if (auto joined = joiner_.Take()) return joined;
      const auto reading = queue_.Take();
      if (!reading) return EndOfTopics();
      if (!reading->sample) {
        ++unusable_.count;
        continue;
      }
      if (!apart) return reading->sample;
      (reading->topic == topics_.gyroscope ? rate_order_ : force_order_).Add(*reading->sample);
      Join();
    }
  }

 private:
  void Join() {
    while (const auto rates = rate_order_.Take()) joiner_.AddRates(*rates);
    while (const auto forces = force_order_.Take()) joiner_.AddForces(*forces);
  }

  std::optional<InertialSample> EndOfTopics() {
    rate_order_.End();
    force_order_.End();
    Join();
    return joiner_.Take();
  }

  InertialTopics topics_;
  TimeOrder rate_order_, force_order_;
  SampleJoiner joiner_;
  ReadingQueue queue_;
  std::jthread reader_;  // last: uses the members before
};

}  // namespace

Expected<InertialSample, std::string> ParseInertialSample(std::span<const std::string> fields) {
  constexpr std::size_t kFields = 7;
  if (fields.size() != kFields) {
    return fmt::format(
        "expected a time stamp, three rates in rad/s and three forces in m/s^2, found {} columns",
        fields.size());
  }
  const bool seconds = fields[0].find('.') != std::string::npos;
  const auto stamp = seconds ? ParseSeconds(fields[0]) : ParseNanoseconds(fields[0]);
  if (!stamp) {
    return fmt::format(
        "expected a time stamp in whole nanoseconds, or in seconds with a decimal point, found {}",
        InQuotes(fields[0]));
  }
  InertialSample sample;
  sample.stamp_ns = *stamp;
  for (std::size_t k = 0; k < 6; ++k) {
    const std::string& text = fields[1 + k];
    const auto value = ParseNumber(text);
    if (!value) {
      return fmt::format("expected a number in column {}, found {}", k + 2, InQuotes(text));
    }
    const auto axis = static_cast<Eigen::Index>(k % 3);
    (k < 3 ? sample.angular_rate : sample.specific_force)(axis) = *value;
    if (!IsPlausible(sample)) {
      return "expected rates in rad/s and forces in m/s^2, found " + InQuotes(text);
    }
  }
  return sample;
}

std::unique_ptr<InertialStream> OpenInertialRows(const fs::path& file) {
  return std::make_unique<RowStream>(file);
}

void ReadInertialMessages(const fs::path& path, DatasetFormat format, const InertialSink& sink) {
  const MessageSink read =
      [&](const Channel& channel, const StoredMessage& place, std::span<const std::uint8_t> bytes) {
        const auto form = FormOf(channel);
        if (!form || form->kind != MessageKind::kInertial) return;
        const bool cdr = form->encoding == MessageEncoding::kCdr;
        const auto unpacked = UnpackedMessage(channel, bytes);
        std::optional<InertialMessage> message;
        if (!unpacked) message = ParseRosInertial(cdr, bytes);
        if (unpacked && *unpacked) message = ParseRosInertial(cdr, **unpacked);
        if (!sink(ReadingOf(channel, place, message))) throw EnoughRead{};
      };
  try {
    switch (format) {
      case DatasetFormat::kBag:
        ReadBag(path, read);
        break;
      case DatasetFormat::kMcap:
        ReadMcap(path, read);
        break;
      case DatasetFormat::kRosbag2:
        ReadRosbag2(path, FindRosbag2Files(path).files, read);
        break;
      default:
        break;
    }
  } catch (const EnoughRead&) {
  }
}

std::unique_ptr<InertialStream> OpenInertialTopics(const fs::path& path,
                                                   DatasetFormat format,
                                                   const InertialTopics& topics) {
  return std::make_unique<TopicStream>(path, format, topics);
}

}  // namespace plumbline
