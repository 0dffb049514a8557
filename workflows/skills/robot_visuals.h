#pragma once

#include <vector>

#include "core/mesh.h"
#include "render/scene.h"
#include "robot/robot_model.h"

namespace simwright::workflows {

// The visual shapes of a robot, ready to be posed. Unreadable visuals are omitted.
class RobotVisuals {
 public:
  // `robot` must outlive this.
  explicit RobotVisuals(const robot::RobotModel& robot);

  // Adds the robot at a configuration (J) and a position of the gripper's first joint. `scene` must
  // not outlive this object.
  void Place(const Eigen::VectorXd& arm, double leader, const Eigen::Isometry3d& world_from_robot,
             render::Scene* scene) const;

 private:
  struct Piece {
    core::TexturedMesh mesh;  // link frame
    size_t link = 0;          // in urdf.links
  };

  const robot::RobotModel& robot_;
  std::vector<Piece> pieces_;
};

}  // namespace simwright::workflows
