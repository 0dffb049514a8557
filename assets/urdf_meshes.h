#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace simwright::assets {

// The folder that a URDF may read from: the ROS or Gazebo package it lies in (the nearest folder
// above, at most four up, that holds a package.xml or model.config); else the folder above one that
// is called as those which hold URDFs are (urdf, robots, model, xacro ...); else its own folder.
std::filesystem::path PackageRootOf(const std::filesystem::path& urdf);

// A ROS or Gazebo package: it holds a package.xml or model.config.
bool IsPackage(const std::filesystem::path& folder);
// Called as the folders are that hold a package's URDFs: urdf, robots, model ...
bool HoldsUrdfs(const std::filesystem::path& folder);

struct FoundMesh {
  std::filesystem::path file;
  std::string mended;  // how the name had to be read, for a person; empty where it was plain
};

// Finds the files that a URDF names, nowhere but inside `root`: links are followed, and what leads
// outside is refused.
class MeshFinder {
 public:
  MeshFinder(const std::filesystem::path& urdf, const std::filesystem::path& root);

  // A name may be relative to the URDF or to the root; "package://NAME/x" or "model://NAME/x",
  // where NAME is the root, a folder above the URDF or one in it, or unknown here; "file://x" or
  // absolute. Backslashes are slashes, %20 a blank, and letters' case is not heeded where no file
  // has the exact name. Of an absolute name that leads elsewhere ("/home/me/ws/pkg/meshes/x") the
  // longest end that exists inside the root is taken. "../meshes/x" is read from the folder of that
  // name beside the URDF's, also where that lies outside the root.
  // Nothing where no such file is there. Throws core::Error where the name leads outside.
  std::optional<FoundMesh> Find(const std::string& name) const;

 private:
  std::optional<std::filesystem::path> Look(const std::string& name) const;
  std::optional<std::filesystem::path> LookInPackage(const std::filesystem::path& name) const;
  std::optional<std::filesystem::path> LookForEnd(const std::filesystem::path& name) const;
  std::optional<std::filesystem::path> Existing(const std::filesystem::path& path) const;

  std::filesystem::path folder_, root_;
};

}  // namespace simwright::assets
