#pragma once

#include <vector>

#include "assets/link_visuals.h"
#include "core/mesh.h"
#include "render/scene.h"
#include "workflows/skills/skill_recording.h"

namespace simwright::workflows {

// The visuals of a robot and the objects of one task, ready to be posed at a recorded moment.
class PosedScene {
 public:
  // `variant` and `robot` must outlive the scene. Unreadable visuals are omitted.
  PosedScene(const robot::RobotModel& robot, const skills::SkillVariant& variant);

  // Adds all objects at `moment`, and the floor. `scene` must not outlive this object.
  void Place(const RecordedMoment& moment, render::Scene* scene) const;
  // Returns the AABB of the robot and the objects at `moment`, m, world frame, without the floor.
  Eigen::AlignedBox3d Bounds(const RecordedMoment& moment) const;

 private:
  struct Piece {
    core::TexturedMesh mesh;  // link frame
    int object = -1;          // -1: the robot
    int link = 0;             // an index into the object's links or the robot URDF's
  };
  void Add(const assets::LinkVisual& visual, const Eigen::Vector4f& color, int object);
  // Returns the pose of each piece.
  std::vector<Eigen::Isometry3d> Poses(const RecordedMoment& moment) const;

  const robot::RobotModel& robot_;
  const skills::SkillVariant& variant_;
  std::vector<Piece> pieces_;
  core::TexturedMesh floor_;
};

}  // namespace simwright::workflows
