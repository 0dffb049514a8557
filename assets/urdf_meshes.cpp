#include "assets/urdf_meshes.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <set>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/files.h"

namespace simwright::assets {
namespace fs = std::filesystem;
namespace {

constexpr int kMostLevels = 4;  // levels of the package's root above its URDF

std::string LowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// Returns true for the usual names of mesh folders beside a URDF's.
bool HoldsMeshes(const std::string& name) {
  static const std::set<std::string> kNames{
      "mesh", "meshes", "dae",       "obj",    "objs",  "stl",           "stls",     "glb",
      "gltf", "visual", "collision", "assets", "parts", "textured_objs", "geometry", "media"};
  return kNames.contains(LowerCase(name));
}

std::string UnescapedUri(const std::string& text) {
  std::string plain;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '%' && i + 2 < text.size() &&
                        std::isxdigit(static_cast<unsigned char>(text[i + 1])) &&
                        std::isxdigit(static_cast<unsigned char>(text[i + 2]));
    const int code = escape ? std::stoi(text.substr(i + 1, 2), nullptr, 16) : 0;
    if (code == 0) {
      plain += text[i];
    } else {
      plain += static_cast<char>(code);
      i += 2;
    }
  }
  return plain;
}

std::string Slashed(std::string text) {
  std::replace(text.begin(), text.end(), '\\', '/');
  return text;
}

// Returns true for a drive letter: "C:/x" is as foreign as "/home/other/x".
bool HasDrive(const std::string& name) {
  return name.size() > 2 && std::isalpha(static_cast<unsigned char>(name[0])) && name[1] == ':' &&
         name[2] == '/';
}

// Returns the file at `relative` below `root`, case-insensitively; empty if none or several match.
fs::path FindIgnoringCase(const fs::path& root, const fs::path& relative) {
  fs::path at = root;
  for (const fs::path& part : relative) {
    if (fs::exists(at / part)) {
      at /= part;
      continue;
    }
    std::vector<fs::path> same;
    std::error_code failed;
    for (const auto& entry : fs::directory_iterator(at, failed)) {
      if (LowerCase(entry.path().filename().string()) == LowerCase(part.string())) {
        same.push_back(entry.path());
      }
    }
    if (same.size() != 1) return {};
    at = same.front();
  }
  return at;
}

}  // namespace

bool IsPackage(const fs::path& folder) {
  return fs::is_regular_file(folder / "package.xml") ||
         fs::is_regular_file(folder / "model.config");
}

bool HasUrdfFolderName(const fs::path& folder) {
  static const std::set<std::string> kNames{"urdf",   "urdfs", "robot",       "robots", "model",
                                            "models", "xacro", "description", "sdf",    "xml"};
  return kNames.contains(LowerCase(folder.filename().string()));
}

fs::path PackageRootOf(const fs::path& urdf) {
  const fs::path folder = fs::weakly_canonical(fs::absolute(urdf)).parent_path();
  fs::path place = folder;
  for (int level = 0; level < kMostLevels && place.has_relative_path(); ++level) {
    if (IsPackage(place)) return place;
    place = place.parent_path();
  }
  place = folder;
  for (int level = 0; level + 1 < kMostLevels && place.has_relative_path(); ++level) {
    if (HasUrdfFolderName(place)) {
      while (HasUrdfFolderName(place.parent_path())) place = place.parent_path();
      return place.parent_path();
    }
    place = place.parent_path();
  }
  return folder;
}

MeshFinder::MeshFinder(const fs::path& urdf, const fs::path& root)
    : folder_(fs::weakly_canonical(fs::absolute(urdf)).parent_path()),
      root_(fs::weakly_canonical(fs::absolute(root))) {}

// Returns a regular file inside the root, case-insensitively. Throws for a path that leaves the
// root instead of skipping it.
std::optional<fs::path> MeshFinder::Existing(const fs::path& path) const {
  const fs::path candidate = core::ResolveInside(root_, path);
  if (fs::is_regular_file(candidate)) return candidate;
  const fs::path relative = candidate.lexically_relative(root_);
  const fs::path found = FindIgnoringCase(root_, relative);
  if (found.empty()) return std::nullopt;
  const fs::path inside = core::ResolveInside(root_, found);
  return fs::is_regular_file(inside) ? std::optional(inside) : std::nullopt;
}

