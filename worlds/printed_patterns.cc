// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Materials with a layout of their own on each sheet: posters, screens, labels, borders.
#include "worlds/marks.h"
#include "worlds/noise.h"
#include "worlds/patches.h"
#include "worlds/pattern.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

double Unit(std::uint64_t key) { return UnitFromHash(MixBits(key)); }

// Patches on a ground of noise.
class PrintedPattern : public Pattern {
 public:
  using Pattern::Pattern;

  double At(double u, double v) const override {
    return PaintPatches(patches_, {u, v}, Ground(u, v), frame_.cell);
  }
  void AppendEdges(const Eigen::AlignedBox2d& window, std::vector<Segment2>* edges) const override {
    std::vector<Segment2> all;
    AppendPatchEdges(patches_, &all);
    for (const Segment2& edge : all) {
      if (const auto inside = ClipToBox(edge, window)) edges->push_back(*inside);
    }
  }

 protected:
  virtual double Ground(double u, double v) const = 0;

  // The sheet without a margin.
  Eigen::AlignedBox2d Inner(double margin) const {
    return BoxOf(margin, margin, frame_.width - margin, frame_.height - margin);
  }
  void Add(Patch patch, const Eigen::AlignedBox2d& within) {
    patch.box = patch.box.intersection(within);
    if (!patch.box.isEmpty() && patch.box.sizes().minCoeff() > 0.002) patches_.push_back(patch);
  }

  std::vector<Patch> patches_;
};

// Blocks and discs like a collage of photographs in the upper half, a headline and text below.
class Poster : public PrintedPattern {
 public:
  explicit Poster(const PatternFrame& frame) : PrintedPattern(frame) {
    constexpr double kRim = 0.012, kMargin = 0.03;
    const double w = frame_.width, h = frame_.height;
    Add({Inner(kRim), std::min(0.92, frame_.tone)}, Inner(0));
    for (int i = 0; i < 6; ++i) {
      const auto k = frame_.seed + 10 * static_cast<std::uint64_t>(i) + 100;
      const Eigen::Vector2d centre(w * (0.1 + 0.8 * Unit(k)), h * (0.5 + 0.42 * Unit(k + 1)));
      const double a = w * (0.08 + 0.2 * Unit(k + 2)), b = h * (0.05 + 0.13 * Unit(k + 3));
      Patch patch;
      patch.ellipse = i % 3 == 2;
      const Eigen::Vector2d half(a, patch.ellipse ? a : b);
      patch.box = {centre - half, centre + half};
      patch.value = 0.1 + 0.75 * Unit(k + 4);
      patch.shade = 0.1 + 0.25 * Unit(k + 5);
      patch.seed = k + 6;
      // A disc cut by the margin would become another ellipse.
      if (!patch.ellipse || Inner(kMargin).contains(patch.box)) Add(patch, Inner(kMargin));
    }
  }

  double At(double u, double v) const override {
    const double value = PrintedPattern::At(u, v);
    const double rim = std::min({u, v, frame_.width - u, frame_.height - v});
    const double h = frame_.height;
    constexpr double kText = 0.05;  // margin of the text
    double ink = 0;
    if (rim > kText && v < 0.40 * h) {
      const double line = 0.02 + 0.02 * Unit(frame_.seed + 3);
      ink = 0.75 * TextInk(u - kText, v, line, frame_.width - 2 * kText, frame_.seed + 4);
    } else if (rim > kText && v > 0.41 * h && v < 0.47 * h) {
      ink = 0.8 * TextInk(u - kText, v, 0.06 * h, frame_.width - 2 * kText, frame_.seed + 5);
    }
    return value * (1 - ink) * (1 + 0.08 * FractalNoise(30 * u, 30 * v, 3, 0.8, frame_.seed + 6));
  }

 private:
  double Ground(double /*u*/, double /*v*/) const override { return 0.15; }
};

// Brown board with tape along the middle and a label.
class Cardboard : public PrintedPattern {
 public:
  explicit Cardboard(const PatternFrame& frame) : PrintedPattern(frame) {
    constexpr double kTape = 0.025;
    const double w = frame_.width, h = frame_.height;
    Patch tape{BoxOf(0.5 * w - kTape, 0, 0.5 * w + kTape, h), 1.3};
    tape.stain = true;
    Add(tape, Inner(0));
    Patch label{BoxOf(0.1 * w, 0.15 * h, 0.42 * w, 0.45 * h), 0.75};
    label.text = {0.022, 0.15};
    label.seed = frame_.seed + 8;
    Add(label, Inner(0));
  }

 private:
  double Ground(double u, double v) const override {
    const double fibres = FractalNoise(18 * u, 32 * v, 4, 0.8, frame_.seed);
    const double dents = Weathering(u, v, 0.45, frame_.seed + 11);
    return frame_.tone *
           (1 + 0.18 * fibres + dents + 0.3 * Specks(u, v, 0.04, 0.3, frame_.seed + 3));
  }
};

// The back of a book: two bands and a title that runs along it.
class Spine : public PrintedPattern {
 public:
  explicit Spine(const PatternFrame& frame)
      : PrintedPattern(frame), ink_(frame.tone > 0.45 ? 0.15 : 0.8) {
    constexpr double kHalfBand = 0.015;  // of the height
    const double h = frame_.height, band = 0.1 + 0.1 * Unit(frame_.seed + 1);
    for (const double place : {band, 1 - band}) {
      Add({BoxOf(0, h * (place - kHalfBand), frame_.width, h * (place + kHalfBand)), ink_},
          Inner(0));
    }
  }

