#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "assets/articulated_asset.h"
#include "core/random.h"
#include "library/articulated/generator_options.h"
#include "library/articulated/handles.h"
#include "library/articulated/piece_material.h"
#include "library/draws.h"

namespace simwright::library {

// The friction and damping of a joint.
struct JointResistance {
  double friction = 0.0;  // N m or N
  double damping = 0.0;   // N m s/rad or N s/m
};

// Samples the resistance of a part that a hand operates at `lever` (m) from a hinge, or linearly
// (lever 1): friction of 1.5 to 8 N, and as much again by damping at 1 to 4 m/s or rad/s. Operable
// parts must require at most 22.2 N (ADA Standards for Accessible Design, 2010, 309.4).
JointResistance SampleJointResistance(core::Rng& rng, double lever = 1.0);
inline JointResistance SampleJointResistance(Draws& draws, double lever = 1.0) {
  return SampleJointResistance(draws.unseen(), lever);
}

struct JointPlan {
  assets::JointType type = assets::JointType::kFixed;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // in the root's frame, on the axis
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double lower = 0.0, upper = 0.0;  // rad or m
  JointResistance joint_resistance;
};

// Assembles an articulated asset from convex pieces, all given in the root's frame with every joint
// at zero. Pieces of one link may touch but must not overlap, so that volumes and masses add.
class Assembly {
 public:
  // Constructs an assembly whose sizes, mass and contact come from `category` of the knowledge
  // base; see parameters().
  Assembly(const std::string& kind, const std::string& category, const Options& options);
  // Constructs an assembly with its own parameters, for kinds without a row in the knowledge base.
  Assembly(const std::string& kind, const physics_params::PhysicalParameters& parameters,
           const Options& options);

  Draws& draws() { return draws_; }
  // Returns the parameters sampled from the category; a generator may narrow the sizes.
  physics_params::PhysicalParameters& parameters() { return asset_.parameters; }
  double Draw(double low, double high) { return Uniform(draws_, low, high); }
  bool Bernoulli(double probability) { return Uniform(draws_) < probability; }
  // Records a sampled feature for asset.json.
  void RecordFeature(const std::string& feature, const std::string& value);
  void FixToWorld() { asset_.fixed = true; }

  // Add the root, then its children, and return the link's index. A link on a fixed joint has its
  // frame at the plan's origin.
  int AddRoot(const std::string& name, const std::string& label);
  int AddLink(const std::string& name, const std::string& label, int parent, const JointPlan& plan);
  // Adds a piece with visual, collision and mass.
  void Add(int link, const Matter& matter, const core::TriangleMesh& piece);
  void Add(int link, const Matter& matter, const std::vector<core::TriangleMesh>& pieces);
  // Adds a visual-only piece: print, keys, burners.
  void Paint(int link, const Matter& matter, const core::TriangleMesh& piece);
  // Adds a handle as a separate link, fixed to `parent`, with its frame at the grip.
  int AddHandle(const std::string& name, int parent, HandleKind kind, const HandlePlacement& place,
                const Matter& matter);

  // Returns the finished asset. Densities of pieces of the material `fitted` (empty: none) are
  // scaled, within the material's range, so that the total mass is the sampled one. The friction of
  // each joint is raised to support 1.3 times its maximum gravity load, as in the hinges of lids
  // and oven doors. A mass outside the category's range is reported as a finding.
  assets::ArticulatedAsset Finish(const std::string& fitted = "");

 private:
  struct Piece {
    Matter matter;
    core::TriangleMesh mesh;  // root frame
    bool solid = true;
  };
  void FitDensity(const std::string& material);
  void FillLink(size_t index);
  void FillAppearance(size_t index);  // its visual alone
  void SetJointFriction();

  assets::ArticulatedAsset asset_;
  Options options_;
  Draws draws_;
  std::vector<std::vector<Piece>> pieces_;  // per link
  std::vector<Eigen::Vector3d> origins_;    // per link, root frame
};

}  // namespace simwright::library
