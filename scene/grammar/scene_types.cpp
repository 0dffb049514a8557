#include "scene/grammar/scene_types.h"

#include "core/error.h"
#include "scene/grammar/breakfast.h"
#include "scene/grammar/dimsum.h"
#include "scene/grammar/living_room_shelf.h"
#include "scene/grammar/pantry_shelf.h"
#include "scene/grammar/restaurant.h"

namespace simwright::scene {
namespace {

SceneType TypeOf(const std::string& what, Grammar (*make)(const SlotSizes&)) {
  const Grammar grammar = make(DefaultSlotSizes());
  return {grammar.name(), what, grammar.MostEntries(), make, grammar.Slots()};
}

}  // namespace

const std::vector<SceneType>& SceneTypes() {
  static const std::vector<SceneType> types = {
      TypeOf("a breakfast table for six, with much that is shared", &BreakfastTableHigh),
      TypeOf("a breakfast table for two, with a crock of utensils", &BreakfastTableLow),
      TypeOf("a round table with dim sum for four, steamers in stacks", &DimsumTable),
      TypeOf("a living room's shelf: games in stacks, drinks, a lamp, toys", &LivingRoomShelf),
      TypeOf("a pantry's shelf full of cans, bottles and fruit", &PantryShelf),
      TypeOf("a restaurant: tables with much dim sum, chairs, shelves", &RestaurantHigh),
      TypeOf("a restaurant: tables with little dim sum, chairs, shelves", &RestaurantLow),
  };
  return types;
}

const SceneType& SceneTypeNamed(const std::string& name) {
  std::string names;
  for (const SceneType& type : SceneTypes()) {
    if (type.name == name) return type;
    names += (names.empty() ? "" : ", ") + type.name;
  }
  throw core::Error("there is no scene type of this name", name, "use " + names);
}

}  // namespace simwright::scene
