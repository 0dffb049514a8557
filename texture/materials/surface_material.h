#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/image.h"

namespace simwright::texture {

// The families of materials, each a function of space.
enum class Substance {
  kWood,
  kBamboo,
  kGlaze,
  kClay,
  kGlass,
  kStone,
  kMarble,
  kConcrete,
  kBrushedMetal,
  kPolishedMetal,
  kCastMetal,
  kPaint,
  kPlastic,
  kRubber,
  kWax,
  kFabric,
  kFelt,
  kLeather,
  kPaper,
  kCardboard,
  kCork,
  kSkin,
  kCrust,
  kPrint
};

enum class Pattern { kNone, kStripes, kDots, kChecks, kPlaid, kRim };

// The pattern of the skin of a fruit or a vegetable, beside its two colours.
enum class SkinFigure { kPlain, kStreaks, kPores, kSpots, kBands, kFuzz };

// A material with its colours (sRGB, each in [0, 1]).
struct SurfaceMaterial {
  std::string name = "plastic";  // for records
  Substance substance = Substance::kPlastic;
  Eigen::Vector3f color{0.8f, 0.8f, 0.8f};
  Eigen::Vector3f second{0.6f, 0.6f, 0.6f};  // latewood, veins, spots, the ends of a fruit
  float roughness = 0.5f;                    // [0, 1]
  float strength = 1.0f;  // of what is typical of the material: pores, speckles, scratches
  float wear = 0.0f;      // [0, 1]: chips, stains
  float scale = 1.0f;     // of the material's own lengths
  SkinFigure figure = SkinFigure::kPlain;
  Pattern pattern = Pattern::kNone;
  Eigen::Vector3f pattern_color{0.2f, 0.3f, 0.5f};
  float pattern_size = 0.02f;  // m
  // The picture around a label or on the sides of a carton, RGB; shown by kPrint.
  std::shared_ptr<const core::Image> print;
  bool print_is_label = false;  // a band around the middle; else all sides are printed
  std::uint32_t seed = 1;

  bool IsMetal() const;
};

// The pose and extent of a part, in the frame of its points (m, z up).
struct PartFrame {
  Eigen::AlignedBox3f box;         // of the part
  Eigen::Vector3f grain{1, 0, 0};  // unit: its longest direction
  bool round = false;              // a surface of revolution about the vertical
  std::uint32_t seed = 1;          // of the part: each board is of another place in the tree
};

struct MaterialPoint {
  Eigen::Vector3f position{0, 0, 0};  // m
  Eigen::Vector3f normal{0, 0, 1};    // unit
  float footprint = 0.0f;             // m, the spacing of texels: finer detail fades out
};

struct MaterialSample {
  Eigen::Vector3f color{0, 0, 0};  // sRGB
  float roughness = 0.5f, metallic = 0.0f;
  float height = 0.0f;  // m, relief along the normal
};

// Returns the material at a point: a function of space, so that a texture of it has no seams.
MaterialSample EvaluateMaterial(const SurfaceMaterial& material, const PartFrame& frame,
                                const MaterialPoint& point);

}  // namespace simwright::texture
