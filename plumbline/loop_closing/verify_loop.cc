// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/verify_loop.h"

#include "plumbline/base/ids.h"
#include "plumbline/geometry/covariance.h"
#include "plumbline/geometry/symmetric_matrix.h"
#include "plumbline/loop_closing/loop_edge.h"
#include "plumbline/loop_closing/loop_search.h"
#include "plumbline/loop_closing/significance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>

namespace plumbline {
namespace {

constexpr double kFirstGate = 4;  // factor on the 95 % limits of chi2
constexpr double kLastGate = 1.5;
constexpr double kLastRadiusPx = 4;
// Least share of landmarks that counts as found by chance.
constexpr double kLeastShare = 0.02;
constexpr int kLineWeight = 2;  // a line counts as so many points
// Fewest landmarks in view of a neighbour that is worth asking.
constexpr int kLeastTested = 15;
constexpr std::size_t kAsked = 5;  // most neighbours of either keyframe that are asked
// Largest chi2 of the change by neighbours: 99.9 % of seven degrees of freedom.
constexpr double kMaxChange = 24;

int Count(const std::vector<bool>& flags) {
  return static_cast<int>(std::count(flags.begin(), flags.end(), true));
}

int WeightedCount(const AlignmentResult& result) {
  return Count(result.points) + Count(result.sightings) + kLineWeight * Count(result.lines);
}

// Positions of matches in one image, and its cells with predicted landmarks.
class Coverage {
 public:
  explicit Coverage(const RectifiedCamera& camera)
      : camera_(camera), tested_(kColumns * kRows, 0), found_(kColumns * kRows, 0) {}

  void Test(const Eigen::Vector2d& px) { ++tested_[Cell(px)]; }
  void Find(const Eigen::Vector2d& px) {
    ++found_[Cell(px)];
    sum_ += px;
    squares_ += px * px.transpose();
    ++count_;
  }

  int count() const { return count_; }

  // Returns the deviation of the matches along its least axis, as a part of the height of the
  // image.
  double Spread() const {
    if (count_ < 3) return 0;
    const Eigen::Vector2d mean = sum_ / count_;
    const Eigen::Matrix2d covariance = squares_ / count_ - mean * mean.transpose();
    return std::sqrt(std::max(0.0, EigenvaluesOf<2>(covariance)(0))) / camera_.height;
  }

  void AddCells(int& tested, int& supported) const {
    for (std::size_t i = 0; i < tested_.size(); ++i) {
      if (tested_[i] < kTestedInCell) continue;
      ++tested;
      supported += found_[i] > 0;
    }
  }

 private:
  static constexpr int kColumns = 8;
  static constexpr int kRows = 5;
  static constexpr int kTestedInCell = 4;

  std::size_t Cell(const Eigen::Vector2d& px) const {
    const int x = static_cast<int>(px.x() / camera_.width * kColumns);
    const int y = static_cast<int>(px.y() / camera_.height * kRows);
    return Index(std::clamp(y, 0, kRows - 1) * kColumns + std::clamp(x, 0, kColumns - 1));
  }

  const RectifiedCamera& camera_;
  std::vector<int> tested_, found_;
  Eigen::Vector2d sum_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares_ = Eigen::Matrix2d::Zero();
  int count_ = 0;
};

Coverage CoverageOf(const RectifiedCamera& camera,
                    const SearchedImage& search,
                    const Features& features) {
  Coverage coverage(camera);
  for (const auto& point : search.projected_points) {
    if (point) coverage.Test(point->px);
  }
  for (const auto& line : search.projected_lines) {
    if (line) coverage.Test(line->segment.Midpoint());
  }
  for (const LandmarkMatch& match : search.points) {
    coverage.Find(features.points[Index(match.feature)].px);
  }
  for (const LandmarkMatch& match : search.lines) {
    coverage.Find(features.lines[Index(match.feature)].segment.Midpoint());
  }
  return coverage;
}

// Returns the number of lines found under the worst of some wrong shifts of the image.
int ShiftedLines(const FrameFeatures& image,
                 const std::vector<std::optional<ProjectedLine>>& lines,
                 double radius_px) {
  constexpr double kShiftPx = 30;
  ProjectionSearchOptions options;
  options.line_offset_px = radius_px;
  options.line_max_distance = 60;
  const std::vector<bool> none(image.features.lines.size(), false);
  std::size_t most = 0;
  for (const Eigen::Vector2d& way : {Eigen::Vector2d(1, 1),
                                     Eigen::Vector2d(-1, 1),
                                     Eigen::Vector2d(1, -1),
                                     Eigen::Vector2d(-1, -1)}) {
    auto shifted = lines;
    for (auto& line : shifted) {
      if (!line) continue;
      line->segment.start += kShiftPx * way;
      line->segment.end += kShiftPx * way;
    }
    most = std::max(most, MatchProjectedLines(image, shifted, none, options).size());
  }
  return static_cast<int>(most);
}

double Share(int part, int whole) { return static_cast<double>(part) / std::max(1, whole); }

// The numbers of landmarks that a search found and that a wrong relative pose would find.
struct Tally {
  int tested_points = 0, points = 0, shifted_points = 0;
  int tested_lines = 0, lines = 0, shifted_lines = 0;