std::optional<fs::path> MeshFinder::LookInPackage(const fs::path& name) const {
  const fs::path package = *name.begin();
  const fs::path rest = name.lexically_relative(package);
  std::vector<fs::path> places;
  for (fs::path place = folder_;; place = place.parent_path()) {
    if (place.filename() == package) places.insert(places.begin(), place / rest);
    places.push_back(place / package / rest);
    places.push_back(place / rest);
    if (place == root_ || !place.has_relative_path()) break;
  }
  for (const fs::path& place : places) {
    if (const auto found = Existing(place.lexically_normal())) return found;
  }
  return std::nullopt;
}

std::optional<fs::path> MeshFinder::LookForEnd(const fs::path& name) const {
  const std::vector<fs::path> parts(name.begin(), name.end());
  for (size_t first = 1; first < parts.size(); ++first) {
    fs::path end;
    for (size_t i = first; i < parts.size(); ++i) end /= parts[i];
    if (end.empty() || *end.begin() == "..") continue;
    for (const fs::path& place : {folder_, root_}) {
      const fs::path candidate = (place / end).lexically_normal();
      if (!fs::is_regular_file(candidate)) continue;
      try {
        return core::ResolveInside(root_, candidate);
      } catch (const core::Error&) {
        continue;  // a link that leads outside
      }
    }
  }
  return std::nullopt;
}

std::optional<fs::path> MeshFinder::Look(const std::string& name) const {
  for (const char* scheme : {"package://", "model://"}) {
    if (!name.starts_with(scheme)) continue;
    const std::string rest = name.substr(std::string_view(scheme).size());
    return rest.empty() ? std::nullopt : LookInPackage(rest);
  }
  if (name.find("://") != std::string::npos && !name.starts_with("file://")) return std::nullopt;
  const fs::path path = name.starts_with("file://") ? name.substr(7) : name;
  if (path.empty()) return std::nullopt;
  const bool elsewhere = path.is_absolute() || HasDrive(path.string());
  if (elsewhere) {
    if (!HasDrive(path.string()) && fs::exists(path)) {
      try {
        return Existing(path);
      } catch (const core::Error&) {
        if (const auto end = LookForEnd(path)) return end;
        throw;
      }
    }
    return LookForEnd(path);
  }
  const fs::path normal = path.lexically_normal();
  const std::vector<fs::path> parts(normal.begin(), normal.end());
  if (parts.size() > 2 && parts[0] == ".." && parts[1] != ".." && HoldsMeshes(parts[1].string()) &&
      fs::is_directory(folder_.parent_path() / parts[1])) {
    const MeshFinder beside(folder_ / "x", folder_.parent_path() / parts[1]);
    if (!fs::is_symlink(folder_.parent_path() / parts[1])) {
      return beside.Existing((folder_ / path).lexically_normal());
    }
  }
  if (const auto found = Existing((folder_ / path).lexically_normal())) return found;
  if (*normal.begin() == "..") return std::nullopt;
  return Existing((root_ / path).lexically_normal());
}

std::optional<FoundMesh> MeshFinder::Find(const std::string& name) const {
  std::optional<fs::path> found = Look(name);
  const std::string slashed = Slashed(name);
  if (!found && slashed != name) found = Look(slashed);
  if (!found && UnescapedUri(slashed) != slashed) found = Look(UnescapedUri(slashed));
  if (!found) return std::nullopt;
  FoundMesh mesh{*found, ""};
  const std::string wanted = fs::path(UnescapedUri(slashed)).filename().string();
  const bool absolute =
      slashed.starts_with("file:///") || slashed.starts_with("/") || HasDrive(slashed);
  const std::string path = slashed.starts_with("file://") ? slashed.substr(7) : slashed;
  if (absolute && !(fs::exists(path) && fs::equivalent(path, *found))) {
    mesh.resolution_note = "'" + name + "' is not in this folder: '" +
                           found->lexically_relative(root_).string() + "' is used instead";
  } else if (wanted != found->filename() && name.find("://") == std::string::npos &&
             LowerCase(wanted) == LowerCase(found->filename().string())) {
    mesh.resolution_note = "'" + name + "' was found as '" + found->filename().string() + "'";
  }
  return mesh;
}

}  // namespace simwright::assets
