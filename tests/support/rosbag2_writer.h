// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <sqlite3.h>
#include <zstd.h>

namespace plumbline {

inline std::string PackedByZstd(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1));
  return packed;
}

// Packs a file like `ros2 bag record --compression-mode file`: NAME becomes NAME.zstd.
inline void PackFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  std::ofstream(path.string() + ".zstd", std::ios::binary) << PackedByZstd(bytes.str());
  std::filesystem::remove(path);
}

// Writes .db3 files like the recorders of ROS 2.
class Rosbag2Writer {
 public:
  enum class Version { kFoxy, kJazzy };  // the oldest and the newest tables

  explicit Rosbag2Writer(const std::filesystem::path& path, Version version = Version::kJazzy)
      : version_(version) {
    std::filesystem::create_directories(path.parent_path());
    if (sqlite3_open(path.c_str(), &database_) != SQLITE_OK) throw std::runtime_error("no file");
    const bool old = version == Version::kFoxy;
    if (!old) {
      Do("CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL)");
      Do("INSERT INTO schema VALUES (4, 'jazzy')");
      Do("CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, "
         "metadata TEXT NOT NULL)");
    }
    Do(std::string("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT "
                   "NULL, serialization_format TEXT NOT NULL") +
       (old ? ")" : ", offered_qos_profiles TEXT NOT NULL, type_description_hash TEXT NOT NULL)"));
    Do("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER "
       "NOT NULL, data BLOB NOT NULL)");
    Do("CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
  }
  Rosbag2Writer(const Rosbag2Writer&) = delete;
  Rosbag2Writer& operator=(const Rosbag2Writer&) = delete;
  ~Rosbag2Writer() { sqlite3_close_v2(database_); }

  void Do(const std::string& sql) {
    char* why = nullptr;
    if (sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, &why) == SQLITE_OK) return;
    throw std::runtime_error(sql + ": " + (why == nullptr ? "" : why));
  }

  void Add(const std::string& topic,
           const std::string& type,
           std::int64_t time_ns,
           const std::string& message) {
    const auto [known, added] = topics_.try_emplace({topic, type}, topics_.size() + 1);
    if (added) {
      Do("INSERT INTO topics VALUES (" + std::to_string(known->second) + ", '" + topic + "', '" +
         type + "', 'cdr'" + (version_ == Version::kFoxy ? ")" : ", '', 'RIHS01_0')"));
    }
    sqlite3_stmt* insert = nullptr;
    sqlite3_prepare_v2(database_,
                       "INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)",
                       -1,
                       &insert,
                       nullptr);
    sqlite3_bind_int64(insert, 1, static_cast<std::int64_t>(known->second));
    sqlite3_bind_int64(insert, 2, time_ns);
    sqlite3_bind_blob(
        insert, 3, message.data(), static_cast<int>(message.size()), SQLITE_TRANSIENT);
    if (sqlite3_step(insert) != SQLITE_DONE) throw std::runtime_error("not inserted");
    sqlite3_finalize(insert);
  }

 private:
  Version version_;
  sqlite3* database_ = nullptr;
  std::map<std::pair<std::string, std::string>, std::size_t> topics_;
};

// metadata.yaml with these files.
inline std::string Rosbag2Metadata(const std::vector<std::string>& files) {
  std::string text =
      "rosbag2_bagfile_information:\n  version: 9\n  storage_identifier: sqlite3\n"
      "  relative_file_paths:\n";
  for (const std::string& file : files) text += "    - " + file + "\n";
  return text + "  compression_format: \"\"\n  compression_mode: \"\"\n";
}

}  // namespace plumbline
