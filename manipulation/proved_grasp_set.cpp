#include "manipulation/proved_grasp_set.h"

#include <algorithm>
#include <utility>

namespace simwright::manipulation {
namespace {

// Returns a set without grasps.
GraspSet SetOf(const std::string& object, const std::string& file, const ParallelGripper& gripper) {
  GraspSet set;
  set.object = object;
  set.mesh = file;
  set.gripper = gripper.model.name;
  set.base_link = gripper.base_link;
  set.tool_from_base = gripper.tool_from_base;
  set.max_opening = gripper.model.max_opening;
  set.force = gripper.model.force;
  set.joints = gripper.joints;
  return set;
}

}  // namespace

GraspSet MakeGraspSet(const GraspObject& object, const std::string& mesh,
                      const ParallelGripper& gripper, const ProvedGrasps& proved) {
  GraspSet set = SetOf(object.name, mesh, gripper);
  set.friction = proved.friction;
  set.grasps = proved.grasps;
  set.tried = proved.tried;
  set.held_in_bullet = proved.held_in_bullet;
  set.held_in_both = proved.held_in_both;
  set.coverage = proved.coverage;
  return set;
}

GraspSet MakeGraspSet(const std::string& name, const std::string& urdf,
                      const ParallelGripper& gripper, const std::vector<Handle>& handles,
                      const std::vector<ProvedGrasps>& proofs) {
  GraspSet set = SetOf(name, urdf, gripper);
  double candidates = 0.0, covered = 0.0;
  for (size_t i = 0; i < handles.size(); ++i) {
    const ProvedGrasps& proved = proofs[i];
    JointProof proof{.joint = handles[i].joint,
                     .link = handles[i].link,
                     .grasps = static_cast<int>(proved.grasps.size()),
                     .friction = proved.friction,
                     .tried = proved.tried,
                     .held_in_bullet = proved.held_in_bullet,
                     .held_in_both = proved.held_in_both,
                     .coverage = proved.coverage,
                     .reason = handles[i].reason};
    if (proof.reason.empty()) proof.reason = proved.WhyNone(gripper.model);
    for (Grasp grasp : proved.grasps) {
      grasp.link = proof.link;
      grasp.joint = proof.joint;
      set.grasps.push_back(std::move(grasp));
    }
    set.tried += proof.tried;
    set.held_in_bullet += proof.held_in_bullet;
    set.held_in_both += proof.held_in_both;
    candidates += static_cast<double>(proved.sampling.grasps.size());
    covered += proved.coverage * static_cast<double>(proved.sampling.grasps.size());
    if (proof.grasps > 0 && (set.friction == 0.0 || proof.friction < set.friction)) {
      set.friction = proof.friction;
    }
    set.joint_proofs.push_back(std::move(proof));
  }
  set.coverage = candidates > 0.0 ? covered / candidates : 0.0;
  std::stable_sort(set.grasps.begin(), set.grasps.end(),
                   [](const Grasp& a, const Grasp& b) { return a.quality > b.quality; });
  return set;
}

}  // namespace simwright::manipulation
