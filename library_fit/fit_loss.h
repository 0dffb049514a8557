#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "asset_lift/camera/observed_view.h"
#include "core/mesh.h"
#include "library_fit/fit_view.h"

namespace simwright::library_fit {

// A crop of the photo, prepared for comparison with renders.
struct FitTarget {
  int side = 0;                        // pixels
  std::vector<float> opacity;          // (side x side)
  std::vector<Eigen::Vector3f> color;  // (side x side) sRGB in [0, 1]
  Eigen::AlignedBox2d box;             // pixels, of the object
  std::vector<float> edge_strength;    // (side x side) of the edges inside the object, in [0, 1]
  std::vector<float> edge_distance;    // (side x side) pixels to the nearest edge, at most kFarEdge
  double color_variance = 0.0;         // of the object, summed over channels
  // (side x side) 1: something else may cover the object here, so the pixel does not count; empty:
  // all count.
  std::vector<std::uint8_t> covered;

  bool Counts(std::size_t pixel) const { return covered.empty() || covered[pixel] == 0; }
};

inline constexpr float kFarEdge = 3.0f;  // pixels; farther edges count as this far

// Throws core::Error if the crop shows no object.
FitTarget MakeFitTarget(const asset_lift::ObservedView& crop);

// The comparison of a render with the photo; all in [0, 1].
struct FitAgreement {
  double iou = 0.0;          // of the outlines
  double unexplained = 1.0;  // share of the colours' variance that the parts do not explain
  double edge_error = 1.0;   // mean distance between edges in both directions, over kFarEdge
  // The weighted sum that the fit minimizes.
  double Loss() const { return 2.0 * (1.0 - iou) + 0.8 * unexplained + 0.6 * edge_error; }
};

// Compares a mesh, seen by the view so that its bounding box is the object's, with the photo.
// Colours are compared without knowing those of the object or of the light: within each material,
// colour is an affine function of the normal, fitted to the photo, as a plain surface in diffuse
// light of the first order has it.
FitAgreement CompareWithPhoto(const core::TexturedMesh& mesh, const FitView& view,
                              const FitTarget& target);
// The same from a camera for the crop's pixels.
FitAgreement CompareWithPhoto(const core::TexturedMesh& mesh, const core::Camera& camera,
                              const FitTarget& target);

}  // namespace simwright::library_fit
