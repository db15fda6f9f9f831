// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/video_decoder_library.h"

#include "plumbline/image/opencv_modules.h"

#include <array>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <utility>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/log.h>
#include <libswscale/swscale.h>
}

namespace plumbline {
namespace {

// FFmpeg logs to standard error, by default verbosely. As in OpenCV, only errors are logged, or the
// level set in the environment.
void SetLogLevel() {
  const char* level = std::getenv("OPENCV_FFMPEG_LOGLEVEL");  // NOLINT(concurrency-mt-unsafe)
  av_log_set_level(level != nullptr ? std::atoi(level) : AV_LOG_ERROR);  // NOLINT(cert-err34-c)
}

struct CloseFormat {
  void operator()(AVFormatContext* format) const { avformat_close_input(&format); }
};
struct FreeCodec {
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
};
struct FreeFrame {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
struct FreePacket {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
struct FreeConversion {
  void operator()(SwsContext* conversion) const { sws_freeContext(conversion); }
};
using Format = std::unique_ptr<AVFormatContext, CloseFormat>;
using Codec = std::unique_ptr<AVCodecContext, FreeCodec>;

Format OpenFormat(const std::string& path) {
  AVDictionary* options = nullptr;
  av_dict_set(&options, "protocol_whitelist", "file", 0);  // a list of files must not reach out
  AVFormatContext* opened = nullptr;
  const int result = avformat_open_input(&opened, ("file:" + path).c_str(), nullptr, &options);
  av_dict_free(&options);
  Format format(opened);
  if (result < 0 || avformat_find_stream_info(format.get(), nullptr) < 0) return nullptr;
  return format;
}

Codec OpenCodec(const AVStream& stream) {
  const AVCodec* decoder = avcodec_find_decoder(stream.codecpar->codec_id);
  Codec codec(avcodec_alloc_context3(decoder));
  if (decoder == nullptr || codec == nullptr) return nullptr;
  if (avcodec_parameters_to_context(codec.get(), stream.codecpar) < 0) return nullptr;
  codec->pkt_timebase = stream.time_base;
  codec->thread_count = 0;  // as many as there are processors
  if (avcodec_open2(codec.get(), decoder, nullptr) < 0) return nullptr;
  return codec;
}

// The matrix takes a pixel (x, y) to (a x + c y, b x + d y), with a, b in its first row and c, d in
// its second, in 16.16 bits.
std::optional<Orientation> OrientationOf(const AVStream& stream) {
  const auto* bytes = av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr);
  if (bytes == nullptr) return Orientation{};
  const auto* matrix = reinterpret_cast<const std::int32_t*>(bytes);
  const std::int32_t a = matrix[0], b = matrix[1], c = matrix[3], d = matrix[4];
  if (b == 0 && c == 0 && a != 0 && d != 0) return Orientation{false, a < 0, d < 0};
  if (a == 0 && d == 0 && b != 0 && c != 0) return Orientation{true, c < 0, b < 0};
  return std::nullopt;
}

class FfmpegDecoder : public VideoDecoder {
 public:
  FfmpegDecoder(Format format, Codec codec, int stream)
      : format_(std::move(format)), codec_(std::move(codec)), stream_(format_->streams[stream]) {
    for (unsigned i = 0; i < format_->nb_streams; ++i) {
      if (format_->streams[i] != stream_) format_->streams[i]->discard = AVDISCARD_ALL;
    }
    const AVRational rate = stream_->avg_frame_rate;
    if (rate.num > 0 && rate.den > 0) properties_.rate_hz = av_q2d(rate);
    properties_.frames = stream_->nb_frames;
    // The index of QuickTime files contains only the frames that an edit list leaves.
    if (std::string_view(format_->iformat->name).starts_with("mov")) {
      properties_.frames = avformat_index_get_entries_count(stream_);
    }
    properties_.is_text = codec_->codec_id == AV_CODEC_ID_ANSI;
    properties_.orientation = OrientationOf(*stream_);
  }

  const VideoProperties& properties() const override { return properties_; }

