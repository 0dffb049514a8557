#include <algorithm>
#include <cmath>

#include "texture/materials/noise.h"
#include "texture/materials/substances.h"

namespace simwright::texture {
namespace {

// A point in the frame of a tree: x along the trunk, y and z across, m.
Eigen::Vector3f InTree(const PartFrame& frame, std::uint32_t seed,
                       const Eigen::Vector3f& position) {
  const Eigen::Vector3f& along = frame.grain;
  const Eigen::Vector3f helper =
      std::abs(along.z()) < 0.9f ? Eigen::Vector3f::UnitZ() : Eigen::Vector3f::UnitX();
  const Eigen::Vector3f across = along.cross(helper).normalized(), third = along.cross(across);
  const Eigen::Vector3f p = position - frame.box.center();
  Eigen::Vector3f tree(p.dot(along), p.dot(across), p.dot(third));
  // The board was cut beside the pith, and never quite along it: rings run out as pointed arches.
  const std::uint32_t h = CellHash(17, 5, 3, seed);
  const float width = std::max(frame.box.sizes().minCoeff(), 0.01f);
  const float extent = frame.box.sizes().maxCoeff();
  const float beside = 0.03f + 0.10f * HashUniform(h, 0) + 0.5f * width;
  const float angle = 6.2831853f * HashUniform(h, 1);
  const float tilt =
      (0.02f + 0.05f * HashUniform(h, 2)) * (HashUniform(h, 3) < 0.5f ? -1.0f : 1.0f);
  tree.y() += beside * std::cos(angle) + tilt * tree.x();
  tree.z() += beside * std::sin(angle) + 0.4f * tilt * tree.x();
  tree.x() += 3.0f * extent * HashUniform(h, 4) + 7.0f * HashUniform(h, 5);
  return tree;
}

// A knot darkens the wood around a branch that crosses the trunk; returns its share and bends the
// rings around it.
float KnotShare(const Eigen::Vector3f& tree, std::uint32_t seed, float* ring_shift) {
  // At most one branch per 25 cm of trunk, going outwards from the pith.
  const float slot = std::floor(tree.x() / 0.25f);
  const std::uint32_t h = CellHash(static_cast<int>(slot), 1, 2, seed);
  if (HashUniform(h, 0) > 0.75f) return 0.0f;
  const float at = (slot + 0.3f + 0.4f * HashUniform(h, 1)) * 0.25f;
  const float angle = 6.2831853f * HashUniform(h, 2), radius = 0.004f + 0.007f * HashUniform(h, 3);
  const Eigen::Vector2f out(std::cos(angle), std::sin(angle));
  const Eigen::Vector2f cross = tree.tail<2>();
  if (cross.dot(out) < 0.0f) return 0.0f;
  const float aside = cross.x() * out.y() - cross.y() * out.x();
  const float distance = std::hypot(aside, 0.55f * (tree.x() - at));
  *ring_shift += 1.3f * radius * std::exp(-distance * distance / (6.0f * radius * radius));
  return 1.0f - SmoothStep(0.6f * radius, 1.15f * radius, distance);
}

}  // namespace

MaterialSample WoodAt(const SurfaceMaterial& m, const PartFrame& frame,
                      const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + frame.seed;
  const Eigen::Vector3f tree = InTree(frame, seed, point.position);
  const float spacing = point.footprint;
  // Wide rings on large things: narrower ones would vanish between texels.
  const float ring = std::max(m.scale * 0.0032f, 5.0f * spacing);
  const Eigen::Vector3f slow(2.2f * tree.x(), 16.0f * tree.y(), 16.0f * tree.z());
  float radius = tree.tail<2>().norm();
  radius += 0.9f * ring * FractalNoise(slow, 3, 16.0f * spacing, seed + 1);
  float shift = 0.0f;
  const float knot = m.figure == SkinFigure::kSpots ? KnotShare(tree, seed + 2, &shift) : 0.0f;
  radius += shift;
  const float turn = radius / ring, number = std::floor(turn), phase = turn - number;
  const float year = CellUniform(static_cast<int>(number), 0, 0, seed + 3);
  // Earlywood darkens slowly into latewood, which ends sharply.
  const float late =
      SmoothStep(0.15f, 0.86f + 0.06f * year, phase) * (1.0f - SmoothStep(0.93f, 1.0f, phase));
  const Eigen::Vector3f fibre_place(tree.x() / 0.03f, tree.y() / 0.0009f, tree.z() / 0.0009f);
  const float fibre = FractalNoise(fibre_place, 2, spacing / 0.0009f, seed + 4);
  const Eigen::Vector3f streak_place(tree.x() / 0.3f, tree.y() / 0.009f, tree.z() / 0.009f);
  const float streak = FractalNoise(streak_place, 3, spacing / 0.009f, seed + 5);
  const float cloud = FractalNoise(4.0f * tree, 2, 4.0f * spacing, seed + 6);
  float dark =
      0.10f + 0.55f * late * (0.6f + 0.5f * year) + 0.16f * streak + 0.14f * fibre + 0.10f * cloud;
  // Pores: short dark strokes along the grain, most in the earlywood.
  const Eigen::Vector3f pore_place(tree.x() / 0.006f, tree.y() / 0.0006f, tree.z() / 0.0006f);
  const float pores = SmoothStep(0.30f, 0.55f, GradientNoise(pore_place, seed + 7)) *
                      (1.0f - 0.6f * late) * m.strength * Visible(0.0016f, spacing);
  MaterialSample sample;
  sample.color = Mix(m.color, m.second, std::clamp(dark, 0.0f, 1.25f));
  sample.color = Mix(sample.color, 0.45f * m.second, std::clamp(0.55f * pores, 0.0f, 1.0f));
  sample.color = Mix(sample.color, 0.55f * m.second, 0.85f * knot);
  sample.color *= 0.97f + 0.08f * HashUniform(CellHash(1, 2, 3, seed), 9);
  sample.roughness = m.roughness + 0.10f * pores - 0.05f * late + 0.03f * fibre;
  sample.height = -6e-5f * pores + 1.5e-5f * fibre;
  return sample;
}

MaterialSample BambooAt(const SurfaceMaterial& m, const PartFrame& frame,
                        const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + frame.seed;
  const Eigen::Vector3f tree = InTree(frame, seed, point.position);
  // Strips glued side by side, each with nodes at its own places.
  const float width = std::max(0.018f * m.scale, 6.0f * point.footprint);
  const int row = static_cast<int>(std::floor(tree.y() / width));
  const int layer = static_cast<int>(std::floor(tree.z() / width));
  const std::uint32_t h = CellHash(row, layer, 0, seed);
  const float node_spacing = 0.22f + 0.08f * HashUniform(h, 0);
  const float along = tree.x() / node_spacing + HashUniform(h, 1);
  const float node = (along - std::floor(along) - 0.5f) * node_spacing;
  const float at_node =
      std::exp(-node * node / (0.0022f * 0.0022f)) * Visible(0.005f, point.footprint);
  const Eigen::Vector3f fibre_place(tree.x() / 0.06f, tree.y() / 0.0008f, tree.z() / 0.0008f);
  const float fibre = FractalNoise(fibre_place, 3, point.footprint / 0.0008f, seed + 1);
  const float edge_y = std::abs(tree.y() / width - std::floor(tree.y() / width) - 0.5f);
  const float joint = SmoothStep(0.5f - 0.8f * point.footprint / width - 0.012f, 0.5f, edge_y);
  MaterialSample sample;
  const float dark =
      0.15f + 0.5f * HashUniform(h, 2) + 0.25f * fibre + 0.6f * at_node + 0.5f * joint;
  sample.color = Mix(m.color, m.second, std::clamp(dark, 0.0f, 1.3f));
  sample.roughness = m.roughness + 0.05f * fibre;
  sample.height = -4e-5f * joint;
  return sample;
}

}  // namespace simwright::texture
