// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

namespace plumbline {

// A type of Cyclone DDS whose samples are std::vector<std::uint8_t>: they are sent as they are,
// with the four bytes that name the encoding, and need be no message of the type by whose name they
// go. For writers alone.
namespace raw_type {

struct Sample : ddsi_serdata {
  std::vector<std::uint8_t> bytes;  // a multiple of four
};

inline ddsi_serdata* MakeSample(const ddsi_sertype* type, ddsi_serdata_kind kind) {
  auto* sample = new Sample();
  ddsi_serdata_init(sample, type, kind);
  return sample;
}
inline const Sample& Of(const ddsi_serdata* data) { return *static_cast<const Sample*>(data); }

inline const ddsi_serdata_ops& SampleOperations() {
  static const ddsi_serdata_ops operations = [] {
    ddsi_serdata_ops ops{};
    ops.eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; };
    ops.get_size = [](const ddsi_serdata* data) {
      return static_cast<std::uint32_t>(Of(data).bytes.size());
    };
    ops.from_sample = [](const ddsi_sertype* type, ddsi_serdata_kind kind, const void* bytes) {
      ddsi_serdata* data = MakeSample(type, kind);
      auto& own = static_cast<Sample*>(data)->bytes;
      own = *static_cast<const std::vector<std::uint8_t>*>(bytes);
      own.resize((own.size() + 3) / 4 * 4);
      return data;
    };
    ops.to_ser = [](const ddsi_serdata* data, size_t offset, size_t size, void* to) {
      std::memcpy(to, Of(data).bytes.data() + offset, size);
    };
    ops.to_ser_ref = [](const ddsi_serdata* data, size_t offset, size_t size, ddsrt_iovec_t* to) {
      to->iov_base = const_cast<std::uint8_t*>(Of(data).bytes.data()) + offset;
      to->iov_len = size;
      return ddsi_serdata_ref(data);
    };
    ops.to_ser_unref = [](ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); };
    ops.to_untyped = [](const ddsi_serdata* data) { return MakeSample(data->type, SDK_KEY); };
    ops.free = [](ddsi_serdata* data) { delete static_cast<Sample*>(data); };
    ops.print = [](const ddsi_sertype*, const ddsi_serdata*, char* text, size_t size) {
      if (size > 0) *text = 0;
      return size_t{0};
    };
    ops.get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* hash, bool) { *hash = {}; };
    return ops;
  }();
  return operations;
}

inline const ddsi_sertype_ops& TypeOperations() {
  static const ddsi_sertype_ops operations = [] {
    ddsi_sertype_ops ops{};
    ops.version = ddsi_sertype_v0;
    ops.free = [](ddsi_sertype* type) {
      ddsi_sertype_fini(type);
      delete type;
    };
    ops.equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; };
    ops.hash = [](const ddsi_sertype*) { return std::uint32_t{0}; };
    return ops;
  }();
  return operations;
}

// A topic; `type` as DDS names it: "sensor_msgs::msg::dds_::Image_".
inline dds_entity_t MakeTopic(dds_entity_t participant,
                              const std::string& name,
                              const std::string& type) {
  auto* made = new ddsi_sertype();
  ddsi_sertype_init(made, type.c_str(), &TypeOperations(), &SampleOperations(), true);
  return dds_create_topic_sertype(participant, name.c_str(), &made, nullptr, nullptr, nullptr);
}

}  // namespace raw_type
}  // namespace plumbline
