#pragma once

#include <string>
#include <tuple>
#include <vector>

#include "assets/pbr_look.h"
#include "assets/usd_prim.h"
#include "core/mesh.h"

namespace simwright::assets {

// Files of images, relative to the layer that names them.
struct UsdTextureFiles {
  std::vector<std::string> textures;  // by index into TexturedMesh::textures
  std::vector<std::string> maps;      // by index into PbrLook::images
};

// Returns a material of UsdPreviewSurface. Colours become linear; the texture is multiplied by the
// base colour. `parent` is the path of the prim that will hold it: "/mug/looks". `pbr`: null for a
// rough dielectric. Throws core::Error if a texture has no file.
UsdPrim UsdMaterial(const std::string& parent, const std::string& name,
                    const core::Material& material, const PbrMaterial* pbr,
                    const UsdTextureFiles& files);

// The behaviour of a surface in contacts (Asset).
struct UsdContact {
  double friction = 0.5, restitution = 0.0;
  double rolling_friction = 0.0;  // m

  bool operator<(const UsdContact& other) const {
    return std::tie(friction, restitution, rolling_friction) <
           std::tie(other.friction, other.restitution, other.rolling_friction);
  }
};

// Returns a material of UsdPhysics, with Newton's rolling friction.
UsdPrim UsdPhysicsMaterial(const std::string& name, const UsdContact& contact);

}  // namespace simwright::assets
