// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Materials laid in courses with joints between them: boards, bricks, tiles, form boards.
#include "plumbline/base/elementary.h"
#include "worlds/marks.h"
#include "worlds/noise.h"
#include "worlds/pattern.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

// Layout of a laid material. Course j lies between v = j * height and the next; its pieces are
// `length` long and begin `Shift(j)` before multiples of it. Each course and each piece begins with
// its joint.
struct Courses {
  double length = 0;  // 0: courses are not divided
  double height = 1;
  double joint = 0.005;
  enum class Bond { kGrid, kHalf, kRandom } bond = Bond::kGrid;
  std::uint64_t seed = 0;

  double Shift(double course) const {
    switch (bond) {
      case Bond::kGrid:
        return 0;
      case Bond::kHalf:
        return std::fmod(course, 2.0) != 0 ? 0.5 * length : 0;
      case Bond::kRandom:
        return length * CellValue(course, 0, seed);
    }
    return 0;
  }
};

// Position of a point in the courses.
struct Place {
  double course = 0, piece = 0;  // indices
  double x = 0, y = 0;           // metres from the beginning of the piece and of the course
  double joint = 0;              // share of the cell that is joint
};

Place FindPlace(const Courses& courses, double u, double v, const Eigen::Vector2d& cell) {
  Place place;
  place.course = CellIndex(v, courses.height);
  place.y = v - place.course * courses.height;
  const double in_bed = Covered(place.y, 0, courses.joint, cell.y()) +
                        Covered(place.y, courses.height, courses.height + courses.joint, cell.y());
  double in_head = 0;
  if (courses.length > 0) {
    const double shifted = u + courses.Shift(place.course);
    place.piece = CellIndex(shifted, courses.length);
    place.x = shifted - place.piece * courses.length;
    in_head = Covered(place.x, 0, courses.joint, cell.x()) +
              Covered(place.x, courses.length, courses.length + courses.joint, cell.x());
  } else {
    place.x = u;
  }
  place.joint = in_bed + (1 - in_bed) * in_head;
  return place;
}

// Both sides of every joint: each is a step of the reflectance, even if a distant camera sees one
// dark line.
void AppendJoints(const Courses& courses,
                  const Eigen::AlignedBox2d& window,
                  std::vector<Segment2>* edges) {
  const auto append = [&](double u0, double v0, double u1, double v1) {
    const auto inside = ClipToBox({{u0, v0}, {u1, v1}}, window);
    if (inside) edges->push_back(*inside);
  };
  const double low = window.min().x(), high = window.max().x();
  // Beds in pieces as long as those of the course that is beside them.
  const auto bed = [&](double v, double course) {
    if (courses.length <= 0) return append(low, v, high, v);
    const double shift = courses.Shift(course);
    for (double i = CellIndex(low + shift, courses.length); i * courses.length - shift < high;
         ++i) {
      const double u = i * courses.length - shift;
      append(u + courses.joint, v, u + courses.length, v);
    }
  };
  const double first = CellIndex(window.min().y(), courses.height);
  const double top = window.max().y();
  for (double j = first; j * courses.height < top; ++j) {
    bed(j * courses.height, j - 1);
    bed(j * courses.height + courses.joint, j);
  }
  if (courses.length <= 0) return;
  // Heads by their place in the course, then by course: on a grid they then follow each other.
  const double heads = 2 + std::ceil((high - low) / courses.length);
  for (double k = 0; k < heads; ++k) {
    for (const double side : {0.0, courses.joint}) {
      for (double j = first; j * courses.height < top; ++j) {
        const double shift = courses.Shift(j), v = j * courses.height;
        const double u = (CellIndex(low + shift, courses.length) + k) * courses.length - shift;
        append(u + side, v + courses.joint, u + side, v + courses.height);
      }
    }
  }
}

double Mix(double a, double b, double share_of_b) { return a + share_of_b * (b - a); }

// Contents of the courses, by material.
class LaidPattern : public Pattern {
 public:
  LaidPattern(const PatternFrame& frame, const Courses& courses)
      : Pattern(frame), courses_(courses) {}

  double At(double u, double v) const final {
    const Place place = FindPlace(courses_, u, v, frame_.cell);
    if (place.joint >= 1) return Joint(u, v);
    const double piece = Piece(place, u, v);
    return place.joint <= 0 ? piece : Mix(piece, Joint(u, v), place.joint);
  }
  void AppendEdges(const Eigen::AlignedBox2d& window, std::vector<Segment2>* edges) const final {
    AppendJoints(courses_, window, edges);
  }

 protected:
  virtual double Piece(const Place& place, double u, double v) const = 0;
  virtual double Joint(double u, double v) const = 0;

  // A number of a piece, different for each.
  std::uint64_t Hash(const Place& place) const {
    return HashCell(static_cast<std::int64_t>(place.course),
                    static_cast<std::int64_t>(place.piece),
                    frame_.seed);
  }

  Courses courses_;
};

