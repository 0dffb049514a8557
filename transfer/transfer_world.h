#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "assets/semantic_model.h"
#include "geometry/distance.h"
#include "manipulation/grasp.h"

namespace simwright::transfer {

// An object of a world in which a task of a twin is tried.
struct TransferObject {
  assets::SemanticModel model;              // under the name that the task uses
  std::vector<manipulation::Grasp> grasps;  // proved ones, in the object's frame; may be empty
  Eigen::Isometry3d world_from_asset = Eigen::Isometry3d::Identity();
  bool fixed = false;
  double mass = 1.0, friction = 1.0;  // factors
};

// The world itself: other objects, sizes, places or masses than the task describes.
struct TransferWorld {
  std::vector<TransferObject> objects;    // those of the task, and what else stands there
  std::optional<double> finger_friction;  // coefficient; none: the robot's own
};

// Returns the convex collision parts of a model, joints at zero, in its own frame, m.
std::vector<geometry::ConvexShape> PartsOf(const assets::SemanticModel& model);

// Returns the shapes, all lengths times `factor`, in `pose`.
std::vector<geometry::ConvexShape> Placed(const std::vector<geometry::ConvexShape>& shapes,
                                          double factor, const Eigen::Isometry3d& pose);

// Returns true if no shape of one touches a shape of the other.
bool AreApart(const std::vector<geometry::ConvexShape>& one,
              const std::vector<geometry::ConvexShape>& other);

// Returns the bounding box of shapes, m.
Eigen::AlignedBox3d BoundsOf(const std::vector<geometry::ConvexShape>& shapes);

}  // namespace simwright::transfer
