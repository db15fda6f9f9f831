// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/folder_lock.h"
#include "plumbline/report/run_manifest.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

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
  // True if it is read whole before anything is replaced.
  bool may_lie_in_out = false;
};

// Throws InputError, which says what to do, when a folder for results is, holds or lies in
// something that is read. Changes nothing.
void CheckApart(const std::filesystem::path& out, std::span<const RunInput> inputs);

// Throws InputError, which names the option, when a file that a run is to write is or lies in
// something that is read, so that it would replace data. Changes nothing.
void CheckFileApart(std::string_view option,
                    const std::filesystem::path& file,
                    std::span<const RunInput> inputs);

// Throws InputError, which names the option, when a file that a run is to write beside its results
// has the place of one of these in the folder `out`, or lies in the folder's part. Changes nothing.
void CheckNoResult(std::string_view option,
                   const std::filesystem::path& file,
                   const std::filesystem::path& out);

// The folder of a run's results (--out DIR), of which nothing is lost.
//
// A run writes into DIR/.part. At the end Commit() puts its files in the places of those of an
// earlier run, which the manifest of DIR lists (RunManifest); what it does not list is never
// touched. Killed at any moment, a run leaves the earlier results as they were and its own in
// DIR/.part, or, from the first step of Commit() on, its own whole: the next RunFolder in DIR
// completes the exchange. What a run that was killed before left in DIR/.part is kept as
// DIR/interrupted-1, -2 and so on, unless it had not got to a frame. One program at a time works in
// DIR (FolderLock).
class RunFolder {
 public:
  // Makes DIR where it is missing, and DIR/.part. Throws InputError, which says what to do, when
  // another run writes there, when DIR has files with names of results that no run wrote, or when
  // it cannot be written to; DIR then is as it was.
  explicit RunFolder(std::filesystem::path folder);
  // Removes what it made in DIR, unless Keep() was called.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }
  // The folder that has the files until Commit().
  const std::filesystem::path& part() const { return part_; }
  // Notes about runs that were killed, one sentence each.
  const std::vector<std::string>& notes() const { return notes_; }

  // Tells that the part holds something of worth from now on.
  void Keep() { keep_ = true; }

  // Makes the folders again where somebody removed them. Throws InputError when that fails.
  void Restore();

  // Writes a file into the part, and returns whether that succeeded. A failure is kept for
  // Failures(), so that later files are written all the same.
  bool Write(const RunFile& file);
  // Returns "cannot write DIR/map.plb, report.html: <reason>" in one line; nullopt if all could be
  // written.
  std::optional<std::string> Failures() const;

  // Removes from the part the files of a run that are not among `names`.
  void KeepOnly(const std::vector<std::string>& names) const;

  // Whether Commit() would replace complete results by some that lack files.
  bool WouldLose() const;

  // The earlier run whose results DIR has; nullopt where it has none with poses.
  std::optional<EarlierRun> Earlier() const;

  // Moves the files of the part into DIR, removes those of the earlier run, then the part. Throws
  // InputError when that is impossible, for instance because DIR has got a file of such a name
  // meanwhile; the files are then in the part, or some of them already in DIR.
  void Commit();

 private:
  struct Failure {
    std::string name;
    std::string why;
  };

  void Open();
  void TakeCareOfPart();
  void StartPart();
  void RemoveFolders();

  std::filesystem::path folder_;
  std::filesystem::path part_;
  std::vector<std::filesystem::path> made_;  // folders that were not there before, outermost first
  std::optional<FolderLock> lock_;
  std::vector<std::string> notes_;
  std::vector<Failure> failures_;
  bool keep_ = false;
  bool part_made_ = false;
};

}  // namespace plumbline
