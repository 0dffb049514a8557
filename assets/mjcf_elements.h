#pragma once

#include <string>

#include <Eigen/Geometry>

#include "assets/asset.h"

namespace tinyxml2 {
class XMLPrinter;
}

namespace simwright::assets {

// How a rigid asset's meshes are called in an MJCF file, and where they lie.
struct MjcfNames {
  std::string prefix;  // of meshes, texture and material: "cup" of "cup_visual"
  std::string folder;  // before each file's name: "" or "../assets/cup/"
};

// The children of <asset>: visual and collision meshes, and the texture where there is one that
// MuJoCo takes.
void MjcfMeshes(tinyxml2::XMLPrinter* printer, const Asset& asset, const MjcfNames& names);

// One of the things that share these meshes.
struct MjcfPlace {
  std::string body;                         // its name
  const Eigen::Isometry3d* pose = nullptr;  // world_from_body; null: none is written
  bool free = true;                         // has a free joint; else it is part of the world
};

// <body> on principal axes: what is seen in group 2, what touches in group 3.
void MjcfBody(tinyxml2::XMLPrinter* printer, const Asset& asset, const MjcfNames& names,
              const MjcfPlace& place);

}  // namespace simwright::assets
