#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "pipeline/skill_recording.h"
#include "render/scene.h"
#include "tasks/task.h"

namespace simwright::pipeline {

// What is seen of a robot and the things of one task, ready to be put where a moment has them.
class PosedScene {
 public:
  // `variant` and `robot` must outlive the scene; `assets` are the run's, of which the variant's
  // things are some. A visual that cannot be read is left out.
  PosedScene(const robot::RobotModel& robot, const rl::SkillVariant& variant,
             const std::vector<tasks::TaskAsset>& assets);

  // Adds everything as it stands at `moment`, and the floor. `scene` must not outlive this.
  void Place(const RecordedMoment& moment, render::Scene* scene) const;
  // What the robot and the things fill at `moment`, m, world; without the floor.
  Eigen::AlignedBox3d Bounds(const RecordedMoment& moment) const;

 private:
  struct Piece {
    core::TexturedMesh mesh;  // link frame
    int thing = -1;           // -1: the robot
    int link = 0;             // of the thing's, or of the robot's URDF
  };
  void AddLink(const assets::UrdfLink& link, const Eigen::Vector4f& color, int thing, int index);
  // By piece.
  std::vector<Eigen::Isometry3d> Poses(const RecordedMoment& moment) const;

  const robot::RobotModel& robot_;
  const rl::SkillVariant& variant_;
  std::vector<Piece> pieces_;
  core::TexturedMesh floor_;
};

}  // namespace simwright::pipeline
