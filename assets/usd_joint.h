#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "assets/articulated_asset.h"
#include "assets/usd_prim.h"

namespace simwright::assets {

// Returns true if the joint follows one of its own kind, which NewtonMimicAPI expresses.
bool HasUsdMimic(const ArticulatedAsset& asset, const Joint& joint);

// The tree of an articulated asset's links as prims of UsdPhysics.
class UsdTree {
 public:
  // `asset` must outlive this; its links' prims are children of the prim of the path `root`. Throws
  // core::Error if a joint names a link that is missing or comes later than its child.
  UsdTree(const ArticulatedAsset& asset, std::string root);

  // The name of a link's prim, which USD allows.
  const std::string& LinkName(size_t link) const { return names_[link]; }
  // The pose of a link in the asset's frame, with all joints at zero.
  const Eigen::Isometry3d& RootFromLink(size_t link) const { return poses_[link]; }
  // Disables the contacts of a link with those of its excluded pairs.
  void FilterPairs(size_t link, UsdPrim* prim) const;
  // Returns the scope "joints".
  UsdPrim Joints() const;

 private:
  // Makes a joint follow its leader; `names`: of the joints' prims.
  void SetMimic(const Joint& joint, const std::vector<std::string>& names, UsdPrim* prim) const;
  size_t LinkNamed(const std::string& name, const std::string& joint) const;
  std::string LinkPath(size_t link) const { return root_ + "/" + names_[link]; }

  const ArticulatedAsset& asset_;
  std::string root_;
  std::vector<std::string> names_;        // by link
  std::vector<Eigen::Isometry3d> poses_;  // by link
};

}  // namespace simwright::assets
