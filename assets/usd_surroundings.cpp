#include "assets/usd_surroundings.h"

#include <utility>

#include "assets/usd_material.h"
#include "assets/world_writer.h"

namespace simwright::assets {
namespace {

// The side of the floor's picture, m; the plane that collides is infinite.
constexpr double kFloorSide = 20.0;
constexpr double kGravity = 9.81;  // m/s^2
constexpr char kPhysics[] = "physics";

UsdPrim Floor(const std::string& contact) {
  UsdPrim floor("Plane", "plane");
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

}  // namespace

UsdPrim UsdWorldRoot(const std::string& name) {
  UsdPrim root("Xform", UsdNames().Unique(name));
  root.Meta("kind", "\"assembly\"").Meta("displayName", UsdString(name));
  UsdPrim physics("PhysicsScene", kPhysics);
  physics.Set("vector3f physics:gravityDirection", UsdFloats(Eigen::Vector3d(0.0, 0.0, -1.0)))
      .Set("float physics:gravityMagnitude", UsdFloat(kGravity));
  // MuJoCo tips boxes over with one contact for each pair. The MJCF of scenes has the same.
  physics.Apply("MjcSceneAPI")
      .Set("uniform bool mjc:flag:multiccd", "1")
      .Set("uniform token mjc:option:cone", "\"elliptic\"")
      .Set("uniform double mjc:option:impratio", "10");
  root.Add(std::move(physics));
  UsdPrim ground("Xform", kWorldGround);
  ground.Add(UsdPhysicsMaterial("contact", {kWorldGroundFriction, 0.0, 0.0}));
  ground.Add(Floor("/" + root.name() + "/" + kWorldGround + "/contact"));
  root.Add(std::move(ground));
  return root;
}

UsdNames UsdWorldNames() {
  UsdNames names;
  for (const char* const own : {kPhysics, kWorldGround}) names.Unique(own);
  return names;
}

std::string UsdFloorPath(const UsdPrim& root) {
  return "/" + root.name() + "/" + kWorldGround + "/plane";
}

}  // namespace simwright::assets