class Planks : public LaidPattern {
 public:
  explicit Planks(const PatternFrame& frame)
      : LaidPattern(frame, {1.3, 0.14, 0.004, Courses::Bond::kRandom, frame.seed}) {}

 private:
  double Piece(const Place& place, double u, double v) const override {
    constexpr double kNail = 0.005, kInset = 0.04;
    const double tone = frame_.tone;
    const double across = std::min(std::abs(place.y - 0.25 * courses_.height),
                                   std::abs(place.y - 0.75 * courses_.height));
    const double along =
        std::min(std::abs(place.x - kInset), std::abs(place.x - courses_.length + kInset));
    if (math::Hypot(across, along) < kNail) return 0.25 * tone;
    const std::uint64_t board = Hash(place);
    const double worn = FractalNoise(3 * u, 3 * v, 3, 0.7, frame_.seed + 11);
    return tone * (0.8 + 0.4 * UnitFromHash(board) + 0.8 * WoodGrain(u, v, board) + 0.25 * worn);
  }
  double Joint(double u, double v) const override {
    return frame_.tone * (0.3 + 0.25 * FractalNoise(4 * u, 4 * v, 3, 0.8, frame_.seed + 13));
  }
};

class Tiles : public LaidPattern {
 public:
  explicit Tiles(const PatternFrame& frame) : LaidPattern(frame, {0.30, 0.30, 0.006}) {}

 private:
  double Dirt(double u, double v) const {
    return FractalNoise(20 * u, 20 * v, 3, 0.9, frame_.seed + 7);
  }
  double Piece(const Place& place, double u, double v) const override {
    const std::uint64_t tile = Hash(place);
    const double vein = 1 - std::abs(FractalNoise(5 * u, 5 * v, 4, 0.6, tile));
    const double chips = Specks(u, v, 0.07, 0.4, frame_.seed + 9);
    const double dark = UnitFromHash(tile) < 0.2 ? 0.5 : 1.0;
    return frame_.tone * dark *
           (0.8 + 0.3 * UnitFromHash(MixBits(tile)) -
            (0.1 + 0.5 * UnitFromHash(tile + 1)) * math::Pow(vein, 14) + 0.2 * Dirt(u, v) +
            0.4 * chips);
  }
  double Joint(double u, double v) const override {
    return frame_.tone * (0.38 + 0.15 * Dirt(u, v));
  }
};

class Brick : public LaidPattern {
 public:
  explicit Brick(const PatternFrame& frame)
      : LaidPattern(frame, {0.24, 0.08, 0.011, Courses::Bond::kHalf}) {}

 private:
  double Piece(const Place& place, double u, double v) const override {
    return frame_.tone * (0.6 + 0.5 * UnitFromHash(Hash(place)) + 0.4 * Grain(u, v) + Soot(u, v) +
                          0.45 * Specks(u, v, 0.05, 0.5, frame_.seed + 2));
  }
  double Joint(double u, double v) const override {
    return frame_.tone * (1.25 + 0.3 * Grain(u, v) + Soot(u, v));
  }
  double Soot(double u, double v) const { return Weathering(u, v, 0.35, frame_.seed + 5); }
  double Grain(double u, double v) const {
    return FractalNoise(45 * u, 45 * v, 4, 0.9, frame_.seed);
  }
};

// Cast against boards 1.2 m high, with the holes of the ties that held them.
class Concrete : public LaidPattern {
 public:
  explicit Concrete(const PatternFrame& frame) : LaidPattern(frame, {0, 1.2, 0.006}) {}

 private:
  double Body(double u, double v) const {
    const double clouds = Weathering(u, v, 0.6, frame_.seed);
    const double grain = FractalNoise(50 * u, 50 * v, 3, 0.9, frame_.seed + 10);
    const double pores = Specks(u, v, 0.03, 0.18, frame_.seed + 20);
    return frame_.tone * (1 + clouds + 0.08 * grain + 0.35 * std::min(0.0, pores));
  }
  double Piece(const Place& place, double u, double v) const override {
    constexpr double kTie = 0.6, kHole = 0.012;
    const double x = u - kTie * std::round(u / kTie), y = place.y - 0.5 * courses_.height;
    const double board = 0.94 + 0.12 * UnitFromHash(Hash(place));
    return board * Body(u, v) * (math::Hypot(x, y) < kHole ? 0.45 : 1);
  }
  double Joint(double u, double v) const override { return 0.72 * Body(u, v); }
};

}  // namespace

std::unique_ptr<const Pattern> MakeLaidPattern(Material material, const PatternFrame& frame) {
  switch (material) {
    case Material::kPlanks:
      return std::make_unique<Planks>(frame);
    case Material::kTiles:
      return std::make_unique<Tiles>(frame);
    case Material::kBrick:
      return std::make_unique<Brick>(frame);
    case Material::kConcrete:
      return std::make_unique<Concrete>(frame);
    default:
      return nullptr;
  }
}

}  // namespace plumbline