  double PointShare() const { return std::max(kLeastShare, Share(shifted_points, tested_points)); }
  double LineShare() const { return std::max(kLeastShare, Share(shifted_lines, tested_lines)); }
  double Log10Chance() const {
    return Log10BinomialTail(tested_points, points, PointShare()) +
           Log10BinomialTail(tested_lines, lines, LineShare());
  }
};

Tally TallyOf(const RectifiedCamera& camera,
              const SearchedImage& search,
              const FrameFeatures& image) {
  Tally tally;
  tally.tested_points = search.tested_points;
  tally.points = static_cast<int>(search.points.size());
  tally.shifted_points =
      BestShiftedMatches(camera, image, search.projected_points, 64, kLastRadiusPx);
  tally.tested_lines = search.tested_lines;
  tally.lines = static_cast<int>(search.lines.size());
  tally.shifted_lines = ShiftedLines(image, search.projected_lines, kLastRadiusPx);
  return tally;
}

// The verification of one pair of keyframes.
class Verification {
 public:
  Verification(LoopSearch& search,
               const CameraAndPyramid& imaging,
               const LoopVerificationOptions& options)
      : search_(search), imaging_(imaging), options_(options) {}

  Expected<LoopEdge, LoopRefusal> Run() {
    if (const auto refusal = Align()) return *refusal;
    if (const auto refusal = Judge()) return *refusal;
    if (const auto refusal = Confirm()) return *refusal;
    return Edge();
  }

 private:
  // Finds the first relative pose, then searches landmarks with it.
  std::optional<LoopRefusal> Align() {
    const LoopMatches first = search_.MatchDescriptors(options_);
    evidence_.first_matches =
        static_cast<int>(first.points.size()) + kLineWeight * static_cast<int>(first.lines.size());
    if (evidence_.first_matches < options_.min_matches) return LoopRefusal::kFewMatches;
    const auto rough = AlignByRansac(first.problem, 0);
    if (!rough) return LoopRefusal::kNoAgreement;
    const auto agreed = RefineAlignment(first.problem, *rough, kFirstGate);
    if (!agreed || 2 * WeightedCount(*agreed) < options_.min_matches) {
      return LoopRefusal::kNoAgreement;
    }
    const MutualSearch wide =
        search_.SearchBoth(agreed->candidate_from_query, options_.search_radius_px);
    const auto closer =
        RefineAlignment(wide.matches.problem, agreed->candidate_from_query, kFirstGate);
    if (!closer || WeightedCount(*closer) < options_.min_inliers) return LoopRefusal::kFewInliers;
    found_ = search_.SearchBoth(closer->candidate_from_query, kLastRadiusPx);
    const auto last =
        RefineAlignment(found_.matches.problem, closer->candidate_from_query, kLastGate);
    if (!last || WeightedCount(*last) < options_.min_inliers) return LoopRefusal::kFewInliers;
    result_ = *last;
    LimitCertainty();
    return std::nullopt;
  }

