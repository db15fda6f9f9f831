// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "place_rivals.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/random.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <set>
#include <string_view>
#include <utility>

namespace plumbline {
namespace {

template <class Feature>
std::vector<Descriptor> Strongest(const std::vector<Feature>& features, std::size_t most) {
  std::vector<const Feature*> order;
  for (const Feature& feature : features) order.push_back(&feature);
  std::stable_sort(order.begin(), order.end(), [](const Feature* a, const Feature* b) {
    return a->response > b->response;
  });
  if (order.size() > most) order.resize(most);
  std::vector<Descriptor> descriptors;
  for (const Feature* feature : order) descriptors.push_back(feature->descriptor);
  return descriptors;
}

// Points, lines: as many as PlaceIndex takes.
using Taken = std::array<std::vector<Descriptor>, 2>;
Taken Take(const Features& features) {
  return {Strongest(features.points, PlaceIndex::kPoints),
          Strongest(features.lines, PlaceIndex::kLines)};
}

bool BitOf(const Descriptor& descriptor, std::size_t bit) {
  return (descriptor[bit / 64] >> (bit % 64) & 1U) != 0;
}

std::vector<PlaceCandidate> Ranked(const std::map<KeyFrameId, double>& scores) {
  std::vector<PlaceCandidate> candidates;
  for (const auto& [id, score] : scores) candidates.push_back({id, score});
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return a.score > b.score;
  });
  return candidates;
}

int ClearPartners(const std::vector<Descriptor>& image, const std::vector<Descriptor>& keyframe) {
  int count = 0;
  for (const Descriptor& descriptor : image) {
    int best = 257, second = 257;
    for (const Descriptor& other : keyframe) {
      const int distance = HammingDistance(descriptor, other);
      second = std::min(second, std::max(distance, best));
      best = std::min(best, distance);
    }
    count += best <= 50 && best < 0.85 * second ? 1 : 0;
  }
  return count;
}

// Words of one kind of features.
class WordTables {
 public:
  WordTables(int tables, int bits, std::string_view kind)
      : tables_(static_cast<std::size_t>(tables)) {
    for (std::size_t t = 0; t < tables_.size(); ++t) {
      Rng rng(1, kind, t);
      std::vector<std::size_t> order(256);
      for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
      rng.Shuffle(order);
      order.resize(static_cast<std::size_t>(bits));
      bits_.push_back(order);
    }
  }

  void Add(KeyFrameId id, const std::vector<Descriptor>& descriptors) {
    for (std::size_t t = 0; t < tables_.size(); ++t) {
      for (const Descriptor& descriptor : descriptors) tables_[t][Word(t, descriptor)].insert(id);
    }
  }

  void Vote(const std::vector<Descriptor>& descriptors,
            double keyframes,
            std::map<KeyFrameId, double>* votes,
            double* all) const {
    for (std::size_t t = 0; t < tables_.size(); ++t) {
      for (const Descriptor& descriptor : descriptors) {
        const auto word = tables_[t].find(Word(t, descriptor));
        const double count =
            word == tables_[t].end() ? 0 : static_cast<double>(word->second.size());
        const double rarity = math::Log1p(keyframes / (1 + count));
        *all += rarity;
        if (count == 0) continue;
        for (const KeyFrameId id : word->second) (*votes)[id] += rarity;
      }
    }
  }

 private:
  std::uint32_t Word(std::size_t table, const Descriptor& descriptor) const {
    std::uint32_t word = 0;
    for (const std::size_t bit : bits_[table])
      word = word << 1U | (BitOf(descriptor, bit) ? 1U : 0U);
    return word;
  }

  std::vector<std::vector<std::size_t>> bits_;
  std::vector<std::map<std::uint32_t, std::set<KeyFrameId>>> tables_;
};

class FullTree {
 public:
  void Add(KeyFrameId id, const Descriptor& descriptor) {
    Node& leaf = nodes_[LeafOf(descriptor)];
    leaf.entries.emplace_back(id, descriptor);
    if (leaf.entries.size() > kLeaf) Split(static_cast<std::size_t>(&leaf - nodes_.data()));
  }

  std::set<KeyFrameId> Alike(const Descriptor& descriptor) const {
    std::set<KeyFrameId> alike;
    for (const auto& [id, other] : nodes_[LeafOf(descriptor)].entries) {
      if (HammingDistance(descriptor, other) <= 25) alike.insert(id);
    }
    return alike;
  }

 private:
  static constexpr std::size_t kLeaf = 100;
  struct Node {
    std::size_t bit = 0;
    std::size_t children = 0;  // 0: a leaf
    std::vector<std::pair<KeyFrameId, Descriptor>> entries;
  };

