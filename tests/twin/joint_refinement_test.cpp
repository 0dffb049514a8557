#include "twin/joint_refinement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/twin/rendered_table.h"

namespace simwright::twin {
namespace {

const TableCamera kCamera{0.65, 0.02, 1.1, 0.75};

RenderedTable ThreeObjects() {
  return RenderKinds({{"mug", 3, -0.14, 0.95, 0.8},
                      {"cereal_box", 4, 0.12, 1.15, 0.4},
                      {"bowl", 2, 0.05, 0.8, 0.0}},
                     kCamera);
}

TEST(RefineJointly, BringsMovedObjectsBack) {
  const RenderedTable table = ThreeObjects();
  std::vector<RefinedObject> objects;
  const double moves[3][4] = {
      {0.015, -0.02, 0.12, 0.04}, {-0.01, 0.03, -0.1, -0.05}, {0.012, 0.012, 0.0, 0.05}};
  for (size_t k = 0; k < 3; ++k) {
    const TableObject& object = table.scene.objects[k];
    const Eigen::Vector3d at = object.world_from_object.translation();
    const Eigen::Matrix3d turn = object.world_from_object.linear();
    RefinedObject refined;
    refined.mesh = object.visual.mesh;
    refined.pose = {{at.x() + moves[k][0], at.y() + moves[k][1],
                     std::atan2(turn(1, 0), turn(0, 0)) + moves[k][2]},
                    std::exp(moves[k][3])};
    objects.push_back(std::move(refined));
  }
  TableCameraGuess guess;
  guess.camera = kCamera;
  guess.elevation_error = guess.roll_error = guess.log_focal_error = 0.0;
  const JointRefinement joint = RefineJointly(objects, table.detections, guess, {});
  EXPECT_LT(joint.last_error, 0.3 * joint.first_error);
  EXPECT_NEAR(joint.camera.elevation, kCamera.elevation, 1e-9);
  for (size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d at = table.scene.objects[k].world_from_object.translation();
    EXPECT_NEAR(joint.poses[k].pose.x, at.x(), 0.003) << k;
    EXPECT_NEAR(joint.poses[k].pose.y, at.y(), 0.006) << k;
    EXPECT_NEAR(joint.poses[k].scale, 1.0, 0.015) << k;
  }
  EXPECT_NEAR(std::remainder(joint.poses[1].pose.yaw - 0.4, M_PI), 0.0, 0.03);
}

// With shapes and poses that are right but for the elevation of the camera, the elevation returns.
TEST(RefineJointly, FindsTheElevation) {
  const RenderedTable table = ThreeObjects();
  std::vector<RefinedObject> objects;
  for (const TableObject& object : table.scene.objects) {
    const Eigen::Vector3d at = object.world_from_object.translation();
    const Eigen::Matrix3d turn = object.world_from_object.linear();
    objects.push_back({object.visual.mesh,
                       {{at.x(), at.y(), std::atan2(turn(1, 0), turn(0, 0))}, 1.0},
                       0.0,
                       0.01});
  }
  TableCameraGuess guess;
  guess.camera = kCamera;
  guess.camera.elevation += 0.04;
  guess.elevation_error = 0.2;
  guess.roll_error = guess.log_focal_error = 0.0;
  const JointRefinement joint = RefineJointly(objects, table.detections, guess, {});
  EXPECT_NEAR(joint.camera.elevation, kCamera.elevation, 0.012);
  EXPECT_LT(joint.last_error, 0.2 * joint.first_error);
}

TEST(RefineJointly, RefusesWhatDoesNotMatch) {
  EXPECT_THROW(RefineJointly({}, {}, {}, {}), core::Error);
  JointRefinementOptions options;
  options.width = 3;
  std::string error;
  EXPECT_FALSE(options.IsValid(&error));
  EXPECT_NE(error.find("32"), std::string::npos);
}

}  // namespace
}  // namespace simwright::twin
