#include "importers/link_folding.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "assets/joint_poses.h"
#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "core/finding_text.h"

namespace simwright::importers {
namespace {

using assets::Joint;
using assets::JointType;
using assets::UrdfLink;
using assets::UrdfModel;
using assets::UrdfShape;

constexpr double kMarkShare = 0.02;  // the root cube's edge over the model's extent
constexpr double kWater = 1000.0;    // kg/m3, the cube's density
constexpr double kRounding = 1e-12;  // of an axis, the residue of a rotation by 1.5708

bool HasShapes(const UrdfLink& link) {
  return !link.visuals.empty() || !link.collisions.empty();
}

void TransformShapes(const Eigen::Affine3d& map, UrdfLink* link) {
  for (std::vector<UrdfShape>* shapes : {&link->visuals, &link->collisions}) {
    for (UrdfShape& shape : *shapes) {
      core::Transform(map, &shape.mesh);
      shape.link_from_file = map * shape.link_from_file;
    }
  }
}

void TransformInertial(const Eigen::Isometry3d& map, double scale, UrdfLink* link) {
  if (!link->inertial) return;
  assets::Inertial& inertial = *link->inertial;
  inertial.center_of_mass = map * (scale * inertial.center_of_mass);
  inertial.inertia =
      (scale * scale * map.linear() * inertial.inertia * map.linear().transpose()).eval();
}

// The tree while it is folded: each link with the joint that leads to it.
class Folding {
 public:
  explicit Folding(UrdfModel* model) : model_(model) {
    const std::vector<int> parents = assets::ParentLinks(*model);
    nodes_.resize(model->links.size());
    for (size_t i = 0; i < nodes_.size(); ++i) {
      nodes_[i].link = std::move(model->links[i]);
      if (i == 0) continue;
      nodes_[i].joint = std::move(model->joints[i - 1]);
      nodes_[i].parent = parents[i - 1];
      nodes_[static_cast<size_t>(parents[i - 1])].children.push_back(i);
    }
  }

  void Fold() {
    for (size_t i = nodes_.size(); i-- > 0;) {
      if (HasShapes(nodes_[i].link)) continue;
      if (!MergeFixedChild(i) && i > 0 && !nodes_[i].joint.Moves()) ReparentChildren(i);
    }
  }

  void WriteBack() {
    model_->links.clear();
    model_->joints.clear();
    for (Node& node : nodes_) {
      if (node.gone) continue;
      if (!HasShapes(node.link) && node.parent < 0 && !node.children.empty()) MarkRoot(&node.link);
      if (!HasShapes(node.link)) {
        throw core::Error("link '" + node.link.name + "' has no shape" +
                              (node.parent < 0 ? "" : ", and it moves"),
                          model_->name, "give it a mesh, or correct the file names of its meshes");
      }
      if (node.parent >= 0) {
        node.joint.parent = nodes_[static_cast<size_t>(node.parent)].link.name;
        node.joint.child = node.link.name;
        model_->joints.push_back(node.joint);
      }
      model_->links.push_back(node.link);
    }
  }

 private:
  struct Node {
    UrdfLink link;
    Joint joint;  // the joint that leads to the link
    int parent = -1;
    std::vector<size_t> children;
    bool gone = false;
  };

  void Adopt(size_t parent, size_t child, const Eigen::Isometry3d& parent_from_old) {
    Node& node = nodes_[child];
    node.parent = static_cast<int>(parent);
    node.joint.parent_from_joint = parent_from_old * node.joint.parent_from_joint;
    nodes_[parent].children.push_back(child);
  }

  bool MergeFixedChild(size_t index) {
    std::vector<size_t>& children = nodes_[index].children;
    const auto found = std::find_if(children.begin(), children.end(), [&](size_t c) {
      return !nodes_[c].joint.Moves() && HasShapes(nodes_[c].link);
    });
    if (found == children.end()) return false;
    Node& child = nodes_[*found];
    child.gone = true;
    children.erase(found);
    const Eigen::Isometry3d index_from_child = child.joint.parent_from_joint;
    for (const size_t grandchild : child.children) Adopt(index, grandchild, index_from_child);
    nodes_[index].link = std::move(child.link);
    TransformShapes(Eigen::Affine3d(index_from_child), &nodes_[index].link);
    TransformInertial(index_from_child, 1.0, &nodes_[index].link);
    return true;
  }

