#include "workflows/scenes/certify_targets.h"

#include "certificate/robot_base.h"
#include "scene/prompt/object_names.h"
#include "scene/prompt/relation.h"

namespace simwright::workflows {

RobotBases::RobotBases(const certificate::Planner& planner,
                       const std::optional<Eigen::Vector4d>& given)
    : planner_(planner) {
  if (!given) return;
  given_.emplace(Eigen::Translation3d(given->head<3>()) *
                 Eigen::AngleAxisd((*given)[3], Eigen::Vector3d::UnitZ()));
}

Eigen::Isometry3d RobotBases::For(const certificate::PlacedScene& scene, int support) {
  if (given_) return *given_;
  if (support < 0) return Eigen::Isometry3d::Identity();
  const certificate::PlacedBody& body = scene.bodies[static_cast<size_t>(support)];
  const std::lock_guard lock(mutex_);
  for (const auto& [model, pose, base] : known_) {
    if (model == body.model && pose.isApprox(body.world_from_body, 1e-9)) return base;
  }
  const certificate::RobotBase chosen = certificate::ChooseRobotBase(planner_, scene, support);
  known_.emplace_back(body.model, body.world_from_body, chosen.world_from_robot);
  return chosen.world_from_robot;
}

std::vector<int> MeantObjects(const std::vector<scene::SceneObject>& objects,
                              const scene::CategorySizes& sizes,
                              const scene::ObjectReference& reference) {
  std::vector<int> indices;
  std::vector<scene::PlacedBox> boxes;
  for (size_t k = 0; k < objects.size(); ++k) {
    const scene::SceneObject& object = objects[k];
    if (object.welded || scene::NameOfCategory(object.category) != reference.name) continue;
    indices.push_back(static_cast<int>(k));
    boxes.push_back(scene::BoxOf(sizes.at(object.category), object.world_from_object));
  }
  if (reference.ordinal == 0) return indices;
  std::vector<const scene::PlacedBox*> pointers;
  for (const scene::PlacedBox& box : boxes) pointers.push_back(&box);
  const std::vector<int> order = scene::OrdinalOrder(pointers);
  const auto wanted = static_cast<size_t>(reference.ordinal) - 1;
  if (wanted >= order.size()) return {};
  return {indices[static_cast<size_t>(order[wanted])]};
}

std::vector<certificate::TargetTask> CertifyTargets(const CertifyTask& task,
                                                    const std::vector<scene::SceneObject>& objects,
                                                    const scene::CategorySizes& sizes,
                                                    const certificate::PlacedScene& placed,
                                                    RobotBases* bases) {
  std::vector<certificate::TargetTask> targets;
  for (const int object : MeantObjects(objects, sizes, task.object)) {
    certificate::TargetTask target;
    target.target = object;
    target.world_from_robot = bases->For(placed, certificate::SupportOf(placed, object));
    if (task.kind == CertifyKind::kLift) {
      target.goal = certificate::LiftGoal();
    } else if (task.kind == CertifyKind::kFront) {
      target.goal = certificate::FrontGoal(placed, object);
    } else {
      for (const int other : MeantObjects(objects, sizes, task.other)) {
        if (other == object) continue;
        target.goal = certificate::BesideGoal(placed, object, other);
        if (target.goal) break;
      }
    }
    targets.push_back(std::move(target));
  }
  return targets;
}

}  // namespace simwright::workflows
