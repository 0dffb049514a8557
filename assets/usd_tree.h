#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "assets/kinematic_model.h"
#include "assets/tree_world.h"
#include "assets/usd_prim.h"
#include "core/finding.h"

namespace simwright::assets {

// Returns true if the joint follows one of its own kind, which NewtonMimicAPI expresses.
bool HasUsdMimic(const std::vector<Joint>& joints, const Joint& joint);

// Returns what a layer of UsdPhysics does not express of a tree: floating and planar joints, joints
// that follow others, and the mass of bodies that have none. `fixed`: the root is fixed to the
// world.
core::Findings UsdTreeFindings(const KinematicModel& model, bool fixed);

// The start of a tree: the root's pose, the joints' positions, and the motors.
struct UsdTreeStart {
  std::vector<double> positions;  // rad or m, by joint; empty: zero
  Eigen::Isometry3d world_from_root = Eigen::Isometry3d::Identity();  // of a fixed root
  bool fixed = false;  // a joint holds the root to the world
  std::vector<TreeMotor> motors = {};
};

// A kinematic tree as prims of UsdPhysics. Its links are prims side by side, except for a link
// without mass on a fixed joint: it is no body of its own, but a part of the body that carries it.
class UsdTree {
 public:
  // `root` is the path of the prim whose children are the links and the scope "joints".
  UsdTree(std::shared_ptr<const KinematicModel> model, UsdTreeStart start, std::string root);

  // The name of a link's prim, which USD allows.
  const std::string& LinkName(size_t link) const { return names_[link]; }
  std::string LinkPath(size_t link) const { return root_ + "/" + names_[link]; }
  // Returns false for a link that another body carries.
  bool IsBody(size_t link) const { return carriers_[link] == link; }
  // Returns the prim of a link, placed in the root's frame, or in its carrier's. A body has its
  // inertial.
  UsdPrim Link(size_t link) const;
  // Returns the paths of the bodies whose contacts with a body are disabled; each pair once.
  std::vector<std::string> ExcludedPaths(size_t link) const;
  // Adds the prims of all links to the root's prim, those without a body to their carriers.
  void AddLinks(std::vector<UsdPrim> links, UsdPrim* root) const;
  // Returns the scope "joints".
  UsdPrim Joints() const;

 private:
  void SetMotion(size_t joint, UsdPrim* prim) const;
  // Makes a joint follow its leader; `names`: of the joints' prims.
  void SetMimic(const Joint& joint, const std::vector<std::string>& names, UsdPrim* prim) const;
  Eigen::Isometry3d CarrierFromLink(size_t link) const;

  std::shared_ptr<const KinematicModel> model_;
  UsdTreeStart start_;
  std::string root_;
  std::vector<std::string> names_;        // by link
  std::vector<size_t> carriers_;          // by link: the link whose body it is a part of
  std::vector<Eigen::Isometry3d> poses_;  // by link, in the root's frame
};

}  // namespace simwright::assets
