// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/place_index.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "plumbline/loop_closing/signature_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace plumbline {
namespace {

// Weight of a vote by the number of differing bits, in parts of kOne: a parabola that reaches 0 one
// bit beyond the reach.
constexpr std::uint64_t kOne = 256;
using NearnessTable = std::array<std::uint64_t, kSignatureBits + 1>;

constexpr NearnessTable Nearness(std::uint64_t reach) {
  NearnessTable table{};
  const std::uint64_t end = (reach + 1) * (reach + 1);
  for (std::uint64_t d = 0; d <= reach; ++d) table[d] = kOne * (end - d * d) / end;
  return table;
}

// Returns the signatures of the strongest features, the strongest first.
template <class Feature, class ToSignature>
std::vector<Signature> Strongest(const std::vector<Feature>& features,
                                 std::size_t most,
                                 const ToSignature& to_signature) {
  std::vector<std::size_t> order(features.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return features[a].response > features[b].response;
  });
  if (order.size() > most) order.resize(most);
  std::vector<Signature> signatures;
  signatures.reserve(order.size());
  for (const std::size_t i : order) signatures.push_back(to_signature(features[i].descriptor));
  return signatures;
}

std::array<std::vector<Signature>, 2> SignaturesOf(const Features& features) {
  return {Strongest(features.points, PlaceIndex::kPoints, PointSignature),
          Strongest(features.lines, PlaceIndex::kLines, LineSignature)};
}

// Counts the votes of the features of one image. Votes are whole numbers, so that no order changes
// their sum.
class Poll {
 public:
  explicit Poll(std::size_t slots) : nearest_(slots, kNone), votes_(slots, 0) {}

  // Tells that the present feature of the image and one of a keyframe differ in so many bits.
  void Meet(std::uint32_t slot, int distance) {
    if (nearest_[slot] == kNone) met_.push_back(slot);
    nearest_[slot] = std::min(nearest_[slot], static_cast<std::uint8_t>(distance));
  }

  // Gives each keyframe met since the last call the vote of the feature, weighed by their nearness.
  void Count(std::size_t keyframes, const NearnessTable& nearness) {
    const auto all = static_cast<double>(keyframes);
    const auto rarity = static_cast<std::uint64_t>(
        std::llround(kOne * math::Log1p(all / (1 + static_cast<double>(met_.size())))));
    for (const std::uint32_t slot : met_) {
      votes_[slot] += rarity * nearness[nearest_[slot]];
      nearest_[slot] = kNone;
    }
    met_.clear();
    all_ += rarity * kOne;
  }

  double ScoreOf(std::uint32_t slot) const {
    return all_ > 0 ? static_cast<double>(votes_[slot]) / static_cast<double>(all_) : 0;
  }

 private:
  static constexpr std::uint8_t kNone = 255;
  std::vector<std::uint8_t> nearest_;  // nearest distance of the present feature, by slot
  std::vector<std::uint32_t> met_;     // slots that the present feature has met
  std::vector<std::uint64_t> votes_;   // votes of each slot
  std::uint64_t all_ = 0;              // the votes that a keyframe can get at most
};

// Selects the keyframes that may get votes, by slot. `allowed` is called for a keyframe when the
// first feature of it is found near.
class Electorate {
 public:
  Electorate(const std::vector<KeyFrameId>& by_slot, const std::function<bool(KeyFrameId)>& allowed)
      : by_slot_(by_slot), allowed_(allowed), known_(by_slot.size(), Known::kNothing) {}

  // Returns the features of a leaf that may be of an allowed keyframe. Most similar features are of
  // the keyframes around the camera, which are not allowed.
  void Choose(std::span<const FeatureName> leaf, std::vector<FeatureName>* names) const {
    names->resize(leaf.size());
    std::size_t count = 0;
    for (const FeatureName name : leaf) {
      (*names)[count] = name;
      count += known_[name.slot()] != Known::kNotAllowed ? 1 : 0;
    }
    names->resize(count);
  }

  bool Allows(std::uint32_t slot) {
    if (known_[slot] == Known::kNothing) {
      known_[slot] = allowed_(by_slot_[slot]) ? Known::kAllowed : Known::kNotAllowed;
      if (known_[slot] == Known::kAllowed) found_.push_back(slot);
    }
    return known_[slot] == Known::kAllowed;
  }

  // Returns the allowed keyframes that were asked about, in this order.
  const std::vector<std::uint32_t>& found() const { return found_; }

 private:
  enum class Known : std::uint8_t { kNothing, kAllowed, kNotAllowed };
  const std::vector<KeyFrameId>& by_slot_;
  const std::function<bool(KeyFrameId)>& allowed_;
  std::vector<Known> known_;
  std::vector<std::uint32_t> found_;
};

// Keeps the best candidates, the best first; of two equal ones the older comes first.
void KeepBest(std::size_t most, std::vector<PlaceCandidate>* candidates) {
  const auto better = [](const PlaceCandidate& a, const PlaceCandidate& b) {
    return a.score != b.score ? a.score > b.score : a.id < b.id;
  };
  const std::size_t count = std::min(most, candidates->size());
  std::partial_sort(candidates->begin(),
                    candidates->begin() + static_cast<std::ptrdiff_t>(count),
                    candidates->end(),
                    better);
  candidates->resize(count);
}

}  // namespace

// The trees of a kind share the most telling bits among them.
PlaceIndex::Kind::Kind(std::size_t features) : signatures(features) {
  for (std::size_t i = 0; i < kTrees; ++i) {
    trees[i] = SignatureTree(static_cast<int>(i), static_cast<int>(kTrees));
  }
}

