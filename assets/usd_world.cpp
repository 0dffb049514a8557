#include "assets/usd_world.h"

#include "assets/usd_prim.h"
#include "assets/usd_surroundings.h"

namespace simwright::assets {
namespace {

UsdPrim Placed(const WorldObject& object, const std::string& name) {
  UsdPrim prim("Xform", name);
  prim.Meta("prepend references", UsdAsset(UsdLayerOf(*object.asset)))
      .Meta("instanceable", "true")
      .Meta("displayName", UsdString(object.name))
      .Place(object.world_from_object);
  if (object.welded) prim.Meta("delete apiSchemas", R"(["PhysicsRigidBodyAPI", "PhysicsMassAPI"])");
  return prim;
}

}  // namespace

std::string UsdLayerOf(const WorldAsset& asset) {
  return asset.folder + asset.key + ".usda";
}

std::string WorldUsd(const std::string& name, const std::vector<WorldObject>& objects) {
  WorldAssetsOf(objects);  // checks the names
  UsdPrim root = UsdWorldRoot(name);
  UsdNames names = UsdWorldNames();
  for (const WorldObject& object : objects) root.Add(Placed(object, names.Unique(object.name)));
  return UsdLayerText(root, "Simwright " SIMWRIGHT_VERSION ": " + name);
}

}  // namespace simwright::assets
