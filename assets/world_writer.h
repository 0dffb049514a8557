#pragma once

#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "assets/asset.h"

namespace simwright::assets {

// A rigid asset that objects of a world instantiate.
struct WorldAsset {
  std::string key;     // mesh name prefix, unique in the world: "cup"
  std::string folder;  // folder of its files relative to the world's file: "../assets/cup/"
  Asset asset;
};

// An object of a world.
struct WorldObject {
  std::string name;                   // unique, valid as a file name
  const WorldAsset* asset = nullptr;  // not null; equal objects share it
  Eigen::Isometry3d world_from_object = Eigen::Isometry3d::Identity();
  bool welded = false;  // part of the world, like furniture
};

// The floor's name and its friction, which is that of most floors. Drake combines two frictions as
// 2 a b / (a + b), Gazebo takes the smaller.
constexpr char kWorldGround[] = "ground";
constexpr double kWorldGroundFriction = 0.8;

// Returns the assets of the objects, each once, by key. Throws core::Error if two objects share a
// name, or have the floor's, two assets a key, or a name is not a valid file name.
std::map<std::string, const WorldAsset*> WorldAssetsOf(const std::vector<WorldObject>& objects);

// Returns the world as one file, over the floor z = 0, with the numbers of the assets' own files
// (17 digits) and their options. `name` is the world's. Throws core::Error if two objects share a
// name, two assets a key, or a name is not a valid file name.
//
// MJCF: one mesh per file for all objects that share it; free objects have a free joint, welded
// ones none; capacity for the contacts of all parts; steps of 1 ms, because stacks creep at an
// asset's own 2 ms.
std::string WorldMjcf(const std::string& name, const std::vector<WorldObject>& objects);
// The reader of an SDF world. Drake warns about gravity, physics and light in it; Gazebo needs them
// to light the objects.
enum class SdfReader { kAny, kGazebo };
// Returns the world as SDF 1.9: models in the world, poses as quaternions, which keep all digits
// near gimbal lock; welded objects are static; the ground is a box whose top is z = 0.
std::string WorldSdf(const std::string& name, const std::vector<WorldObject>& objects,
                     SdfReader reader = SdfReader::kAny);
// Returns the same ground as a separate model.
std::string GroundSdf();

}  // namespace simwright::assets
