#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "assets/asset.h"

namespace simwright::assets {

// A rigid asset that things of a world are made of.
struct WorldAsset {
  std::string key;     // names its meshes, unlike any other asset's of the world: "cup"
  std::string folder;  // of its files, as the world's file finds it: "../assets/cup/"
  Asset asset;
};

// One thing of a world.
struct WorldThing {
  std::string name;                   // unlike any other's, a name for files
  const WorldAsset* asset = nullptr;  // not null; things that are alike share it
  Eigen::Isometry3d world_from_thing = Eigen::Isometry3d::Identity();
  bool welded = false;  // part of the world, as furniture is
};

// The world as one file, over the floor z = 0, with the numbers of the assets' own files (17
// digits) and their options. `name` is the world's. Throws core::Error where two things share a
// name, two assets a key, or a name is none for files.
//
// MJCF: one mesh a file however many things share it; what is free has a free joint, what is welded
// has none; room for the contacts of all parts; steps of 1 ms, for at an asset's own 2 stacks
// creep.
std::string WorldMjcf(const std::string& name, const std::vector<WorldThing>& things);
// Who reads an SDF world: Drake warns of gravity, physics and light in it, without which Gazebo
// shows things in the dark.
enum class SdfReader { kAny, kGazebo };
// SDF 1.9: models in the world, poses with quaternions, so that none loses digits near the poles;
// what is welded is static; the ground is a box whose top is z = 0.
std::string WorldSdf(const std::string& name, const std::vector<WorldThing>& things,
                     SdfReader reader = SdfReader::kAny);
// The same ground as a model of its own.
std::string GroundSdf();

}  // namespace simwright::assets