void PlaceIndex::Add(KeyFrameId id, const Features& features) {
  PLUMBLINE_CHECK(!Contains(id), "a keyframe twice in an index of places");
  PLUMBLINE_CHECK(id.valid(), "a keyframe without an id in an index of places");
  if (free_slots_.empty()) {
    free_slots_.push_back(static_cast<std::uint32_t>(by_slot_.size()));
    by_slot_.emplace_back();
  }
  const std::uint32_t slot = free_slots_.back();
  free_slots_.pop_back();
  slots_.emplace(id, slot);
  Mark(id, true);
  by_slot_[slot] = id;
  const auto signatures = SignaturesOf(features);
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    Kind& kind = kinds_[k];
    kind.signatures.Set(slot, signatures[k]);
    for (SignatureTree& tree : kind.trees) {
      for (std::size_t i = 0; i < signatures[k].size(); ++i)
        tree.Add(FeatureName::Of(slot, i), kind.signatures);
    }
  }
}

void PlaceIndex::Remove(KeyFrameId id) {
  const auto entry = slots_.find(id);
  if (entry == slots_.end()) return;
  const std::uint32_t slot = entry->second;
  for (Kind& kind : kinds_) {
    const std::size_t count = kind.signatures.Count(slot);
    for (SignatureTree& tree : kind.trees) {
      for (std::size_t i = 0; i < count; ++i)
        tree.Remove(FeatureName::Of(slot, i), kind.signatures);
    }
    kind.signatures.Set(slot, {});
  }
  slots_.erase(entry);
  Mark(id, false);
  by_slot_[slot] = KeyFrameId{};
  free_slots_.push_back(slot);
}

void PlaceIndex::Mark(KeyFrameId id, bool taken) {
  const auto place = static_cast<std::size_t>(id.value);
  if (taken_.size() <= place / kPage) taken_.resize(place / kPage + 1, 0);
  const std::uint64_t bit = std::uint64_t{1} << (place % kPage);
  std::uint64_t& page = taken_[place / kPage];
  page = taken ? page | bit : page & ~bit;
}

std::vector<KeyFrameId> PlaceIndex::Ids() const {
  std::vector<KeyFrameId> ids;
  ids.reserve(slots_.size());
  for (const auto& [id, slot] : slots_) ids.push_back(id);
  return ids;
}

std::vector<PlaceCandidate> PlaceIndex::Query(
    const Features& features,
    std::size_t most,
    const std::function<bool(KeyFrameId)>& allowed) const {
  const auto signatures = SignaturesOf(features);
  return Query(KindsOfSignatures{signatures[0], signatures[1]}, most, allowed);
}

std::vector<PlaceCandidate> PlaceIndex::Query(
    KeyFrameId id, std::size_t most, const std::function<bool(KeyFrameId)>& allowed) const {
  const auto entry = slots_.find(id);
  PLUMBLINE_CHECK(entry != slots_.end(), "a keyframe that an index of places does not have");
  const std::uint32_t slot = entry->second;
  return Query(KindsOfSignatures{kinds_[0].signatures.Of(slot), kinds_[1].signatures.Of(slot)},
               most,
               allowed);
}

std::vector<PlaceCandidate> PlaceIndex::Query(
    const KindsOfSignatures& signatures,
    std::size_t most,
    const std::function<bool(KeyFrameId)>& allowed) const {
  constexpr std::array<int, 2> kReach = {kPointReach, kLineReach};
  constexpr std::array<NearnessTable, 2> kNearness = {Nearness(kPointReach), Nearness(kLineReach)};
  Electorate electorate(by_slot_, allowed);
  Poll poll(by_slot_.size());
  std::vector<FeatureName> names;
  std::vector<Signature> others;
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    const Kind& kind = kinds_[k];
    std::array<std::vector<std::span<const FeatureName>>, kTrees> leaves;
    for (std::size_t t = 0; t < kTrees; ++t) leaves[t] = kind.trees[t].Alike(signatures[k]);
    for (std::size_t i = 0; i < signatures[k].size(); ++i) {
      for (const auto& leaf_of : leaves) {
        electorate.Choose(leaf_of[i], &names);
        kind.signatures.Read(names, &others);
        for (std::size_t j = 0; j < others.size(); ++j) {
          const int distance = HammingDistance(signatures[k][i], others[j]);
          if (distance > kReach[k] || !electorate.Allows(names[j].slot())) continue;
          poll.Meet(names[j].slot(), distance);
        }
      }
      poll.Count(size(), kNearness[k]);
    }
  }
  std::vector<PlaceCandidate> candidates;
  candidates.reserve(electorate.found().size());
  for (const std::uint32_t slot : electorate.found()) {
    candidates.push_back({by_slot_[slot], poll.ScoreOf(slot)});
  }
  KeepBest(most, &candidates);
  return candidates;
}

std::size_t PlaceIndex::Memory() const {
  constexpr std::size_t kMapNode = 48;  // size of a node of a red-black tree
  std::size_t bytes = by_slot_.capacity() * sizeof(KeyFrameId) + slots_.size() * kMapNode +
                      free_slots_.capacity() * sizeof(std::uint32_t) +
                      taken_.capacity() * sizeof(std::uint64_t);
  for (const Kind& kind : kinds_) {
    bytes += kind.signatures.Memory();
    for (const SignatureTree& tree : kind.trees) bytes += tree.Memory();
  }
  return bytes;
}

}  // namespace plumbline
