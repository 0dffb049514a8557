#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "geometry/distance.h"
#include "scene/grammar/slot_size.h"
#include "sim/rigid_body.h"

namespace simwright::scene {

// The asset of a category in its forms for physics, projection, grammars and rendering; its base is
// at z = 0.
struct PaletteAsset {
  sim::RigidBody body;                       // for physics
  std::vector<geometry::ConvexShape> parts;  // the same parts, for projection
  SlotSize size;                             // for grammars
  core::TexturedMesh visual;                 // for rendering
};

// An asset set: the assets of scenes by category. Thread-safe once it is filled.
class Palette {
 public:
  // Adds an asset. Throws core::Error for a category that exists or a body without parts. Without a
  // `visual` the parts are rendered.
  void Add(const std::string& slot, sim::RigidBody body, core::TexturedMesh visual = {});

  // Replaces the collision parts by their convex hull: fewer contacts for a hollow asset, and no
  // object fits into it. Throws as At does.
  void TakeAsHull(const std::string& slot);

  // Returns the asset of a category. Throws core::Error, naming the category, if there is none.
  const PaletteAsset& At(const std::string& slot) const;
  bool Has(const std::string& slot) const { return assets_.count(slot) > 0; }

  // Returns a hash of the asset's physics: parts, inertial, friction. Throws as At does.
  std::string HashOf(const std::string& slot) const;

  // Returns the sizes for grammars: those of this set's assets, and those of `others` for the other
  // categories.
  SlotSizes Sizes(const SlotSizes& others = DefaultSlotSizes()) const;

 private:
  std::map<std::string, PaletteAsset> assets_;
};

}  // namespace simwright::scene
