// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <cstdint>
#include <vector>

namespace plumbline {

// What a surface looks like. All are computed from noise; there are no image files.
enum class Material {
  kPaint,      // nearly plain, faint scratches
  kPlaster,    // uneven wall with stains, pits and scuffs
  kPlanks,     // boards with grain, gaps and nails
  kWood,       // one piece of grained wood
  kTiles,      // square tiles with grout, chips and veins
  kCarpet,     // woven pattern with borders
  kPoster,     // blocks, discs and lines of text on a bright sheet
  kCardboard,  // brown board with tape and print
  kBrick,      // courses of bricks
  kSpine,      // back of a book
  kMetal,      // brushed metal with rows of rivets
  kConcrete,   // cast concrete: form-board marks, pores, stains
  kFabric,     // woven cloth: chairs, curtains, partitions
  kAcoustic,   // mineral fibre board of a suspended ceiling, with fissures; no grid of its own
  kScreen,     // a computer screen: windows, text, icons
  kMural,      // a large picture with structure at all scales, no repetition
  kBlank,      // a freshly painted wall: nothing but the faintest unevenness
};

struct TextureRecipe {
  Material material = Material::kPaint;
  double tone = 0.5;        // mean reflectance, 0 black to 1 white
  std::uint64_t seed = 0;   // two surfaces of one material differ by their seed
  double corner_shade = 0;  // how much darker the rim is, 0 to 1 (walls meeting in corners)

  // Where the surface is cut out of a larger sheet, so that a wall goes on beside a door: the
  // corner of the surface on the sheet and the size of the sheet, metres. A size of 0: the surface
  // is all.
  double sheet_u = 0, sheet_v = 0;
  double sheet_width = 0, sheet_height = 0;
};

// Reflectance in [0, 1] at (u, v) metres from the corner of a surface of the given size (of its
// sheet where it is cut out of one).
double EvaluateTexture(
    const TextureRecipe& recipe, double u, double v, double width, double height);

// A texture sampled on a grid, with a pyramid of halved grids against aliasing.
class Texture {
 public:
  // Samples a recipe on a grid of cells of about `texel` metres. `light` spans the surface from
  // corner to corner and multiplies the reflectance, linear between its values (1 x 1: the same
  // everywhere). Cost: about 0.2 us per texel.
  static Texture Bake(const TextureRecipe& recipe,
                      double width,
                      double height,
                      double texel,
                      const Image<float>& light);

  // Value 0-255 at (u, v) in [0, 1] x [0, 1], bilinear between the four nearest texels of a level;
  // clamped at the border.
  float Sample(float u, float v, int level) const;

  // Level whose texels are not much smaller than `footprint`, a length in texels of level 0.
  int LevelFor(float footprint) const;

  int width() const { return levels_.front().width(); }
  int height() const { return levels_.front().height(); }

 private:
  std::vector<GrayImage> levels_;
};

}  // namespace plumbline