  std::optional<LoopRefusal> Judge() {
    evidence_.inlier_points = Count(result_.points) + Count(result_.sightings);
    evidence_.inlier_lines = Count(result_.lines);
    if (IsLoose()) return LoopRefusal::kLoose;
    const Frame& query = search_.query().keyframe->frame;
    const Frame& candidate = search_.candidate().keyframe->frame;
    if (const auto narrow = JudgeCoverage(query, candidate)) return narrow;
    Tally there = TallyOf(imaging_.camera, found_.in_candidate, *candidate.indexed);
    Tally back = TallyOf(imaging_.camera, found_.in_query, *query.indexed);
    KeepToInliers(there, back);
    tally_share_ = std::max(there.PointShare(), back.PointShare());
    line_share_ = std::max(there.LineShare(), back.LineShare());
    evidence_.tested =
        there.tested_points + there.tested_lines + back.tested_points + back.tested_lines;
    evidence_.chance_share = tally_share_;
    // Both searches use the same features, so that together they count once.
    evidence_.log10_chance = 0.5 * (there.Log10Chance() + back.Log10Chance());
    evidence_.rival_share =
        Share(there.shifted_points + back.shifted_points, there.points + back.points);
    if (evidence_.log10_chance > options_.max_log10_chance) return LoopRefusal::kChance;
    const bool points_decide = there.points + back.points > 4 * (there.lines + back.lines);
    if (points_decide && evidence_.rival_share > options_.max_rival_share) {
      return LoopRefusal::kRepeated;
    }
    return std::nullopt;
  }

  // Counts only matches that agree as found, since a search window finds something by itself now
  // and then.
  void KeepToInliers(Tally& there, Tally& back) const {
    int seen_there = Count(result_.points);
    int seen_back = seen_there;
    const auto& sightings = found_.matches.problem.sightings;
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      if (result_.sightings[i]) ++(sightings[i].known_to_query ? seen_there : seen_back);
    }
    there.points = std::min(there.points, seen_there);
    back.points = std::min(back.points, seen_back);
    there.lines = std::min(there.lines, Count(result_.lines));
    back.lines = std::min(back.lines, Count(result_.lines));
  }

  bool IsLoose() const {
    std::vector<double> depths;
    for (std::size_t i = 0; i < result_.points.size(); ++i) {
      if (result_.points[i]) {
        depths.push_back(found_.matches.problem.points[i].in_candidate.place.z());
      }
    }
    for (std::size_t i = 0; i < result_.lines.size(); ++i) {
      if (!result_.lines[i]) continue;
      const LineModel& line = found_.matches.problem.lines[i].in_candidate;
      depths.push_back(line.line.PointAt(0.5 * (line.start + line.end)).z());
    }
    if (depths.empty()) return true;
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    const double rotation = LargestSigma(result_.covariance.topLeftCorner<3, 3>());
    const double translation = LargestSigma(result_.covariance.block<3, 3>(3, 3));
    return !(rotation * 180 / std::numbers::pi <= options_.max_rotation_sigma_deg &&
             translation <= options_.max_translation_sigma * *middle);
  }

  std::optional<LoopRefusal> JudgeCoverage(const Frame& query, const Frame& candidate) {
    const Coverage there = CoverageOf(imaging_.camera, found_.in_candidate, candidate.features());
    const Coverage back = CoverageOf(imaging_.camera, found_.in_query, query.features());
    evidence_.spread = there.count() > back.count() ? there.Spread() : back.Spread();
    int tested = 0;
    int supported = 0;
    there.AddCells(tested, supported);
    back.AddCells(tested, supported);
    evidence_.area_share = Share(supported, tested);
    const bool narrow =
        evidence_.spread < options_.min_spread || evidence_.area_share < options_.min_area_share;
    return narrow ? std::optional(LoopRefusal::kNarrow) : std::nullopt;
  }

