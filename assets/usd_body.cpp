#include "assets/usd_body.h"

#include "assets/principal_inertia.h"

namespace simwright::assets {

void SetUsdBody(const Inertial& inertial, UsdPrim* prim) {
  const PrincipalInertia principal = PrincipalInertiaOf(inertial.inertia);
  prim->Apply("PhysicsRigidBodyAPI")
      .Apply("PhysicsMassAPI")
      .Set("float physics:mass", UsdFloat(inertial.mass))
      .Set("point3f physics:centerOfMass", UsdFloats(inertial.center_of_mass))
      .Set("float3 physics:diagonalInertia", UsdFloats(principal.moments))
      .Set("quatf physics:principalAxes", UsdFloats(principal.link_from_axes));
}

void SetUsdFilteredPairs(const std::vector<std::string>& others, UsdPrim* body) {
  std::string paths;
  for (const std::string& other : others) paths += (paths.empty() ? "<" : ", <") + other + ">";
  if (paths.empty()) return;
  body->Apply("PhysicsFilteredPairsAPI").Set("rel physics:filteredPairs", "[" + paths + "]");
}

}  // namespace simwright::assets
