// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/datasets/open_dataset.h"

#include "dds_peer.h"
#include "messages.h"
#include "ros2_node.h"
#include "tests/support/data_folder.h"
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {

inline const std::vector<std::string> kMonoArguments = {
    "image:=/cam0/image_raw", "-p", "camera:=euroc", "-p", "options.slam.mode:=lockstep"};

inline std::vector<std::string> MonoArguments(const std::vector<std::string>& more) {
  std::vector<std::string> all = kMonoArguments;
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

// A node with one camera, and what speaks to it.
class MonoNodeTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto sequence = FindData("euroc/MH_01_easy_first250");
    if (!sequence) GTEST_SKIP() << "the sequence is not there";
    dataset_ = OpenDataset(*sequence, {});
  }

  // Publishes an image; `shift_ns` is added to its stamp.
  void Publish(dds_entity_t writer, std::size_t index, std::int64_t shift_ns = 0) const {
    const auto frame = dataset_->Read(index);
    ASSERT_TRUE(frame);
    std::vector<std::uint8_t> pixels;
    const DdsImage message = DdsImageOf(frame->left, frame->stamp_ns + shift_ns, pixels);
    dds_write(writer, &message);
  }
  // Publishes one image after the other until the node says `line`.
  [[nodiscard]] bool PublishUntilSaid(dds_entity_t writer,
                                      const Ros2Node& node,
                                      const std::string& line,
                                      std::int64_t shift_ns = 0) const {
    std::size_t index = 0;
    return WaitUntil([&] {
      Publish(writer, index++ % dataset_->size(), shift_ns);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      return node.Said().find(line) != std::string::npos;
    });
  }

  std::unique_ptr<Dataset> dataset_;
};

inline dds_entity_t MakeImageWriter(DdsPeer& peer, const std::string& topic, PeerQos qos = {}) {
  return peer.MakeWriter(topic, sensor_msgs_msg_dds__Image__desc, qos);
}

}  // namespace plumbline
