// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/folder_lock.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

// List of the files that a run wrote into a folder, in JSON beside them. Later runs replace or
// remove only listed files.
constexpr const char* kRunList = ".plumbline-run";

// Returns true for names of a run's files: trajectory.txt, trajectory_map2.txt, overlay_000010.png
// and so on.
bool IsRunFile(const std::string& name);

// Returns the names listed in a folder, ascending; nullopt if it has no list. Names that no run
// uses are left out. Throws InputError "<file>: expected ..., found ..." for an invalid list.
std::optional<std::vector<std::string>> ReadRunList(const std::filesystem::path& folder);

// Replaces the list of a folder. Throws WriteError.
void WriteRunList(const std::filesystem::path& folder, std::vector<std::string> names);

// A file of a run's results: its name, and the function that writes it to a path.
struct RunFile {
  std::string name;
  std::function<void(const std::filesystem::path&)> write;
};

// What an earlier run left in its folder.
struct EarlierRun {
  std::size_t poses = 0;  // rows of trajectory.txt
  std::string data;       // "data" of summary.json; empty where that cannot be read
};

// A file or folder that a run reads.
struct RunInput {
  std::filesystem::path path;
  // True if it is read completely before anything is replaced.
  bool may_lie_in_out = false;
};

// Throws InputError, with advice, if the folder for results is, contains or lies in an input.
// Changes nothing.
void CheckApart(const std::filesystem::path& out, std::span<const RunInput> inputs);

// Throws InputError, naming the option, if an output file is or lies in an input, so that it would
// replace data. Changes nothing.
void CheckFileApart(std::string_view option,
                    const std::filesystem::path& file,
                    std::span<const RunInput> inputs);

// Throws InputError, naming the option, if an additional output file has the path of a result in
// the folder `out`, or lies in the folder's part. Changes nothing.
void CheckNoResult(std::string_view option,
                   const std::filesystem::path& file,
                   const std::filesystem::path& out);

// The folder of a run's results (--out DIR), protected against losses.
//
// A run writes into DIR/.part. Commit() writes the list of its files there: from then on they are
// complete, take the places of the earlier run's files, which DIR's list names, and last the list
// takes the place of DIR's. Other files are never touched. Killed at any moment, a run leaves the
// earlier results unchanged and its own in DIR/.part, or complete results, which the next RunFolder
// in DIR moves into place. What a killed run left in DIR/.part is kept as DIR/interrupted-1, -2 and
// so on, unless no frame got a pose. One program at a time works in DIR (FolderLock).
class RunFolder {
 public:
  // Creates DIR if it is missing, and DIR/.part. Throws InputError, with advice, if another run
  // writes there, if DIR has files with names of results that no run wrote, or if it cannot be
  // written to; files of the user are then unchanged.
  explicit RunFolder(std::filesystem::path folder);
  // Removes what it created in DIR, unless Keep() was called.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }
  // The folder of the files until Commit().
  const std::filesystem::path& part() const { return part_; }
  // Notes about killed runs, one sentence each.
  const std::vector<std::string>& notes() const { return notes_; }

  // Marks the part as worth keeping.
  void Keep() { keep_ = true; }

  // Writes a file into the part, which is made again if it was removed; returns true on success. A
  // failure is recorded for Failures(), so that later files are still written.
  bool Write(const RunFile& file);
  // Returns "cannot write DIR/map.plb: <reason>; report.html: <reason>" in one line; nullopt if all
  // were written.
  std::optional<std::string> Failures() const;

  // Returns true if Commit() would replace complete results by incomplete ones.
  bool WouldLose() const;

  // The earlier run whose results DIR has; nullopt where it has none with poses.
  std::optional<EarlierRun> Earlier() const;

  // Makes the files that Write() wrote the results in DIR; removes the earlier run's files and the
  // part. If Write() failed to write frames.csv, or the causal trajectory of a run with one map,
  // those of the journal (RunJournal) are taken. On a full disk the last files make room for the
  // list. Throws InputError if that is impossible, for instance because a file with the name of a
  // result appeared in DIR meanwhile; the files are then in the part, or some of them already in
  // DIR.
  void Commit();

 private:
  struct Failure {
    std::string name;
    std::string why;
  };

  void Open();
  void SetPartAside();
  void RemoveFolders();

  std::filesystem::path folder_;
  std::filesystem::path part_;
  std::vector<std::filesystem::path> made_;  // folders created, outermost first
  std::optional<FolderLock> lock_;
  std::vector<std::string> notes_;
  std::vector<std::string> written_;  // names, in the order of Write()
  std::vector<Failure> failures_;
  bool keep_ = false;
};

}  // namespace plumbline