  bool Next() override {
    constexpr int kMostFailures = 1000;  // in succession, behind the end of the file
    for (int failures = 0; failures < kMostFailures;) {
      const int result = avcodec_receive_frame(codec_.get(), frame_.get());
      if (result == 0) return true;
      if (result == AVERROR_EOF) return false;
      if (result == AVERROR(EAGAIN) && at_end_) return false;
      if (at_end_) {
        ++failures;
      } else {
        Feed();
      }
    }
    return false;
  }

  std::optional<std::int64_t> time_ns() const override {
    constexpr AVRational kNanoseconds = {1, 1'000'000'000};
    const std::int64_t shown =
        frame_->pts != AV_NOPTS_VALUE ? frame_->pts : frame_->best_effort_timestamp;
    if (shown == AV_NOPTS_VALUE) return std::nullopt;
    const std::int64_t start = stream_->start_time != AV_NOPTS_VALUE ? stream_->start_time : 0;
    std::int64_t ticks = 0;
    if (__builtin_sub_overflow(shown, start, &ticks)) return std::nullopt;
    return av_rescale_q(ticks, stream_->time_base, kNanoseconds);
  }

  int width() const override { return frame_->width; }
  int height() const override { return frame_->height; }

  bool Retrieve(cv::Mat& image) const override {
    const auto pixels = static_cast<AVPixelFormat>(frame_->format);
    conversion_.reset(sws_getCachedContext(conversion_.release(),
                                           frame_->width,
                                           frame_->height,
                                           pixels,
                                           frame_->width,
                                           frame_->height,
                                           AV_PIX_FMT_BGR24,
                                           SWS_BICUBIC,
                                           nullptr,
                                           nullptr,
                                           nullptr));
    if (conversion_ == nullptr) return false;
    // Some conversions write whole blocks of pixels, also beyond the end of a row.
    constexpr int kBlock = 64;
    const int columns = (frame_->width + kBlock - 1) / kBlock * kBlock;
    cv::Mat padded(frame_->height, columns, CV_8UC3);
    const std::array<std::uint8_t*, 4> planes = {padded.data};
    const std::array<int, 4> steps = {static_cast<int>(padded.step)};
    const int rows = sws_scale(conversion_.get(),
                               frame_->data,
                               frame_->linesize,
                               0,
                               frame_->height,
                               planes.data(),
                               steps.data());
    image = padded.colRange(0, frame_->width);
    return rows == frame_->height;
  }

 private:
  // Gives the next packet of the file to the decoder, or tells it that there are no more.
  void Feed() {
    if (av_read_frame(format_.get(), packet_.get()) < 0) {
      at_end_ = true;
      avcodec_send_packet(codec_.get(), nullptr);
      return;
    }
    if (packet_->stream_index == stream_->index) {
      if ((packet_->flags & AV_PKT_FLAG_DISCARD) != 0) --properties_.frames;
      avcodec_send_packet(codec_.get(), packet_.get());  // a damaged one gives no frame
    }
    av_packet_unref(packet_.get());
  }

  Format format_;
  Codec codec_;
  AVStream* stream_;
  VideoProperties properties_;
  std::unique_ptr<AVFrame, FreeFrame> frame_{av_frame_alloc()};
  std::unique_ptr<AVPacket, FreePacket> packet_{av_packet_alloc()};
  mutable std::unique_ptr<SwsContext, FreeConversion> conversion_;
  bool at_end_ = false;
};

}  // namespace

std::unique_ptr<VideoDecoder> OpenVideoDecoder(const std::string& path) {
  static std::once_flag log_is_set;
  std::call_once(log_is_set, SetLogLevel);
  Format format = OpenFormat(path);
  if (format == nullptr) return nullptr;
  const int stream = av_find_best_stream(format.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (stream < 0) return nullptr;
  Codec codec = OpenCodec(*format->streams[stream]);
  if (codec == nullptr) return nullptr;
  return std::make_unique<FfmpegDecoder>(std::move(format), std::move(codec), stream);
}

}  // namespace plumbline