  std::size_t LeafOf(const Descriptor& descriptor) const {
    std::size_t node = 0;
    while (nodes_[node].children != 0) {
      node = nodes_[node].children + (BitOf(descriptor, nodes_[node].bit) ? 1 : 0);
    }
    return node;
  }

  // Divides a leaf by the bit that is set in nearest to half of its descriptors. A leaf whose
  // descriptors are all equal stays whole.
  void Split(std::size_t node) {
    const auto entries = nodes_[node].entries;
    const auto size = static_cast<std::ptrdiff_t>(entries.size());
    std::pair<std::ptrdiff_t, std::size_t> best{size, 0};
    for (std::size_t bit = 0; bit < 256; ++bit) {
      const auto set = std::count_if(entries.begin(), entries.end(), [&](const auto& entry) {
        return BitOf(entry.second, bit);
      });
      best = std::min(best, std::pair(std::abs(2 * set - size), bit));
    }
    if (best.first == size) return;
    nodes_[node].bit = best.second;
    nodes_[node].children = nodes_.size();
    nodes_[node].entries.clear();
    nodes_.resize(nodes_.size() + 2);
    for (const auto& entry : entries) {
      nodes_[nodes_[node].children + (BitOf(entry.second, best.second) ? 1 : 0)].entries.push_back(
          entry);
    }
  }

  std::vector<Node> nodes_ = std::vector<Node>(1);
};

}  // namespace

PlaceMethod OurIndex(bool points, bool lines) {
  const auto index = std::make_shared<PlaceIndex>();
  const auto restricted = [points, lines](Features features) {
    if (!points) features.points.clear();
    if (!lines) features.lines.clear();
    return features;
  };
  return {points && lines ? "PlaceIndex"
          : points        ? "its points alone"
                          : "its lines alone",
          [=](KeyFrameId id, const Features& features) { index->Add(id, restricted(features)); },
          [=](const Features& features) {
            return index->Query(
                restricted(features), index->size(), [](KeyFrameId) { return true; });
          }};
}

PlaceMethod BruteForce() {
  const auto keyframes = std::make_shared<std::map<KeyFrameId, Taken>>();
  return {"brute force",
          [=](KeyFrameId id, const Features& features) { (*keyframes)[id] = Take(features); },
          [=](const Features& features) {
            const Taken image = Take(features);
            const double all =
                std::max(1.0, static_cast<double>(image[0].size() + image[1].size()));
            std::map<KeyFrameId, double> scores;
            for (const auto& [id, taken] : *keyframes) {
              scores[id] =
                  (ClearPartners(image[0], taken[0]) + ClearPartners(image[1], taken[1])) / all;
            }
            return Ranked(scores);
          }};
}

PlaceMethod HashedWords(int tables, int bits) {
  struct State {
    WordTables points, lines;
    double keyframes = 0;
  };
  const auto state = std::make_shared<State>(
      State{WordTables(tables, bits, "points"), WordTables(tables, bits, "lines")});
  return {std::to_string(tables) + " tables of " + std::to_string(bits) + " bits",
          [=](KeyFrameId id, const Features& features) {
            const Taken taken = Take(features);
            state->points.Add(id, taken[0]);
            state->lines.Add(id, taken[1]);
            ++state->keyframes;
          },
          [=](const Features& features) {
            const Taken taken = Take(features);
            std::map<KeyFrameId, double> votes;
            double all = 1e-9;
            state->points.Vote(taken[0], state->keyframes, &votes, &all);
            state->lines.Vote(taken[1], state->keyframes, &votes, &all);
            for (auto& [id, score] : votes) score /= all;
            return Ranked(votes);
          }};
}

PlaceMethod BinarySearchTree() {
  const auto trees = std::make_shared<std::array<FullTree, 2>>();
  return {"HBST",
          [=](KeyFrameId id, const Features& features) {
            const Taken taken = Take(features);
            for (std::size_t kind = 0; kind < 2; ++kind) {
              for (const Descriptor& descriptor : taken[kind]) (*trees)[kind].Add(id, descriptor);
            }
          },
          [=](const Features& features) {
            const Taken taken = Take(features);
            std::map<KeyFrameId, double> votes;
            double all = 0;
            for (std::size_t kind = 0; kind < 2; ++kind) {
              for (const Descriptor& descriptor : taken[kind]) {
                ++all;
                for (const KeyFrameId id : (*trees)[kind].Alike(descriptor)) ++votes[id];
              }
            }
            for (auto& [id, score] : votes) score /= std::max(all, 1.0);
            return Ranked(votes);
          }};
}

}  // namespace plumbline