  // Asks the neighbours; the pairs that they find take part in Settle().
  std::optional<LoopRefusal> Confirm() {
    LoopMatches more;
    const Similarity3& pose = result_.candidate_from_query;
    const auto& of_query = search_.query().neighbours;
    for (std::size_t i = 0; i < std::min(kAsked, of_query.size()); ++i) {
      const SearchedImage found = search_.SearchInNeighbourOfQuery(of_query[i], pose, more);
      if (found.tested_points + kLineWeight * found.tested_lines < kLeastTested) continue;
      ++evidence_.asked;
      evidence_.confirmed += Log10Chance(found) <= options_.max_confirming_log10_chance;
    }
    const auto& of_candidate = search_.candidate().neighbours;
    for (std::size_t i = 0; i < std::min(kAsked, of_candidate.size()); ++i) {
      search_.SearchInNeighbourOfCandidate(of_candidate[i], pose, more);
    }
    const int needed = std::min(options_.confirmations, evidence_.asked);
    if (evidence_.confirmed < needed) return LoopRefusal::kUnconfirmed;
    Settle(more);
    return std::nullopt;
  }

  double Log10Chance(const SearchedImage& found) const {
    return Log10BinomialTail(
               found.tested_points, static_cast<int>(found.points.size()), tally_share_) +
           Log10BinomialTail(found.tested_lines, static_cast<int>(found.lines.size()), line_share_);
  }

  // Refines the relative pose once more, with the pairs found by neighbours: these see the place
  // from other viewpoints, and determine the directions that the two keyframes leave undetermined.
  // If the relative pose changes by more than its uncertainty allows, the map is bent around one of
  // the two, and the first result stays.
  void Settle(const LoopMatches& more) {
    LoopMatches all = found_.matches;
    all.points.insert(all.points.end(), more.points.begin(), more.points.end());
    all.lines.insert(all.lines.end(), more.lines.begin(), more.lines.end());
    auto& problem = all.problem;
    problem.points.insert(
        problem.points.end(), more.problem.points.begin(), more.problem.points.end());
    problem.lines.insert(problem.lines.end(), more.problem.lines.begin(), more.problem.lines.end());
    search_.DropContradictions(all);
    const auto agree = RefineAlignment(problem, result_.candidate_from_query, kLastGate);
    if (!agree) return;
    for (std::size_t i = 0; i < all.points.size(); ++i) {
      if (agree->points[i]) point_pairs_.push_back(all.points[i]);
    }
    for (std::size_t i = 0; i < all.lines.size(); ++i) {
      if (agree->lines[i]) line_pairs_.push_back(all.lines[i]);
    }
    const Similarity3 change = agree->candidate_from_query * Inverse(result_.candidate_from_query);
    if (ClosingChi2({change, result_.covariance}) > kMaxChange) return;
    result_ = *agree;
    LimitCertainty();
  }

  // Limits the certainty of the result. Errors of landmarks are correlated: by their keyframes and
  // the calibration.
  void LimitCertainty() {
    result_.covariance *=
        std::max(1.0, static_cast<double>(WeightedCount(result_)) / options_.independent_matches);
  }

  LoopEdge Edge() const {
    LoopEdge edge;
    edge.query = search_.query().keyframe->id;
    edge.candidate = search_.candidate().keyframe->id;
    edge.candidate_from_query = result_.candidate_from_query;
    edge.covariance = result_.covariance;
    edge.query_scale = search_.query().keyframe->scale;
    edge.candidate_scale = search_.candidate().keyframe->scale;
    edge.points = point_pairs_;
    edge.lines = line_pairs_;
    edge.evidence = evidence_;
    return edge;
  }

  LoopSearch& search_;
  const CameraAndPyramid& imaging_;
  const LoopVerificationOptions& options_;
  LoopEvidence evidence_;
  MutualSearch found_;
  AlignmentResult result_;
  double tally_share_ = 0;  // share of points and of lines that a wrong relative pose would find
  double line_share_ = 0;
  std::vector<LandmarkPair<PointId>> point_pairs_;
  std::vector<LandmarkPair<LineId>> line_pairs_;
};

}  // namespace

Expected<LoopEdge, LoopRefusal> VerifyLoop(const Map& query_map,
                                           KeyFrameId query,
                                           const Map& candidate_map,
                                           KeyFrameId candidate,
                                           const CameraAndPyramid& imaging,
                                           const LoopVerificationOptions& options) {
  LoopSearch search(query_map, query, candidate_map, candidate, imaging, options.neighbours);
  return Verification(search, imaging, options).Run();
}

}  // namespace plumbline
