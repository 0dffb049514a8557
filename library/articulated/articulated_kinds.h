#pragma once

#include <string>
#include <vector>

#include "assets/articulated_asset.h"
#include "library/articulated/generator_options.h"

namespace simwright::library {

// The generators. The same options give the same asset; the seed determines sizes, sides, handles,
// looks, and joint friction and damping.
assets::ArticulatedAsset MakeMicrowave(const Options& options);
assets::ArticulatedAsset MakeOven(const Options& options);
assets::ArticulatedAsset MakeRefrigerator(const Options& options);
assets::ArticulatedAsset MakeDishwasher(const Options& options);
assets::ArticulatedAsset MakeDrawerUnit(const Options& options);
assets::ArticulatedAsset MakeCabinet(const Options& options);
assets::ArticulatedAsset MakeBoxWithLid(const Options& options);
assets::ArticulatedAsset MakeDoor(const Options& options);
assets::ArticulatedAsset MakeFaucet(const Options& options);
assets::ArticulatedAsset MakeLaptop(const Options& options);
assets::ArticulatedAsset MakeToaster(const Options& options);
assets::ArticulatedAsset MakeLightSwitch(const Options& options);
assets::ArticulatedAsset MakeWindow(const Options& options);
assets::ArticulatedAsset MakeTrashCan(const Options& options);

struct Kind {
  std::string name;  // "microwave"
  std::string what;  // one line that names its links and joints
  assets::ArticulatedAsset (*make)(const Options&);
};

const std::vector<Kind>& Kinds();

// Returns the kind of that name. Throws core::Error, listing the known kinds, for an unknown one.
const Kind& KindNamed(const std::string& name);

}  // namespace simwright::library
