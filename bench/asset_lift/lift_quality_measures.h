#pragma once

#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/mesh.h"
#include "shape_alignment.h"

namespace simwright::bench {

// How near a shape is to the truth, in the truth's normalised frame (its box's longest side spans
// [-1, 1], as SF3D's).
struct ShapeScores {
  double chamfer = 0.0;  // mean of both mean distances, from points of one to the other's surface
  double f_score = 0.0;  // at 0.1: harmonic mean of the shares of points nearer than that
  double volume_iou = 0.0;  // of what either fills, by geometry::VoxelSolid, 96 cells along a side
};

// `truth_from_other` between the shapes' normalised frames.
ShapeScores CompareShapes(const ComparableShape& truth, const ComparableShape& other,
                          const Eigen::Affine3d& truth_from_other);

// The object from four sides that the photo does not show: 45, 135, 225 and 315 degrees round from
// its azimuth (rad), 20 degrees above, over white. `in_unit_box`: normalised. `lit`: by the light
// of the photo, which stands still while the camera goes round; else the colours alone.
std::vector<core::Image> NovelViews(const core::TexturedMesh& in_unit_box, double photo_azimuth,
                                    bool lit);

// 10 log10(255^2 / mean squared difference) of RGB, dB; at most 99. Pictures of one size.
double PeakSignalToNoise(const core::Image& a, const core::Image& b);

// The mesh moved, its colours as they are.
core::TexturedMesh Moved(core::TexturedMesh mesh, const Eigen::Affine3d& to);

// Checks alignment and scores against what is known by formula; prints each figure and its bound.
// Returns whether all hold. `sample`: any real mesh.
bool MeasuresHold(const core::TriangleMesh& sample);

}  // namespace simwright::bench
