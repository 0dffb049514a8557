#include "library/articulated/articulated_kinds.h"

#include <algorithm>

#include "core/error.h"

namespace simwright::library {

const std::vector<Kind>& Kinds() {
  static const std::vector<Kind> kKinds = {
      {"microwave", "a door on a side hinge, dials or buttons", MakeMicrowave},
      {"oven", "a door that folds down, dials", MakeOven},
      {"refrigerator", "one or two doors on side hinges", MakeRefrigerator},
      {"dishwasher", "a door that folds down, buttons", MakeDishwasher},
      {"drawer_unit", "two to five drawers", MakeDrawerUnit},
      {"cabinet", "one or two doors on side hinges, fixed to a wall", MakeCabinet},
      {"box_with_lid", "a lid on a hinge behind", MakeBoxWithLid},
      {"door", "a leaf in its frame, levers or knobs that rotate, fixed", MakeDoor},
      {"faucet", "a lever or two knobs, a spout that may swivel, fixed", MakeFaucet},
      {"laptop", "a lid with a screen, a keyboard", MakeLaptop},
      {"toaster", "a lever that slides down, a dial", MakeToaster},
      {"light_switch", "one or two rockers or toggles, fixed to a wall", MakeLightSwitch},
      {"window", "a sash that slides or swings, fixed", MakeWindow},
      {"trash_can", "a lid on a hinge behind", MakeTrashCan},
  };
  return kKinds;
}

const Kind& KindNamed(const std::string& name) {
  const auto found = std::find_if(Kinds().begin(), Kinds().end(),
                                  [&](const Kind& kind) { return kind.name == name; });
  if (found != Kinds().end()) return *found;
  std::string known;
  for (const Kind& kind : Kinds()) known += (known.empty() ? "" : ", ") + kind.name;
  throw core::Error("the library has no such kind", name, "choose one of " + known);
}

}  // namespace simwright::library
