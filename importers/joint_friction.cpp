#include "importers/joint_friction.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "assets/joint_gravity_load.h"
#include "assets/kinematic_model.h"
#include "library/articulated/assembly.h"

namespace simwright::importers {
namespace {

using assets::ArticulatedAsset;
using assets::Joint;
using assets::JointType;

constexpr double kGravity = 9.81;     // m/s^2
constexpr double kWeightShare = 0.1;  // of the asset's weight: the largest required force
constexpr int kLoadSamples = 32;      // positions over a joint's range

double LowerOf(const Joint& joint) {
  return joint.type == JointType::kContinuous ? -std::numbers::pi : joint.lower;
}
double RangeOf(const Joint& joint) {
  return joint.type == JointType::kContinuous ? 2.0 * std::numbers::pi : joint.upper - joint.lower;
}

// Returns the distance from the axis of hinge `joint` to the farthest point it moves, m; 1 for a
// slide.
double LeverOf(const ArticulatedAsset& asset, const std::vector<Eigen::Isometry3d>& poses,
               const std::vector<int>& parents, size_t joint) {
  if (asset.joints[joint].type == JointType::kPrismatic) return 1.0;
  const Eigen::Isometry3d& pose = poses[joint + 1];
  const Eigen::Vector3d axis = pose.linear() * asset.joints[joint].axis;
  std::vector<bool> carried(asset.links.size(), false);
  double lever = 0.0;
  for (size_t i = joint; i < asset.joints.size(); ++i) {
    carried[i + 1] = i == joint || carried[static_cast<size_t>(parents[i])];
    if (!carried[i + 1]) continue;
    for (const core::TriangleMesh& part : asset.links[i + 1].parts) {
      for (const Eigen::Vector3d& v : part.vertices) {
        lever = std::max(lever, (poses[i + 1] * v - pose.translation()).cross(axis).norm());
      }
    }
  }
  return lever;
}

std::string Shown(double value, const char* unit) {
  char text[48];
  std::snprintf(text, sizeof(text), "%.3g %s", value, unit);
  return text;
}

// Collects what the file does not state of its joints.
class Omissions {
 public:
  // Notes the values that replaced those of `file` that are not positive.
  void Add(const Joint& file, const Joint& used) {
    const bool slides = used.type == JointType::kPrismatic;
    std::string values;
    const auto note = [&](double before, double now, const char* name, const char* unit) {
      if (before > 0.0) return;
      values += (values.empty() ? "" : ", ") + std::string(name) + " " + Shown(now, unit);
    };
    note(file.friction, used.friction, "friction", slides ? "N" : "N m");
    note(file.damping, used.damping, "damping", slides ? "N s/m" : "N m s/rad");
    note(file.effort, used.effort, "effort", slides ? "N" : "N m");
    note(file.velocity, used.velocity, "velocity", slides ? "m/s" : "rad/s");
    if (!values.empty() && ++guessed_ <= kNamed) {
      guesses_ += (guesses_.empty() ? "'" : "; '") + used.name + "': " + values;
    }
    if (file.friction > 0.0 && used.friction > file.friction && ++raised_ <= kNamed) {
      const char* const unit = slides ? "N" : "N m";
      raises_ += (raises_.empty() ? "'" : "; '") + used.name + "' from " +
                 Shown(file.friction, unit) + " to " + Shown(used.friction, unit);
    }
  }

  void Report(const std::string& asset, core::Findings* findings) const {
    if (guessed_ > 0) {
      findings->push_back({"joint-guessed", core::Severity::kWarning, asset,
                           "the file does not state all of its joints' dynamics and limits, which "
                           "were sampled or derived: " +
                               guesses_ + More(guessed_),
                           static_cast<double>(guessed_),
                           "give each joint <dynamics damping friction> and <limit effort "
                           "velocity>; asset.json has all values"});
    }
    if (raised_ > 0) {
      findings->push_back({"joint-friction-raised", core::Severity::kWarning, asset,
                           "friction was raised so that the joint holds against gravity: " +
                               raises_ + More(raised_),
                           static_cast<double>(raised_),
                           "state a friction of at least 1.3 times the joint's gravity load"});
    }
  }

 private:
  static constexpr int kNamed = 3;
  static std::string More(int count) {
    return count > kNamed ? "; and " + std::to_string(count - kNamed) + " more" : "";
  }

  int guessed_ = 0, raised_ = 0;
  std::string guesses_, raises_;
};

}  // namespace

double GreatestLoad(const ArticulatedAsset& asset, size_t joint) {
  const auto model = assets::MakeKinematicModel(asset);
  const Joint& j = asset.joints[joint];
  double load = 0.0;
  for (int k = 0; k <= kLoadSamples; ++k) {
    const double position = LowerOf(j) + RangeOf(j) * k / kLoadSamples;
    load =
        std::max(load, std::abs(assets::LoadOn(*model, static_cast<int>(joint), position).gravity));
  }
  return load;
}

void AssignJointFriction(core::Rng& rng, ArticulatedAsset* asset) {
  const auto model = assets::MakeKinematicModel(*asset);
  const std::vector<Eigen::Isometry3d> poses =
      model->LinkPoses(std::vector<double>(asset->joints.size(), 0.0));
  double mass = 0.0;
  for (const assets::ArticulatedLink& link : asset->links) mass += link.inertial.mass;
  Omissions omissions;
  for (size_t i = 0; i < asset->joints.size(); ++i) {
    Joint& joint = asset->joints[i];
    if (!joint.Moves()) continue;
    const Joint stated = joint;
    const double lever = LeverOf(*asset, poses, model->parents(), i);
    library::JointResistance feel = library::SampleJointResistance(rng, lever);
    const double most = kWeightShare * mass * kGravity * lever;
    if (!asset->fixed && feel.friction > most) {
      feel.damping *= most / feel.friction;
      feel.friction = most;
    }
    const double load = GreatestLoad(*asset, i);
    if (!(joint.damping > 0.0)) joint.damping = feel.damping;
    if (!(joint.friction > 0.0)) joint.friction = feel.friction;
    joint.friction = std::max(joint.friction, kHoldFactor * load);
    if (!(joint.effort > 0.0)) joint.effort = 4.0 * (joint.friction + load);
    if (!(joint.velocity > 0.0)) joint.velocity = 5.0 * RangeOf(joint);
    omissions.Add(stated, joint);
  }
  omissions.Report(asset->name, &asset->findings);
}

}  // namespace simwright::importers
