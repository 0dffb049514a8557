#pragma once

#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/mesh.h"
#include "shape_alignment.h"

namespace simwright::bench {

// The similarity of a shape to the ground truth, in the latter's normalized frame (its box's
// longest side spans [-1, 1], as in SF3D).
struct ShapeScores {
  double chamfer = 0.0;  // mean of both mean distances, from points of one to the other's surface
  double f_score = 0.0;  // at 0.1: harmonic mean of the shares of points nearer than that
  double volume_iou = 0.0;  // by geometry::VoxelSolid, 96 cells per side
  // The mean |cosine| between the normals of a point of one and of the nearest point of the other,
  // mean of both directions.
  double normal_consistency = 0.0;
  // The mean deviation of the normals (geometry/surface_fairness.h), divided by the ground truth's;
  // above 1: rougher.
  double roughness = 0.0;
};

// Compares two shapes. `truth_from_other` is between their normalized frames.
ShapeScores CompareShapes(const ComparableShape& truth, const ComparableShape& other,
                          const Eigen::Affine3d& truth_from_other);

// Renders the object from four sides that the photo does not show: 45, 135, 225 and 315 degrees
// from its azimuth (rad), 20 degrees above, on white. `in_unit_box`: normalized. `lit`: in the
// light of the photo, which is fixed while the camera moves; else the colours alone.
std::vector<core::Image> NovelViews(const core::TexturedMesh& in_unit_box, double photo_azimuth,
                                    bool lit);

// Returns 10 log10(255^2 / mean squared difference) of RGB, dB; at most 99. Images of equal size.
double PeakSignalToNoise(const core::Image& a, const core::Image& b);

// Returns the mesh moved, with its colours unchanged.
core::TexturedMesh Moved(core::TexturedMesh mesh, const Eigen::Affine3d& to);

// Checks alignment and scores against analytic results; prints each figure and its bounds. Returns
// true if all hold. `sample`: any real mesh.
bool MeasuresHold(const core::TriangleMesh& sample);

}  // namespace simwright::bench
