// The self-collision shapes of a robot, and the pairs whose contact is ignored.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "assets/joint_poses.h"
#include "geometry/distance.h"
#include "robot/robot_model.h"
#include "tests/robot/random_configuration.h"

namespace simwright::robot {
namespace {

// Returns the smallest distance between the shapes of two links, m; below 0 if they overlap.
double Distance(const RobotModel& model, const std::vector<Eigen::Isometry3d>& poses, std::size_t a,
                std::size_t b) {
  double least = 10.0;
  for (const auto& one : model.urdf.links[a].collisions) {
    for (const auto& other : model.urdf.links[b].collisions) {
      least = std::min(least, geometry::SignedDistance({one.mesh.vertices, 0.0}, poses[a],
                                                       {other.mesh.vertices, 0.0}, poses[b])
                                  .distance);
    }
  }
  return least;
}

class SelfCollision : public testing::TestWithParam<const char*> {
 protected:
  SelfCollision()
      : model_(ReadRobot(std::filesystem::path(SIMWRIGHT_SOURCE_DIR) / "robots" / GetParam())) {
    for (const auto& [a, b] : model_.ignored_collisions) {
      ignored_.insert({std::min(a, b), std::max(a, b)});
    }
  }
  // Returns the checked pairs of links that overlap with the arm at `q`.
  std::vector<std::string> Overlaps(const Eigen::VectorXd& q, double opening) const {
    assets::JointPositions positions;
    for (int j = 0; j < model_.arm.size(); ++j) positions[model_.arm.joints[j].name] = q[j];
    positions[model_.urdf.joints[model_.gripper.joints[0]].name] = opening;
    const auto poses = assets::LinkPoses(model_.urdf, positions);
    std::vector<std::string> found;
    for (std::size_t a = 0; a < poses.size(); ++a) {
      for (std::size_t b = a + 1; b < poses.size(); ++b) {
        if (ignored_.contains({static_cast<int>(a), static_cast<int>(b)})) continue;
        if (Distance(model_, poses, a, b) >= 0.0) continue;
        found.push_back(model_.urdf.links[a].name + " and " + model_.urdf.links[b].name);
      }
    }
    return found;
  }

  const RobotModel model_;
  std::set<std::pair<int, int>> ignored_;
};

TEST_P(SelfCollision, NoneAtHomeWithTheGripperOpenOrClosed) {
  for (const double opening : {model_.gripper.open, model_.gripper.closed}) {
    for (const std::string& pair : Overlaps(model_.home(), opening)) ADD_FAILURE() << pair;
  }
}

// A pair that overlaps in every configuration would stop the arm: such pairs must be ignored.
TEST_P(SelfCollision, NoPairThatIsCheckedOverlapsUsually) {
  core::Rng rng(17);
  std::map<std::string, int> overlaps;
  constexpr int kConfigurations = 100;
  for (int i = 0; i < kConfigurations; ++i) {
    for (const std::string& pair : Overlaps(RandomPosture(model_.arm, rng), model_.gripper.open)) {
      ++overlaps[pair];
    }
  }
  for (const auto& [pair, count] : overlaps) EXPECT_LT(count, kConfigurations / 10) << pair;
}

INSTANTIATE_TEST_SUITE_P(Robots, SelfCollision,
                         testing::Values("panda/panda.urdf", "panda/panda_on_base.urdf",
                                         "generic6/generic6.urdf"));

}  // namespace
}  // namespace simwright::robot
