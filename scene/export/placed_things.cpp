#include "scene/export/placed_things.h"

#include "core/error.h"

namespace simwright::scene {

std::vector<assets::WorldThing> ThingsOf(const std::vector<DrawnObject>& objects,
                                         const ExportedAssets& assets) {
  std::map<std::string, int> counts;
  std::vector<assets::WorldThing> things;
  for (const DrawnObject& object : objects) {
    const auto found = assets.find(object.slot);
    if (found == assets.end()) {
      throw core::Error("this category of the scene has no asset", object.slot);
    }
    assets::WorldThing thing;
    // Unique among all categories, because the text after the last underscore is the number.
    thing.name = object.slot + "_" + std::to_string(counts[object.slot]++);
    thing.asset = &found->second;
    thing.world_from_thing = object.world_from_object;
    thing.welded = object.welded;
    things.push_back(std::move(thing));
  }
  return things;
}

}  // namespace simwright::scene
