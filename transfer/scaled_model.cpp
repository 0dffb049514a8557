#include "transfer/scaled_model.h"

#include <cmath>

namespace simwright::transfer {
namespace {

void ScaleInertial(double factor, assets::Inertial* inertial) {
  inertial->mass *= std::pow(factor, 3);
  inertial->center_of_mass *= factor;
  inertial->inertia *= std::pow(factor, 5);
}

void ScaleShape(double factor, assets::UrdfShape* shape) {
  for (Eigen::Vector3d& vertex : shape->mesh.vertices) vertex *= factor;
  shape->link_from_file = Eigen::Scaling(factor) * shape->link_from_file;
  shape->radius *= factor;
  shape->length *= factor;
  shape->link_from_primitive.translation() *= factor;
}

void ScaleJoint(double factor, assets::Joint* joint) {
  joint->parent_from_joint.translation() *= factor;
  if (joint->type != assets::JointType::kPrismatic) return;
  joint->lower *= factor;
  joint->upper *= factor;
  if (joint->mimic) joint->mimic->offset *= factor;
}

}  // namespace

assets::SemanticModel ScaledModel(const assets::SemanticModel& model, double factor) {
  assets::SemanticModel scaled = model;
  for (assets::UrdfLink& link : scaled.model.links) {
    link.visuals.clear();
    link.rolling_friction *= factor;
    if (link.inertial) ScaleInertial(factor, &*link.inertial);
    for (assets::UrdfShape& shape : link.collisions) ScaleShape(factor, &shape);
  }
  for (assets::Joint& joint : scaled.model.joints) ScaleJoint(factor, &joint);
  return scaled;
}

manipulation::Grasp ScaledGrasp(const manipulation::Grasp& grasp, double factor) {
  manipulation::Grasp scaled = grasp;
  scaled.object_from_tool.translation() *= factor;
  scaled.width *= factor;
  scaled.opening *= factor;
  for (Eigen::Vector3d& contact : scaled.contacts) contact *= factor;
  return scaled;
}

}  // namespace simwright::transfer
