#pragma once

#include <string>

#include <Eigen/Geometry>

#include "assets/asset.h"

namespace tinyxml2 {
class XMLPrinter;
}

namespace simwright::assets {

// The names of a rigid asset's meshes in an MJCF file, and their folder.
struct MjcfNames {
  std::string prefix;  // prefix of meshes, texture and material: "cup" of "cup_visual"
  std::string folder;  // prepended to file names: "" or "../assets/cup/"
};

// Writes the children of <asset>: visual and collision meshes, and the texture if MuJoCo supports
// it.
void MjcfMeshes(tinyxml2::XMLPrinter* printer, const Asset& asset, const MjcfNames& names);

// An instance of the asset.
struct MjcfInstance {
  std::string body;                         // its name
  const Eigen::Isometry3d* pose = nullptr;  // world_from_body; null: not written
  bool free = true;                         // has a free joint; otherwise it is part of the world
};

// Writes <body> on principal axes: visuals in group 2, collision geoms in group 3.
void MjcfBody(tinyxml2::XMLPrinter* printer, const Asset& asset, const MjcfNames& names,
              const MjcfInstance& place);

}  // namespace simwright::assets