  double At(double u, double v) const override {
    const double value = PrintedPattern::At(u, v), along = v / frame_.height;
    if (std::abs(u - 0.5 * frame_.width) > 0.32 * frame_.width || along < 0.25 || along > 0.75) {
      return value;
    }
    return value + (ink_ - value) * TextInk(v - 0.25 * frame_.height,
                                            u,
                                            0.6 * frame_.width,
                                            0.5 * frame_.height,
                                            frame_.seed + 5);
  }

 private:
  double Ground(double u, double v) const override {
    return frame_.tone * (1 + 0.12 * FractalNoise(40 * u, 40 * v, 3, 0.8, frame_.seed) +
                          Weathering(u, v, 0.4, frame_.seed + 2));
  }

  double ink_;
};

// A screen with overlapping windows.
class Screen : public PrintedPattern {
 public:
  explicit Screen(const PatternFrame& frame) : PrintedPattern(frame) {
    constexpr double kRim = 0.012, kTitle = 0.015, kLine = 0.009;
    const double w = frame_.width, h = frame_.height;
    Add({Inner(kRim), 0.15 + 0.2 * frame_.tone}, Inner(0));
    for (int i = 0; i < 4; ++i) {
      const auto k = frame_.seed + 20 * static_cast<std::uint64_t>(i);
      const double left = w * (0.05 + 0.5 * Unit(k)), bottom = h * (0.08 + 0.4 * Unit(k + 1));
      const double right = left + w * (0.3 + 0.3 * Unit(k + 2)), top = bottom + 0.5 * h;
      const bool dark = Unit(k + 4) < 0.4;
      Patch window{BoxOf(left, bottom, right, top), dark ? 0.1 : 0.85};
      window.text = {kLine, dark ? 0.7 : 0.15};
      window.seed = k + 5;
      Add(window, Inner(0.02));
      Add({BoxOf(left, top - kTitle, right, top), 0.45}, Inner(0.02));
    }
  }

 private:
  double Ground(double /*u*/, double /*v*/) const override { return 0.06; }
};

// Woven, with borders and a field of lozenges.
class Carpet : public PrintedPattern {
 public:
  explicit Carpet(const PatternFrame& frame) : PrintedPattern(frame) {
    Add({Inner(0.05), 0.7}, Inner(0));
    Add({Inner(0.09), 1.5}, Inner(0));
    Add({Inner(0.11), 0.7}, Inner(0));
  }

  double At(double u, double v) const override {
    double weave = PrintedPattern::At(u, v);
    if (Inner(kField).contains(Eigen::Vector2d(u, v))) {
      const Lozenge figure = FigureAt(CellIndex(u, kFigure), CellIndex(v, kFigure));
      const double inside =
          (figure.radius - std::abs(u - figure.centre.x()) - std::abs(v - figure.centre.y())) /
          std::sqrt(2.0);
      const double cover = frame_.cell.x() > 0
                               ? std::clamp(0.5 + inside / frame_.cell.mean(), 0.0, 1.0)
                               : (inside >= 0 ? 1.0 : 0.0);
      weave += cover * (figure.value - weave);
    }
    const double yarn = FractalNoise(110 * u, 110 * v, 2, 1.0, frame_.seed);
    const double wear = FractalNoise(3 * u, 3 * v, 4, 0.7, frame_.seed + 20);
    return frame_.tone * (weave + 0.3 * yarn + 0.35 * wear);
  }

  void AppendEdges(const Eigen::AlignedBox2d& window, std::vector<Segment2>* edges) const override {
    PrintedPattern::AppendEdges(window, edges);
    const Eigen::AlignedBox2d field = Inner(kField).intersection(window);
    if (field.isEmpty()) return;
    for (double j = CellIndex(field.min().y(), kFigure); j * kFigure < field.max().y(); ++j) {
      for (double i = CellIndex(field.min().x(), kFigure); i * kFigure < field.max().x(); ++i) {
        const Lozenge figure = FigureAt(i, j);
        const Eigen::Vector2d corners[] = {
            {figure.radius, 0}, {0, figure.radius}, {-figure.radius, 0}, {0, -figure.radius}};
        for (std::size_t k = 0; k < 4; ++k) {
          const auto side =
              ClipToBox({figure.centre + corners[k], figure.centre + corners[(k + 1) % 4]}, field);
          if (side) edges->push_back(*side);
        }
      }
    }
  }

 private:
  static constexpr double kField = 0.16, kFigure = 0.12;

  struct Lozenge {
    Eigen::Vector2d centre;
    double radius;  // half a diagonal, metres
    double value;
  };
  Lozenge FigureAt(double i, double j) const {
    const double radius = kFigure * (0.2 + 0.3 * CellValue(i, j, frame_.seed + 30));
    return {{kFigure * (i + 0.5), kFigure * (j + 0.5)},
            radius,
            CellValue(i, j, frame_.seed + 31) < 0.5 ? 1.5 : 0.3};
  }

  double Ground(double /*u*/, double /*v*/) const override { return 1.5; }
};

}  // namespace

std::unique_ptr<const Pattern> MakePrintedPattern(Material material, const PatternFrame& frame) {
  switch (material) {
    case Material::kPoster:
      return std::make_unique<Poster>(frame);
    case Material::kCardboard:
      return std::make_unique<Cardboard>(frame);
    case Material::kSpine:
      return std::make_unique<Spine>(frame);
    case Material::kScreen:
      return std::make_unique<Screen>(frame);
    case Material::kCarpet:
      return std::make_unique<Carpet>(frame);
    default:
      return nullptr;
  }
}

}  // namespace plumbline