  // Puts a small cube at the origin of a "world" root on which a hinge or slide hangs.
  void MarkRoot(UrdfLink* root) {
    Eigen::AlignedBox3d bounds;
    double chain = 0.0;  // m, between joint origins: links may be small in comparison
    for (const Node& node : nodes_) {
      if (node.gone) continue;
      if (node.parent >= 0) chain += node.joint.parent_from_joint.translation().norm();
      for (const auto* shapes : {&node.link.visuals, &node.link.collisions}) {
        for (const UrdfShape& shape : *shapes) bounds.extend(core::Bounds(shape.mesh));
      }
    }
    if (bounds.isEmpty()) return;
    const double edge = kMarkShare * (bounds.diagonal().norm() + chain);
    root->visuals.push_back({assets::BoxMesh(Eigen::Vector3d::Constant(edge)), ""});
    const bool weighed = std::any_of(nodes_.begin(), nodes_.end(), [](const Node& node) {
      return !node.gone && node.link.inertial.has_value();
    });
    const double mass = kWater * edge * edge * edge;
    if (weighed) {
      root->inertial = assets::Inertial{mass, Eigen::Vector3d::Zero(),
                                        mass * edge * edge / 6.0 * Eigen::Matrix3d::Identity()};
    }
    model_->root_is_world = true;
    model_->findings.push_back({"root-marked", core::Severity::kWarning, root->name,
                                "it is the root and has no shape: it gets a cube of " +
                                    core::Millimetres(edge) + ", and the asset is fixed there",
                                1e3 * edge, "give it a mesh if there is one"});
  }

  void ReparentChildren(size_t index) {
    Node& node = nodes_[index];
    const size_t parent = static_cast<size_t>(node.parent);
    std::erase(nodes_[parent].children, index);
    for (const size_t child : node.children) Adopt(parent, child, node.joint.parent_from_joint);
    node.gone = true;
  }

