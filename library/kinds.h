#pragma once

#include <string>
#include <vector>

#include "assets/articulated_asset.h"
#include "library/assembly.h"

namespace simwright::library {

// Every generator: the same options give the same asset; the seed draws sizes, sides, handles,
// looks and how the joints feel.
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
  std::string what;  // one line: its links and joints
  assets::ArticulatedAsset (*make)(const Options&);
};

const std::vector<Kind>& Kinds();

// Throws core::Error, naming the kinds there are, for an unknown one.
const Kind& KindNamed(const std::string& name);

}  // namespace simwright::library
