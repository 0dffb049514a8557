#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

namespace simwright::render {

// Procedural patterns in three dimensions: a surface shows the section through it.
enum class Pattern { kNone, kChecker, kStripes, kNoise, kPlanks };

// Changes the albedo of a surface. The default leaves it as its mesh has it.
struct SurfaceLook {
  // Replaces the base colour of triangles without a texture; sRGB, each in [0, 1].
  std::optional<Eigen::Vector3f> color;
  // Multiplies the linear albedo, textures included.
  Eigen::Vector3f tint = Eigen::Vector3f::Ones();
  // Blends towards `pattern_color` (sRGB) where the pattern is: squares, stripes along y, smooth
  // noise, or planks along x with gaps, of `pattern_size` (m) in the frame of the mesh or backdrop.
  Pattern pattern = Pattern::kNone;
  Eigen::Vector3f pattern_color = Eigen::Vector3f::Constant(0.5f);
  float pattern_size = 0.1f;
  float pattern_strength = 1.0f;  // in [0, 1]
  std::uint32_t pattern_seed = 0;
};

// Returns the share of `pattern_color` at a point in m, in [0, 1].
float PatternShare(const SurfaceLook& look, const Eigen::Vector3f& point);

}  // namespace simwright::render
