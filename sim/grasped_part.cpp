#include "sim/grasped_part.h"

#include <cmath>

namespace simwright::sim {

bool GraspedPart::IsValid(std::string* error) const {
  const auto fail = [&](const char* text) {
    if (error != nullptr) *error = text;
    return false;
  };
  if (body.kinematics == nullptr) return fail("the part has no body");
  const auto joints = static_cast<int>(body.joints().size());
  if (link < 1 || link >= static_cast<int>(body.links.size())) {
    return fail("the link must be one of the body, other than its root");
  }
  if (joint < 0 || joint >= joints) return fail("the joint must be one of the body");
  if (!positions.empty() && static_cast<int>(positions.size()) != joints) {
    return fail("the positions must be one per joint");
  }
  const assets::Joint& moves = body.joints()[static_cast<size_t>(joint)];
  if (!moves.Moves() || moves.mimic) return fail("the joint does not move by itself");
  if (!body.kinematics->Subtree(joint + 1)[static_cast<size_t>(link)]) {
    return fail("the joint does not move the link");
  }
  if (!(std::abs(far - rest) > 0.0) || !std::isfinite(far - rest)) {
    return fail("the joint has no range");
  }
  const std::vector<bool> held = Held();
  for (size_t i = 0; i < body.links.size(); ++i) {
    if (held[i] && !body.links[i].parts.empty()) return true;
  }
  return fail("the link has no collision part");
}

std::vector<double> GraspedPart::PositionsAt(double position) const {
  std::vector<double> all = positions;
  all.resize(body.joints().size(), 0.0);
  all[static_cast<size_t>(joint)] = position;
  return all;
}

std::vector<bool> GraspedPart::Held() const {
  std::vector<bool> held;
  for (size_t i = 0; i < body.links.size(); ++i) {
    held.push_back(body.kinematics->RigidlyJoined(link, static_cast<int>(i)));
  }
  return held;
}

double GraspedPart::MovedMass() const {
  const std::vector<bool> moved = body.kinematics->Subtree(joint + 1);
  double mass = 0.0;
  for (size_t i = 0; i < body.links.size(); ++i) {
    if (moved[i]) mass += body.links[i].inertial.mass;
  }
  return mass;
}

}  // namespace simwright::sim
