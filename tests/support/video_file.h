// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

namespace plumbline {

// A video written by FFmpeg's libraries, each of whose frames has one grey level.
struct VideoFile {
  std::string encoder = "libx264";
  int width = 160, height = 120;
  int b_frames = 0;
  int key_every = 250;
  AVRational tick = {1, 25};
  std::vector<std::int64_t> times;  // of the frames, in ticks, in display order
  std::vector<int> levels;          // 16 to 235
  // In ticks, replacing the times of the encoder's packets: a faulty container.
  std::vector<std::int64_t> packet_times = {};
  std::size_t packets_cut = 0;               // packets that are missing at the start
  std::array<std::int32_t, 4> display = {};  // a, b, c, d of the display matrix; 0: none

  void Write(const std::filesystem::path& path) const;

 private:
  struct Muxer;
  AVCodecContext* OpenEncoder(bool global_header) const;
  AVFrame* Picture(const AVCodecContext& codec, std::size_t index) const;
  void Encode(AVCodecContext* codec, AVFrame* frame, Muxer& muxer) const;
};

struct VideoFile::Muxer {
  explicit Muxer(const std::filesystem::path& path) {
    avformat_alloc_output_context2(&format, nullptr, nullptr, path.c_str());
    stream = avformat_new_stream(format, nullptr);
    EXPECT_GE(avio_open(&format->pb, path.c_str(), AVIO_FLAG_WRITE), 0);
  }
  ~Muxer() {
    av_write_trailer(format);
    avio_closep(&format->pb);
    avformat_free_context(format);
  }

  AVFormatContext* format = nullptr;
  AVStream* stream = nullptr;
  std::size_t packets = 0;
};

inline void VideoFile::Encode(AVCodecContext* codec, AVFrame* frame, Muxer& muxer) const {
  EXPECT_GE(avcodec_send_frame(codec, frame), 0);
  AVPacket* packet = av_packet_alloc();
  while (avcodec_receive_packet(codec, packet) == 0) {
    const std::size_t index = muxer.packets++;
    if (index < packets_cut) continue;
    if (!packet_times.empty()) {
      packet->pts = packet_times[index];
      packet->dts = static_cast<std::int64_t>(index) - 1000;
    }
    av_packet_rescale_ts(packet, tick, muxer.stream->time_base);
    EXPECT_GE(av_interleaved_write_frame(muxer.format, packet), 0);
  }
  av_packet_free(&packet);
}

inline AVCodecContext* VideoFile::OpenEncoder(bool global_header) const {
  const AVCodec* found = avcodec_find_encoder_by_name(encoder.c_str());
  EXPECT_NE(found, nullptr);
  AVCodecContext* codec = avcodec_alloc_context3(found);
  codec->width = width;
  codec->height = height;
  codec->pix_fmt = encoder == "mjpeg" ? AV_PIX_FMT_YUVJ420P : AV_PIX_FMT_YUV420P;
  codec->time_base = tick;
  codec->framerate = av_inv_q(tick);
  codec->max_b_frames = b_frames;
  codec->gop_size = key_every;
  codec->thread_count = 1;
  if (global_header) codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  // Every frame between the others becomes a B frame, without further key frames.
  AVDictionary* options = nullptr;
  if (encoder == "libx264") {
    av_dict_set(&options, "x264-params", "b-adapt=0:scenecut=0:log=-1:open-gop=0", 0);
  }
  EXPECT_GE(avcodec_open2(codec, found, &options), 0);
  av_dict_free(&options);
  return codec;
}

// One grey level with a bright upper left corner.
inline AVFrame* VideoFile::Picture(const AVCodecContext& codec, std::size_t index) const {
  AVFrame* frame = av_frame_alloc();
  frame->width = width;
  frame->height = height;
  frame->format = codec.pix_fmt;
  frame->pts = times[index];
  av_frame_get_buffer(frame, 0);
  const auto fill = [&](int plane, int rows, std::size_t columns, int level) {
    for (int y = 0; y < rows; ++y) {
      std::memset(frame->data[plane] + y * frame->linesize[plane], level, columns);
    }
  };
  const auto columns = static_cast<std::size_t>(width);
  fill(0, height, columns, levels[index]);
  fill(0, height / 4, columns / 4, 235);
  for (const int plane : {1, 2}) fill(plane, height / 2, columns / 2, 128);
  return frame;
}

inline void VideoFile::Write(const std::filesystem::path& path) const {
  Muxer muxer(path);
  const bool global_header = (muxer.format->oformat->flags & AVFMT_GLOBALHEADER) != 0;
  AVCodecContext* codec = OpenEncoder(global_header);
  avcodec_parameters_from_context(muxer.stream->codecpar, codec);
  muxer.stream->time_base = tick;
  muxer.stream->avg_frame_rate = codec->framerate;
  if (display != std::array<std::int32_t, 4>{}) {
    constexpr std::int32_t kOne = 1 << 16;
    std::array<std::int32_t, 9> matrix = {};
    for (const std::size_t i : {0U, 1U}) {
      matrix[i] = display[i] * kOne;
      matrix[3 + i] = display[2 + i] * kOne;
    }
    matrix[8] = 1 << 30;
    auto* data = av_stream_new_side_data(muxer.stream, AV_PKT_DATA_DISPLAYMATRIX, sizeof(matrix));
    std::memcpy(data, matrix.data(), sizeof(matrix));
  }
  EXPECT_GE(avformat_write_header(muxer.format, nullptr), 0);
  for (std::size_t i = 0; i < times.size(); ++i) {
    AVFrame* frame = Picture(*codec, i);
    Encode(codec, frame, muxer);
    av_frame_free(&frame);
  }
  Encode(codec, nullptr, muxer);
  avcodec_free_context(&codec);
}

}  // namespace plumbline
