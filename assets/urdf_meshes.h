#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace simwright::assets {

// Returns the folder that a URDF may read from: its ROS or Gazebo package (the nearest folder
// above, at most four levels up, that holds a package.xml or model.config); otherwise the parent of
// a folder with a usual name for URDFs (urdf, robots, model, xacro ...); otherwise its own folder.
std::filesystem::path PackageRootOf(const std::filesystem::path& urdf);

// Returns true for a ROS or Gazebo package: a folder with a package.xml or model.config.
bool IsPackage(const std::filesystem::path& folder);
// Returns true if the folder has a usual name for a package's URDFs: urdf, robots, model ...
bool HasUrdfFolderName(const std::filesystem::path& folder);

struct FoundMesh {
  std::filesystem::path file;
  std::string
      resolution_note;  // how the name was resolved, for the user; empty if found as written
};

// Finds the files that a URDF names, only inside `root`: links are followed, and a path that leads
// outside is an error.
class MeshFinder {
 public:
  MeshFinder(const std::filesystem::path& urdf, const std::filesystem::path& root);

  // Finds a file by name. A name may be relative to the URDF or to the root; "package://NAME/x" or
  // "model://NAME/x", where NAME is the root, a folder above the URDF or one in it, or unknown;
  // "file://x" or absolute. Backslashes are slashes, %20 is a space, and the match is
  // case-insensitive if no file has the exact name. For an absolute name elsewhere
  // ("/home/me/ws/pkg/meshes/x") the longest suffix that exists inside the root is used.
  // "../meshes/x" is resolved in the folder of that name beside the URDF's, even if that lies
  // outside the root. Returns nothing if there is no such file. Throws core::Error if the name
  // leads outside.
  std::optional<FoundMesh> Find(const std::string& name) const;

 private:
  std::optional<std::filesystem::path> Look(const std::string& name) const;
  std::optional<std::filesystem::path> LookInPackage(const std::filesystem::path& name) const;
  std::optional<std::filesystem::path> LookForEnd(const std::filesystem::path& name) const;
  std::optional<std::filesystem::path> Existing(const std::filesystem::path& path) const;

  std::filesystem::path folder_, root_;
};

}  // namespace simwright::assets
