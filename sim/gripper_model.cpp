#include "sim/gripper_model.h"

#include <memory>
#include <utility>

#include "core/error.h"

namespace simwright::sim {
namespace {

constexpr double kPalmRadius = 0.05;  // m of the ball whose inertia the palm has

// Returns the inertial of a box around `parts` with the given mass (kg).
assets::Inertial BoxInertial(const std::vector<core::TriangleMesh>& parts, double mass) {
  Eigen::AlignedBox3d box;
  for (const core::TriangleMesh& part : parts) {
    for (const Eigen::Vector3d& vertex : part.vertices) box.extend(vertex);
  }
  const Eigen::Vector3d squares = box.sizes().cwiseAbs2();
  assets::Inertial inertial;
  inertial.mass = mass;
  inertial.center_of_mass = box.center();
  inertial.inertia =
      (mass / 12.0 * (Eigen::Vector3d::Constant(squares.sum()) - squares)).asDiagonal();
  return inertial;
}

assets::Joint FingerJoint(int finger, double stroke, double damping) {
  assets::Joint joint;
  joint.name = finger == 0 ? "finger_joint_0" : "finger_joint_1";
  joint.parent = "palm";
  joint.child = finger == 0 ? "finger_0" : "finger_1";
  joint.type = assets::JointType::kPrismatic;
  joint.axis = finger == 0 ? Eigen::Vector3d(0.0, -1.0, 0.0) : Eigen::Vector3d(0.0, 1.0, 0.0);
  joint.upper = stroke;
  joint.damping = damping;
  if (finger == 1) joint.mimic = assets::JointMimic{"finger_joint_0"};
  return joint;
}

}  // namespace

bool GripperModel::IsValid(std::string* error) const {
  const auto fail = [&](const char* text) {
    if (error != nullptr) *error = text;
    return false;
  };
  if (fingers[0].empty() || fingers[1].empty()) return fail("each finger needs a convex part");
  if (!(max_opening > 0.0) || max_opening > 1.0) return fail("max_opening must be in (0, 1] m");
  if (!(force > 0.0) || force > 1e4) return fail("force must be in (0, 10000] N");
  if (!(finger_mass > 0.0)) return fail("finger_mass must be positive");
  if (!(friction > 0.0)) return fail("friction must be positive");
  if (!(torsion >= 0.0)) return fail("torsion must not be negative");
  return true;
}

ArticulatedBody GripperBody(const GripperModel& gripper, double palm_mass, double finger_damping) {
  std::string error;
  if (!gripper.IsValid(&error)) throw core::Error("invalid gripper: " + error, gripper.name);
  ArticulatedBody body;
  RigidBody palm;
  palm.name = "palm";
  palm.parts = gripper.palm;
  palm.capsules = gripper.palm_capsules;
  palm.inertial.mass = palm_mass;
  palm.inertial.inertia =
      Eigen::Matrix3d::Identity() * (0.4 * palm_mass * kPalmRadius * kPalmRadius);
  body.links.push_back(std::move(palm));
  std::vector<assets::KinematicLink> links = {{"palm", body.links[0].inertial}};
  std::vector<assets::Joint> joints;
  for (int i = 0; i < 2; ++i) {
    RigidBody finger;
    finger.name = i == 0 ? "finger_0" : "finger_1";
    finger.parts = gripper.fingers[static_cast<size_t>(i)];
    finger.inertial = BoxInertial(finger.parts, gripper.finger_mass);
    links.push_back({finger.name, finger.inertial});
    joints.push_back(FingerJoint(i, 0.5 * gripper.max_opening, finger_damping));
    body.links.push_back(std::move(finger));
  }
  for (RigidBody& link : body.links) {
    link.friction = 1.0;
    link.torsional_friction = link.name == "palm" ? 0.0 : gripper.torsion;
  }
  body.kinematics = std::make_shared<assets::KinematicModel>(gripper.name, links, joints);
  return body;
}

}  // namespace simwright::sim