  UrdfModel* model_;
  std::vector<Node> nodes_;  // a parent precedes its children
};

void Warn(const Joint& joint, const std::string& code, core::Severity severity,
          const std::string& sentence, double figure, UrdfModel* model) {
  model->findings.push_back({code, severity, joint.name, sentence, figure});
}

void FixWithoutRange(Joint* joint, UrdfModel* model) {
  Warn(*joint, "joint-no-range", core::Severity::kWarning,
       "its limits leave no range of motion: it becomes fixed", joint->upper - joint->lower, model);
  joint->type = JointType::kFixed;
  joint->lower = joint->upper = 0.0;
}

// Moves zero to the nearest limit if it lies beyond both.
void BringZeroWithin(Joint* joint, UrdfModel* model) {
  const double shift = std::clamp(0.0, joint->lower, joint->upper);
  if (shift == 0.0) return;
  Warn(*joint, "joint-zero", core::Severity::kWarning,
       "zero lies outside its limits: the nearest limit became zero", shift, model);
  joint->parent_from_joint = joint->parent_from_joint * assets::JointMotion(*joint, shift);
  joint->lower -= shift;
  joint->upper -= shift;
}

void FlipNegativeAxis(Joint* joint, UrdfModel* model) {
  if (-joint->lower <= joint->upper) return;
  Warn(*joint, "joint-turned", core::Severity::kInfo,
       "its range was mostly negative: its axis and limits were reversed", joint->lower, model);
  joint->axis = -joint->axis;
  joint->lower = -std::exchange(joint->upper, -joint->lower);
}

// Makes a base that floats in a "world" without shapes the root, because assets are free-standing.
void MakeFloatingBaseRoot(UrdfModel* model) {
  if (model->joints.empty() || HasShapes(model->links.front())) return;
  const std::string& root = model->links.front().name;
  const auto is_child_of_root = [&](const Joint& joint) { return joint.parent == root; };
  if (std::count_if(model->joints.begin(), model->joints.end(), is_child_of_root) != 1) return;
  const auto joint = std::find_if(model->joints.begin(), model->joints.end(), is_child_of_root);
  if (joint->type != JointType::kFloating && joint->type != JointType::kPlanar) return;
  Warn(*joint, "floating-base", core::Severity::kInfo,
       "it lets '" + joint->child + "' float in '" + root + "', which has no shape: '" +
           joint->child + "' is the root",
       0.0, model);
  joint->type = JointType::kFixed;
}

}  // namespace

void FoldEmptyLinks(UrdfModel* model) {
  MakeFloatingBaseRoot(model);
  Folding folding(model);
  folding.Fold();
  folding.WriteBack();
}

void NormaliseJoints(UrdfModel* model, bool keep_directions) {
  for (Joint& joint : model->joints) {
    if (joint.type == JointType::kFloating || joint.type == JointType::kPlanar) {
      throw core::Error("joint '" + joint.name + "' is floating or planar", model->name,
                        "an asset only has hinges and slides: make it one of those, or fixed");
    }
    if (!joint.Moves()) continue;
    if (joint.mimic) {
      Warn(joint, "joint-mimic", core::Severity::kWarning,
           "it mimics '" + joint.mimic->joint + "' in the file and is independent here",
           joint.mimic->multiplier, model);
      joint.mimic.reset();
    }
    if (joint.type == JointType::kContinuous) {
      joint.lower = joint.upper = 0.0;
    } else if (!(joint.upper > joint.lower)) {
      FixWithoutRange(&joint, model);
    } else {
      BringZeroWithin(&joint, model);
      if (!keep_directions) FlipNegativeAxis(&joint, model);
    }
  }
}

Eigen::AlignedBox3d BoundsAtZero(const UrdfModel& model) {
  const std::vector<Eigen::Isometry3d> poses = assets::LinkPosesAtZero(model);
  Eigen::AlignedBox3d box;
  for (size_t i = 0; i < model.links.size(); ++i) {
    const UrdfLink& link = model.links[i];
    for (const UrdfShape& shape : link.visuals.empty() ? link.collisions : link.visuals) {
      for (const Eigen::Vector3d& v : shape.mesh.vertices) box.extend(poses[i] * v);
    }
  }
  return box;
}

void CenterAboveOrigin(double scale, UrdfModel* model) {
  const Eigen::AlignedBox3d box = BoundsAtZero(*model);
  const Eigen::Vector3d base(box.center().x(), box.center().y(), box.min().z());
  const std::vector<Eigen::Isometry3d> old_poses = assets::LinkPosesAtZero(*model);
  const std::vector<int> parents = assets::ParentLinks(*model);
  std::vector<Eigen::Vector3d> origins;  // of the new frames, in the new root's frame, m
  for (size_t i = 0; i < model->links.size(); ++i) {
    UrdfLink& link = model->links[i];
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    if (i > 0 && model->joints[i - 1].Moves()) {
      origin = scale * (old_poses[i].translation() - base);
    } else if (i > 0) {
      Eigen::AlignedBox3d own;
      for (const UrdfShape& shape : link.visuals.empty() ? link.collisions : link.visuals) {
        for (const Eigen::Vector3d& v : shape.mesh.vertices) own.extend(old_poses[i] * v);
      }
      origin = scale * (own.center() - base);
    }
    origins.push_back(origin);
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();  // after scaling
    moved.linear() = old_poses[i].rotation();
    moved.translation() = scale * (old_poses[i].translation() - base) - origin;
    TransformShapes(Eigen::Affine3d(moved) * Eigen::Scaling(scale), &link);
    TransformInertial(moved, scale, &link);
  }
  for (size_t i = 0; i < model->joints.size(); ++i) {
    Joint& joint = model->joints[i];
    joint.axis = old_poses[i + 1].rotation() * joint.axis;
    for (double& along : joint.axis) along = std::abs(along) < kRounding ? 0.0 : along;
    joint.axis.normalize();
    joint.parent_from_joint = Eigen::Isometry3d(
        Eigen::Translation3d(origins[i + 1] - origins[static_cast<size_t>(parents[i])]));
    if (joint.type == JointType::kPrismatic) {
      joint.lower *= scale;
      joint.upper *= scale;
      joint.velocity *= scale;
    }
  }
}

}  // namespace simwright::importers
