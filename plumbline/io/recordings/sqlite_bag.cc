// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"
#include "plumbline/io/recordings/image_message.h"
#include "plumbline/io/recordings/recording_formats.h"
#include "plumbline/io/recordings/temporary_folder.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sqlite3.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 2> kJournals = {"-wal", "-journal"};

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;

struct EndStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, EndStatement>;

// Returns a URI of the file, in which no character has a meaning.
std::string UriOf(const fs::path& path) {
  std::string uri = "file:";
  for (const char letter : fs::absolute(path).string()) {
    const auto byte = static_cast<unsigned char>(letter);
    const bool plain = std::isalnum(byte) != 0 || std::strchr("/._-", letter) != nullptr;
    uri += plain && byte < 128 ? std::string(1, letter) : fmt::format("%{:02X}", byte);
  }
  return uri;
}

Database Open(const std::string& uri, int flags) {
  sqlite3* opened = nullptr;
  const int status =
      sqlite3_open_v2(uri.c_str(), &opened, flags | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
  Database database(opened);
  return status == SQLITE_OK ? std::move(database) : nullptr;
}

// Opens an unchanging file: SQLite neither locks it nor searches for a journal.
Database OpenAsItIs(const fs::path& path) {
  Database database = Open(UriOf(path) + "?mode=ro&immutable=1", SQLITE_OPEN_READONLY);
  if (database == nullptr) return nullptr;
  // Code in the file is never executed.
  for (const int feature : {SQLITE_DBCONFIG_ENABLE_TRIGGER, SQLITE_DBCONFIG_ENABLE_VIEW}) {
    sqlite3_db_config(database.get(), feature, 0, nullptr);
  }
  sqlite3_db_config(database.get(), SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_limit(database.get(), SQLITE_LIMIT_LENGTH, static_cast<int>(kLargestChunk));
  // SQLite refuses a file that is shorter than it says, unless the schema may be written.
  sqlite3_exec(database.get(), "PRAGMA writable_schema=ON", nullptr, nullptr, nullptr);
  return database;
}

Statement Prepare(sqlite3* database, const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(database, sql.c_str(), static_cast<int>(sql.size()), &statement, nullptr);
  return Statement(statement);
}

std::string TextAt(sqlite3_stmt* row, int column) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return text == nullptr ? "" : std::string(text, sqlite3_column_bytes(row, column));
}

std::span<const std::uint8_t> BytesAt(sqlite3_stmt* row, int column) {
  const auto* bytes = static_cast<const std::uint8_t*>(sqlite3_column_blob(row, column));
  const int size = bytes == nullptr ? 0 : sqlite3_column_bytes(row, column);
  return {bytes, static_cast<std::size_t>(size)};
}

// Returns the journals beside a file that are not empty.
std::vector<fs::path> JournalsOf(const fs::path& path) {
  std::vector<fs::path> journals;
  for (const char* ending : kJournals) {
    std::error_code error;
    const fs::path journal = path.string() + ending;
    const auto size = fs::file_size(journal, error);
    if (!error && size > 0) journals.push_back(journal);
  }
  return journals;
}

// Returns a state that reveals changes of a file.
std::pair<std::uintmax_t, fs::file_time_type> StateOf(const fs::path& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  return {size, fs::last_write_time(path, error)};
}

// Copies the file and its journals, again if a recorder has changed one of them meanwhile. Returns
// the copy, or nullopt if there is no room for it.
std::optional<fs::path> CopyWithJournals(const fs::path& path,
                                         const std::vector<fs::path>& journals,
                                         const fs::path& folder) {
  constexpr int kMostTries = 5;
  const fs::path copy = folder / "bag.db3";
  std::vector<fs::path> files = {path};
  files.insert(files.end(), journals.begin(), journals.end());
  std::error_code error;
  std::uintmax_t size = 0;
  for (const fs::path& file : files) size += fs::file_size(file, error);
  if (fs::space(folder, error).available / 2 < size || error) return std::nullopt;
  for (int tried = 0; tried < kMostTries; ++tried) {
    std::vector<std::pair<std::uintmax_t, fs::file_time_type>> before, after;
    for (const fs::path& file : files) before.push_back(StateOf(file));
    for (const fs::path& file : files) {
      const std::string ending = file.string().substr(path.string().size());
      fs::copy_file(file, copy.string() + ending, fs::copy_options::overwrite_existing, error);
      if (error) return std::nullopt;
    }
    for (const fs::path& file : files) after.push_back(StateOf(file));
    if (before == after) break;
  }
  return copy;
}

// Plays the journal of a copy back into it.
void TakeJournalIn(const fs::path& copy) {
  const Database database = Open(UriOf(copy), SQLITE_OPEN_READWRITE);
  if (database == nullptr) return;
  sqlite3_db_config(database.get(), SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  for (const char* command : {"SELECT count(*) FROM sqlite_master", "PRAGMA journal_mode=DELETE"}) {
    sqlite3_exec(database.get(), command, nullptr, nullptr, nullptr);
  }
}

// Evidence that a file was truncated.
struct Cut {
  bool nothing = false;         // it has no bytes
  bool short_of_pages = false;  // it has fewer bytes than the pages that its header counts
  bool inside_a_page = false;   // its last page, which SQLite fills up with zeros, is not whole
};

Cut CutOf(const fs::path& path) {
  std::array<unsigned char, 32> header{};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(header.data()), header.size())) {
    return {file.gcount() == 0, true, true};
  }
  const auto number = [&](std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = at; i < at + size; ++i) value = value << 8U | header[i];
    return value;
  };
  const std::uint64_t page = number(16, 2) == 1 ? 65536 : number(16, 2);
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  return {false, number(28, 4) * page > size, page == 0 || size % page != 0};
}

