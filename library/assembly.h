#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "assets/articulated_asset.h"
#include "core/random.h"
#include "library/handles.h"
#include "library/matter.h"

namespace simwright::library {

// What a generator is given. The same options give the same asset.
struct Options {
  std::uint64_t seed = 1;
  std::string name;  // of the asset; empty: the kind's name
};

// How a joint feels to a hand.
struct Feel {
  double friction = 0.0;  // N m or N
  double damping = 0.0;   // N m s/rad or N s/m
};

// A thing that a hand works at `lever` (m) from a hinge, or straight (lever 1): it takes 1.5 to
// 8 N, and as much again by damping at 1 to 4 m/s or rad/s. Operable parts are to work with at
// most 22.2 N (ADA Standards for Accessible Design, 2010, 309.4).
Feel DrawFeel(core::Rng& rng, double lever = 1.0);

struct JointPlan {
  assets::UrdfJointType type = assets::UrdfJointType::kFixed;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // in the root's frame, on the axis
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double lower = 0.0, upper = 0.0;  // rad or m
  Feel feel;
};

// Puts an articulated asset together from convex pieces, all given in the root's frame with every
// joint at zero. Pieces of one link may touch but not overlap: then volumes and masses add.
class Assembly {
 public:
  // `category` of the knowledge base gives sizes, mass and contact; see parameters().
  Assembly(const std::string& kind, const std::string& category, const Options& options);
  // What the knowledge base has no row for brings its own.
  Assembly(const std::string& kind, const physics_params::PhysicalParameters& parameters,
           const Options& options);

  core::Rng& rng() { return rng_; }
  // Sampled from the category; a generator may narrow the sizes.
  physics_params::PhysicalParameters& parameters() { return asset_.parameters; }
  double Draw(double low, double high) { return core::Uniform(rng_, low, high); }
  bool Chance(double probability) { return core::Uniform(rng_) < probability; }
  // What was drawn, for asset.json.
  void Note(const std::string& feature, const std::string& value);
  void HoldFixed() { asset_.fixed = true; }

  // The root, then children; return the link's index. A link on a fixed joint has its frame at
  // the plan's origin.
  int AddRoot(const std::string& name, const std::string& label);
  int AddLink(const std::string& name, const std::string& label, int parent, const JointPlan& plan);
  // Seen, collides and weighs.
  void Add(int link, const Matter& matter, const core::TriangleMesh& piece);
  void Add(int link, const Matter& matter, const std::vector<core::TriangleMesh>& pieces);
  // Seen alone: print, keys, burners.
  void Paint(int link, const Matter& matter, const core::TriangleMesh& piece);
  // A handle as a link of its own, fixed to `parent`, with its frame at the grip.
  int AddHandle(const std::string& name, int parent, HandleKind kind, const HandlePlace& place,
                const Matter& matter);

  // Densities of `fitted` materials (empty: none) are scaled, within the material's range, so that
  // the whole weighs what was sampled; friction of each joint is raised to hold 1.3 times the
  // greatest weight on it, as the hinges of lids and oven doors do. A mass outside the category's
  // range is reported as a finding.
  assets::ArticulatedAsset Finish(const std::string& fitted = "");

 private:
  struct Piece {
    Matter matter;
    core::TriangleMesh mesh;  // root frame
    bool solid = true;
  };
  void FitDensity(const std::string& material);
  void FillLink(size_t index);
  void HoldJoints();

  assets::ArticulatedAsset asset_;
  core::Rng rng_;
  std::vector<std::vector<Piece>> pieces_;  // by link
  std::vector<Eigen::Vector3d> origins_;    // of links, root frame
};

}  // namespace simwright::library
