// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/frame_record.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <string>
#include <vector>

namespace plumbline {

// Numbers recurring words, so that each can be stored as a small number.
class WordTable {
 public:
  // Returns the number of a word; a new word gets the next free number.
  std::size_t NumberOf(const std::string& word);
  bool Contains(const std::string& word) const;
  std::size_t size() const { return words_.size(); }
  const std::string& operator[](std::size_t number) const { return words_[number]; }

 private:
  std::vector<std::string> words_;
};

// Stores the records of all frames of a run in order, in little memory: 176 bytes a frame, 168
// for the covariance of a pose, and 5 for each time. An hour with 30 frames a second and ten times
// each takes 43 MB. Times are rounded to single precision, and only the upper triangle of a
// covariance is stored; everything else is exact.
//
// The log is used like a vector, but makes its elements on demand.
class FrameLog {
 public:
  FrameLog() = default;
  FrameLog(std::initializer_list<FrameRecord> records);

  // Returns true if the log can add the record: its id must be the number of records so far, and
  // its words must fit (256 different stages, 65,536 different reasons).
  bool Takes(const FrameRecord& record) const;
  // Adds a record at the end; throws BugError if Takes() is false.
  void Add(const FrameRecord& record);
  // Applies `change` to the record of a frame; its id and times do not change.
  void Change(std::size_t frame, const std::function<void(FrameRecord&)>& change);
  // Adds times to the last frame, for work that ended after its record was added.
  void AddTimes(const std::vector<StageTime>& times);

  std::size_t size() const { return entries_.size(); }
  bool empty() const { return entries_.size() == 0; }
  FrameRecord operator[](std::size_t frame) const;
  FrameRecord front() const { return (*this)[0]; }
  FrameRecord back() const { return (*this)[size() - 1]; }

  // Returns a single field without making the whole record.
  std::int64_t StampOf(std::size_t frame) const { return entries_[frame].stamp_ns; }
  FrameStatus StatusOf(std::size_t frame) const {
    return static_cast<FrameStatus>(entries_[frame].status);
  }
  KeyFrameId ReferenceOf(std::size_t frame) const { return KeyFrameId{entries_[frame].reference}; }

  class const_iterator {
   public:
    // Elements are made on access, so that no reference to one exists.
    using iterator_category = std::input_iterator_tag;
    using value_type = FrameRecord;
    using difference_type = std::ptrdiff_t;
    using pointer = const FrameRecord*;
    using reference = FrameRecord;

    const_iterator(const FrameLog& log, std::size_t frame) : log_(&log), frame_(frame) {}
    FrameRecord operator*() const { return (*log_)[frame_]; }
    const_iterator& operator++() {
      ++frame_;
      return *this;
    }
    const_iterator operator++(int) { return {*log_, frame_++}; }
    friend bool operator==(const const_iterator&, const const_iterator&) = default;

   private:
    const FrameLog* log_;
    std::size_t frame_;
  };
  const_iterator begin() const { return {*this, 0}; }
  const_iterator end() const { return {*this, size()}; }

  // Returns the memory of the log in bytes.
  std::size_t Memory() const;

 private:
  using Numbers = std::array<double, 7>;    // rotation (4) and translation (3) of a Rigid3
  using Triangle = std::array<double, 21>;  // upper triangle of a covariance, row by row
  struct Compact {
    std::int64_t stamp_ns = 0;
    Numbers from_reference{};
    double scale = 1;
    Numbers causal{};
    std::int64_t reference = -1;
    std::uint32_t first_time = 0;  // index of the first of its times in milliseconds_
    std::int32_t map = -1;
    std::int32_t covariance = -1;  // index in covariances_; -1: none
    std::array<std::int32_t, 4> counts{};
    std::uint16_t reason = 0;
    std::uint8_t status = 0, shed = 0;
    bool keyframe : 1 = false;
    bool demoted : 1 = false;
    bool has_causal : 1 = false;
  };
  // A list that grows without moving its elements.
  template <class T>
  class Chunks {
   public:
    static constexpr std::size_t kChunk = 1024;

    void Add(const T& item) {
      if (chunks_.empty() || chunks_.back().size() == kChunk)
        chunks_.emplace_back().reserve(kChunk);
      chunks_.back().push_back(item);
    }
    std::size_t size() const {
      return chunks_.empty() ? 0 : (chunks_.size() - 1) * kChunk + chunks_.back().size();
    }
    T& operator[](std::size_t i) { return chunks_[i / kChunk][i % kChunk]; }
    const T& operator[](std::size_t i) const { return chunks_[i / kChunk][i % kChunk]; }
    std::size_t Memory() const {
      return chunks_.size() * (sizeof(std::vector<T>) + kChunk * sizeof(T));
    }

   private:
    std::vector<std::vector<T>> chunks_;
  };

  static Numbers NumbersOf(const Rigid3& pose);
  static Rigid3 PoseOf(const Numbers& numbers);
  static Triangle TriangleOf(const Matrix6d& covariance);
  static Matrix6d CovarianceOf(const Triangle& triangle);
  void Store(const FrameRecord& record, Compact& entry);

  Chunks<Compact> entries_;
  Chunks<Triangle> covariances_;
  Chunks<std::uint8_t> stages_;  // one entry for each time in milliseconds_
  Chunks<float> milliseconds_;
  WordTable stage_names_, reasons_;
};

}  // namespace plumbline