class SqliteBag : public Recording {
 public:
  SqliteBag(const fs::path& path, const fs::path& name) : Recording(name.empty() ? path : name) {
    CheckIsFile(path);
    const std::vector<fs::path> journals = JournalsOf(path);
    fs::path opened = path;
    std::optional<TemporaryFolder> folder;
    if (!journals.empty()) {
      folder.emplace();
      const std::string journal = journals.front().filename().string();
      if (const auto copy = CopyWithJournals(path, journals, folder->path())) {
        TakeJournalIn(*copy);
        opened = *copy;
        AddNote(
            fmt::format("{} lies beside {}: it is being recorded, or its recorder did not end "
                        "well; what both have so far is read",
                        journal,
                        this->path().filename().string()));
      } else {
        AddNote(
            fmt::format("{} is left out: there is no room for a copy of it and of {} in {} "
                        "(TMPDIR names another folder)",
                        journal,
                        this->path().filename().string(),
                        folder->path().parent_path().string()));
      }
    }
    cut_ = CutOf(opened);
    database_ = OpenAsItIs(opened);  // a temporary file may go when it is open
    if (database_ == nullptr) throw InputError(this->path().string() + ": cannot be read");
  }

  void Read(const MessageSink& sink) {
    ReadTopics();
    std::vector<std::int64_t> wanted;
    for (const auto& [topic, channel] : channel_of_topic_) {
      if (FormOf(channels()[channel])) wanted.push_back(topic);
    }
    const std::string from = "SELECT rowid, topic_id, timestamp, data FROM messages WHERE ";
    const Statement rows =
        Prepared(from + fmt::format("rowid > ? AND topic_id IN ({}) ORDER BY rowid",
                                    fmt::join(wanted, ", ")));
    bool damaged = cut_.short_of_pages;
    // Behind a fault, the next row that can be read is looked for in longer and longer steps.
    constexpr std::int64_t kLongestStep = std::int64_t{1} << 40;
    std::int64_t last = -1;
    for (std::int64_t step = 1; step < kLongestStep;) {
      sqlite3_reset(rows.get());
      sqlite3_bind_int64(rows.get(), 1, last);
      const std::int64_t before = last;
      if (TakeRows(rows.get(), last, sink)) break;
      damaged = true;
      step = last > before ? 1 : 2 * step;
      if (last > std::numeric_limits<std::int64_t>::max() - step) break;
      last += step;
    }
    if (held_) rows_.pop_back();
    held_.reset();
    if (rows_.empty()) NoteOfNoTopic();
    by_row_ = Prepared("SELECT data FROM messages WHERE rowid = ?");
    if (damaged) {
      AddNote(
          fmt::format("{} is damaged or cut short: {} messages of images and calibrations can "
                      "be read",
                      path().string(),
                      rows_.size()));
    }
  }

  Expected<std::vector<std::uint8_t>, std::string> StoredBytes(
      const StoredMessage& message) const override {
    const std::lock_guard lock(mutex_);
    sqlite3_reset(by_row_.get());
    sqlite3_bind_int64(by_row_.get(), 1, rows_.at(message.chunk));
    if (sqlite3_step(by_row_.get()) != SQLITE_ROW) return std::string("the file has changed");
    const std::span<const std::uint8_t> bytes = BytesAt(by_row_.get(), 0);
    if (bytes.size() != message.size) return std::string("the file has changed");
    return std::vector<std::uint8_t>(bytes.begin(), bytes.end());
  }

