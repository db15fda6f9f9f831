// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace plumbline {

// Appearance of a surface. All are computed from noise; there are no image files.
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
constexpr auto EnumNames(std::type_identity<Material>) {
  return std::array{std::pair{Material::kPaint, "paint"},
                    std::pair{Material::kPlaster, "plaster"},
                    std::pair{Material::kPlanks, "planks"},
                    std::pair{Material::kWood, "wood"},
                    std::pair{Material::kTiles, "tiles"},
                    std::pair{Material::kCarpet, "carpet"},
                    std::pair{Material::kPoster, "poster"},
                    std::pair{Material::kCardboard, "cardboard"},
                    std::pair{Material::kBrick, "brick"},
                    std::pair{Material::kSpine, "spine"},
                    std::pair{Material::kMetal, "metal"},
                    std::pair{Material::kConcrete, "concrete"},
                    std::pair{Material::kFabric, "fabric"},
                    std::pair{Material::kAcoustic, "acoustic"},
                    std::pair{Material::kScreen, "screen"},
                    std::pair{Material::kMural, "mural"},
                    std::pair{Material::kBlank, "blank"}};
}

struct TextureRecipe {
  Material material = Material::kPaint;
  double tone = 0.5;        // mean reflectance, 0 black to 1 white
  std::uint64_t seed = 0;   // two surfaces of one material differ by their seed
  double corner_shade = 0;  // darkening of the rim, 0 to 1 (walls meeting in corners)

  // Set if the surface is cut out of a larger sheet, so that a wall continues beside a door: the
  // corner of the surface on the sheet and the size of the sheet, metres. A size of 0: the surface
  // is the whole sheet.
  double sheet_u = 0, sheet_v = 0;
  double sheet_width = 0, sheet_height = 0;
};

// Reflectance in [0, 1] at (u, v) metres from the corner of a surface of the given size (or of its
// sheet). Computes the layout each time: for many points of a surface use SurfacePattern.
double EvaluateTexture(
    const TextureRecipe& recipe, double u, double v, double width, double height);

}  // namespace plumbline
