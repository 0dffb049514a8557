#include "scene/scene_types/scene_types.h"

#include "core/error.h"
#include "scene/scene_types/breakfast.h"
#include "scene/scene_types/dimsum.h"
#include "scene/scene_types/living_room_shelf.h"
#include "scene/scene_types/pantry_shelf.h"
#include "scene/scene_types/restaurant.h"

namespace simwright::scene {
namespace {

SceneType TypeOf(const std::string& what, const std::string& main_furniture,
                 Grammar (*make)(const CategorySizes&)) {
  const Grammar grammar = make(DefaultCategorySizes());
  return {grammar.name(), what, grammar.MaxEntries(), make, grammar.Categories(), main_furniture};
}

}  // namespace

const std::vector<SceneType>& SceneTypes() {
  static const std::vector<SceneType> types = {
      TypeOf("a breakfast table for six, with much that is shared", "table_breakfast",
             &BreakfastTableHigh),
      TypeOf("a breakfast table for two, with a crock of utensils", "table_breakfast",
             &BreakfastTableLow),
      TypeOf("a round table with dim sum for four, steamers in stacks", "table_round",
             &DimsumTable),
      TypeOf("a living room's shelf: games in stacks, drinks, a lamp, toys", "shelf_living_room",
             &LivingRoomShelf),
      TypeOf("a pantry's shelf full of cans, bottles and fruit", "shelf_pantry", &PantryShelf),
      TypeOf("a restaurant: tables with much dim sum, chairs, shelves", "floor", &RestaurantHigh),
      TypeOf("a restaurant: tables with little dim sum, chairs, shelves", "floor", &RestaurantLow),
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