 private:
  [[noreturn]] void FailToRead() const {
    const int status = sqlite3_errcode(database_.get());
    const bool cut = cut_.short_of_pages || cut_.inside_a_page;
    const char* found = cut_.nothing              ? "an empty file"
                        : status == SQLITE_NOTADB ? "another file, or one that is damaged"
                        : cut                     ? "a file that ends early"
                        : status == SQLITE_ERROR  ? "an SQLite file without them"
                                                  : "damage";
    throw InputError(path().string() +
                     ": expected the tables topics and messages of a ROS 2 bag, found " + found);
  }

  Statement Prepared(const std::string& sql) const {
    Statement statement = Prepare(database_.get(), sql);
    if (statement == nullptr) FailToRead();
    return statement;
  }

  void ReadTopics() {
    const Statement rows = Prepared("SELECT id, name, type, serialization_format FROM topics");
    int status = SQLITE_ROW;
    while ((status = sqlite3_step(rows.get())) == SQLITE_ROW) {
      Channel channel{TextAt(rows.get(), 1), TextAt(rows.get(), 2), TextAt(rows.get(), 3)};
      const std::int64_t topic = sqlite3_column_int64(rows.get(), 0);
      if (channel_of_topic_.contains(topic)) continue;
      channel_of_topic_[topic] = AddChannel(std::move(channel));
    }
    if (status != SQLITE_DONE) FailToRead();
  }

  // Notes how many messages have a topic that is not described.
  void NoteOfNoTopic() {
    const Statement rows = Prepared(
        "SELECT rowid FROM messages WHERE topic_id NOT IN (SELECT id FROM topics) ORDER BY rowid");
    std::int64_t messages = 0;
    for (std::int64_t last = -1; sqlite3_step(rows.get()) == SQLITE_ROW; ++messages) {
      const std::int64_t row = sqlite3_column_int64(rows.get(), 0);
      if (row <= last) break;  // as in TakeRows
      last = row;
    }
    if (messages == 0) return;
    AddNote(fmt::format("{}: {} messages have a topic_id that the table topics does not list",
                        path().string(),
                        messages));
  }

  // Takes rows, and sets `last` to the number of the last one. Returns false at a fault.
  bool TakeRows(sqlite3_stmt* rows, std::int64_t& last, const MessageSink& sink) {
    int status = SQLITE_ROW;
    while ((status = sqlite3_step(rows)) == SQLITE_ROW) {
      const std::int64_t row = sqlite3_column_int64(rows, 0);
      // Rows of damaged pages come out of order, and might never end.
      if (row <= last || rows_.size() == std::numeric_limits<std::uint32_t>::max()) return false;
      last = row;
      const auto channel = channel_of_topic_.find(sqlite3_column_int64(rows, 1));
      if (channel == channel_of_topic_.end()) continue;  // not written as a number
      const std::span<const std::uint8_t> bytes = BytesAt(rows, 3);
      StoredMessage place;
      place.channel = channel->second;
      place.chunk = static_cast<std::uint32_t>(rows_.size());
      place.size = static_cast<std::uint32_t>(bytes.size());
      place.logged_ns = std::max<std::int64_t>(sqlite3_column_int64(rows, 2), 0);
      rows_.push_back(row);
      if (cut_.inside_a_page) {  // the last message may end with zeros in place of its bytes
        if (held_) sink(channels()[held_->first.channel], held_->first, held_->second);
        held_.emplace(place, std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
      } else {
        sink(channels()[place.channel], place, bytes);
      }
    }
    return status == SQLITE_DONE;
  }

  Cut cut_;
  std::optional<std::pair<StoredMessage, std::vector<std::uint8_t>>> held_;  // not yet handed on
  Database database_;
  Statement by_row_;
  std::map<std::int64_t, std::uint32_t> channel_of_topic_;
  std::vector<std::int64_t> rows_;  // row of each message
  mutable std::mutex mutex_;
};

}  // namespace

bool BeginsAsSqlite(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kSqliteMagic.size() &&
         std::equal(kSqliteMagic.begin(), kSqliteMagic.end(), bytes.begin());
}

std::unique_ptr<Recording> ReadSqliteBag(const fs::path& path,
                                         const MessageSink& sink,
                                         const fs::path& name) {
  auto bag = std::make_unique<SqliteBag>(path, name);
  bag->Read(sink);
  return bag;
}

}  // namespace plumbline
