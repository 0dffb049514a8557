#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "geometry/distance.h"
#include "scene/grammar/slot_size.h"
#include "sim/rigid_body.h"

namespace simwright::scene {

// What stands in a scene for a slot: z = 0 is where it stands.
struct PaletteAsset {
  sim::RigidBody body;                       // as physics takes it
  std::vector<geometry::ConvexShape> parts;  // the same parts, as projection takes them
  SlotSize size;                             // as grammars take it
  core::TexturedMesh visual;                 // as it is seen
};

// The assets of scenes by the name of their slot. Constant once it is filled; shared by threads.
class Palette {
 public:
  // Throws core::Error for a slot that is taken or a body without parts. Without a `visual` its
  // parts are what is seen.
  void Add(const std::string& slot, sim::RigidBody body, core::TexturedMesh visual = {});

  // Has it collide as the convex hull of its parts: fewer contacts where it is hollow, and nothing
  // goes into it. Throws as At does.
  void TakeAsHull(const std::string& slot);

  // Throws core::Error, naming the slot, where nothing stands for it.
  const PaletteAsset& At(const std::string& slot) const;
  bool Has(const std::string& slot) const { return assets_.count(slot) > 0; }

  // Over what physics takes of the asset: parts, inertial, friction. Throws as At does.
  std::string HashOf(const std::string& slot) const;

  // For grammars: the sizes of what is here, those of `others` for the rest.
  SlotSizes Sizes(const SlotSizes& others = DefaultSlotSizes()) const;

 private:
  std::map<std::string, PaletteAsset> assets_;
};

}  // namespace simwright::scene
