#include "assets/usd_world.h"

#include <utility>

#include "assets/usd_material.h"
#include "assets/usd_prim.h"

namespace simwright::assets {
namespace {

// The side of the floor's picture, m; the plane that collides is infinite.
constexpr double kFloorSide = 20.0;
constexpr double kGravity = 9.81;  // m/s^2

UsdPrim Floor(const std::string& contact) {
  UsdPrim floor("Plane", kWorldGround);
  floor.Apply("PhysicsCollisionAPI").Apply("MaterialBindingAPI");
  floor.Set("uniform token axis", "\"Z\"")
      .Set("double width", UsdDouble(kFloorSide))
      .Set("double length", UsdDouble(kFloorSide))
      .Set("float3[] extent", "[" + UsdFloats(Eigen::Vector3d(-0.5, -0.5, 0.0) * kFloorSide) +
                                  ", " + UsdFloats(Eigen::Vector3d(0.5, 0.5, 0.0) * kFloorSide) +
                                  "]")
      .Set("color3f[] primvars:displayColor", "[(0.6, 0.6, 0.6)]")
      .Set("rel material:binding:physics", "<" + contact + ">");
  return floor;
}

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
  UsdPrim root("Xform", UsdNames().Unique(name));
  root.Meta("kind", "\"assembly\"").Meta("displayName", UsdString(name));
  UsdPrim physics("PhysicsScene", "physics");
  physics.Set("vector3f physics:gravityDirection", UsdFloats(Eigen::Vector3d(0.0, 0.0, -1.0)))
      .Set("float physics:gravityMagnitude", UsdFloat(kGravity));
  UsdPrim looks("Scope", "looks");
  looks.Add(UsdPhysicsMaterial("contact", {kWorldGroundFriction, 0.0, 0.0}));
  UsdNames names;
  for (const char* const own : {"physics", "looks", kWorldGround}) names.Unique(own);
  root.Add(std::move(physics));
  root.Add(std::move(looks));
  root.Add(Floor("/" + root.name() + "/looks/contact"));
  for (const WorldObject& object : objects) root.Add(Placed(object, names.Unique(object.name)));
  return UsdLayerText(root, "Simwright " SIMWRIGHT_VERSION ": " + name);
}

}  // namespace simwright::assets
