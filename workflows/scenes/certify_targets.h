#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>

#include "certificate/certificate.h"
#include "scene/grammar/category_size.h"
#include "scene/grammar/scene_sample.h"
#include "workflows/scenes/certify_task.h"

namespace simwright::workflows {

// The places of the robot, one for each piece of furniture at a pose. Thread-safe.
class RobotBases {
 public:
  // `given`: x, y, z (m) and yaw (rad) of the one base; none: one is chosen. `planner` must outlive
  // this.
  RobotBases(const certificate::Planner& planner, const std::optional<Eigen::Vector4d>& given);

  // Returns the base for working at `support` (-1: none).
  Eigen::Isometry3d For(const certificate::PlacedScene& scene, int support);

 private:
  const certificate::Planner& planner_;
  std::optional<Eigen::Isometry3d> given_;
  std::mutex mutex_;
  std::vector<std::tuple<std::shared_ptr<const certificate::BodyModel>, Eigen::Isometry3d,
                         Eigen::Isometry3d>>
      known_;
};

// Returns the free objects of a scene that a reference may mean.
std::vector<int> MeantObjects(const std::vector<scene::SceneObject>& objects,
                              const scene::CategorySizes& sizes,
                              const scene::ObjectReference& reference);

// Returns the goals of a task for each object that it may mean. `placed`: the bodies of `objects`,
// in their order.
std::vector<certificate::TargetTask> CertifyTargets(const CertifyTask& task,
                                                    const std::vector<scene::SceneObject>& objects,
                                                    const scene::CategorySizes& sizes,
                                                    const certificate::PlacedScene& placed,
                                                    RobotBases* bases);

}  // namespace simwright::workflows
