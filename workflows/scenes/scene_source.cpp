#include "workflows/scenes/scene_source.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <map>
#include <set>

#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "scene/dataset/scene_dataset.h"
#include "workflows/scenes/dataset_scenes.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMaxPoseFile = 64ull << 20;  // bytes
constexpr double kUnitLength = 1e-3;                 // deviation of a quaternion's length from 1
constexpr double kFarthest = 1e4;  // m from the origin: beyond, single precision loses millimetres

std::string SourceSceneName(int scene) {
  char name[32];
  std::snprintf(name, sizeof name, "scene_%05d", scene);
  return name;
}

SceneSource FromDataset(const fs::path& path, const std::string& scenes, const fs::path& assets) {
  const scene::SceneDataset dataset(path);
  if (dataset.SceneCount() == 0) throw core::Error("the dataset has no scenes", path.string());
  const std::vector<int> indices =
      ParseSceneIndices(scenes.empty() ? "0" : scenes, dataset.SceneCount());
  std::vector<std::vector<scene::SceneObject>> objects;
  std::set<std::string> categories;
  for (const int index : indices) {
    objects.push_back(SceneAt(dataset, index));
    for (const scene::SceneObject& object : objects.back()) categories.insert(object.category);
  }
  const scene::CategoryFolders folders = FoldersOfCategories(path, assets, categories);
  SceneSource source;
  source.type = dataset.vocabulary().type;
  if (!folders.empty()) source.assets = folders.begin()->second.parent_path();
  for (size_t i = 0; i < indices.size(); ++i) {
    SourceScene scene{SourceSceneName(indices[i]), {}};
    std::map<std::string, int> counts;
    for (const scene::SceneObject& object : objects[i]) {
      scene.objects.push_back({object.category + "_" + std::to_string(counts[object.category]++),
                               object.category, folders.at(object.category),
                               object.world_from_object, object.welded});
    }
    source.scenes.push_back(std::move(scene));
  }
  return source;
}

// Returns true for a name that files can have: results are written under the names of objects.
bool IsFileName(const std::string& name) {
  return name != "." && name != ".." && std::none_of(name.begin(), name.end(), [](char c) {
           return c == '/' || c == '\\' || std::iscntrl(static_cast<unsigned char>(c));
         });
}

// A file of poses: an export's scene.json, or one written by hand.
class PoseFile {
 public:
  PoseFile(const fs::path& file, const fs::path& assets)
      : document_(core::JsonDocument::Read(file, kMaxPoseFile)),
        exported_(file.filename() == "scene.json"),
        folder_(fs::absolute(file).lexically_normal().parent_path()),
        assets_(assets) {}

  SceneSource Read() const {
    const core::JsonField root = document_.root();
    SceneSource source;
    SourceScene scene{folder_.filename().string(), {}};
    if (!root.json().is_array()) {
      source.type = root.TextOr("type", "");
      scene.name = root.TextOr("name", scene.name);
      if (!IsFileName(scene.name)) root["name"].FailAs("a name without slashes");
    }
    const core::JsonField list = root.json().is_array() ? root : root["objects"];
    std::set<std::string> names;
    std::map<std::string, int> counts;
    for (const core::JsonField& field : list.Elements()) {
      SourceObject object = ReadObject(field);
      if (object.name.empty()) {
        const std::string base = object.asset.filename().string();
        object.name = base + "_" + std::to_string(counts[base]++);
      }
      if (!names.insert(object.name).second) {
        field.Fail("another object has the name " + object.name);
      }
      scene.objects.push_back(std::move(object));
    }
    if (scene.objects.empty()) throw core::Error("the scene has no objects", document_.file());
    source.assets = exported_ ? folder_.parent_path() / "assets" : folder_ / "assets";
    source.scenes.push_back(std::move(scene));
    return source;
  }

 private:
  SourceObject ReadObject(const core::JsonField& field) const {
    SourceObject object;
    object.name = field.TextOr("name", "");
    if (!IsFileName(object.name)) field["name"].FailAs("a name without slashes");
    object.slot = field.TextOr("slot", "");
    object.asset = AssetOf(field);
    object.world_from_object.translation() = field["translation"].Vector<3>();
    if (object.world_from_object.translation().norm() > kFarthest) {
      field["translation"].FailAs("a position within 10 km of the origin");
    }
    if (field.Has("quaternion_wxyz")) {
      const Eigen::Vector4d q = field["quaternion_wxyz"].Vector<4>();
      if (std::abs(q.norm() - 1.0) > kUnitLength) {
        field["quaternion_wxyz"].FailAs("a quaternion of length 1");
      }
      object.world_from_object.linear() =
          Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    }
    if (field.Has("welded")) object.welded = field["welded"].Flag();
    return object;
  }

  // Returns the asset folder that an object names: below the file's folder, or below that of the
  // whole export for its scene.json, or in the assets that the caller gives.
  fs::path AssetOf(const core::JsonField& field) const {
    const bool by_urdf = !field.Has("asset") && field.Has("urdf");
    const fs::path given = (by_urdf ? field["urdf"] : field["asset"]).Text();
    const fs::path named = by_urdf ? given.parent_path() : given;
    if (named.is_absolute()) field.Fail("the asset " + named.string() + " is an absolute path");
    if (!assets_.empty()) {
      const fs::path here = core::ResolveInside(assets_, named.filename());
      if (assets::IsAssetFolder(here)) return here;
    }
    const fs::path root = exported_ ? folder_.parent_path() : folder_;
    const fs::path below = (folder_ / named).lexically_normal().lexically_relative(root);
    const fs::path folder = core::ResolveInside(root, below);
    if (!assets::IsAssetFolder(folder)) {
      field.Fail("there is no asset folder " + named.string(),
                 "name one below the file's folder, or give --assets FOLDER that holds it");
    }
    return folder;
  }

  core::JsonDocument document_;
  bool exported_;
  fs::path folder_, assets_;
};

}  // namespace

SceneSource ReadSceneSource(const fs::path& path, const std::string& scenes,
                            const fs::path& assets) {
  if (!fs::exists(path)) {
    throw core::Error("there is no such scene", path.string(),
                      "name a dataset, a folder of `scene export`, or a JSON file of poses");
  }
  const bool folder = fs::is_directory(path);
  const fs::path file = folder ? path / "scene.json" : path;
  const bool poses = folder ? fs::exists(file) : file.extension() == ".json";
  if (!poses) return FromDataset(path, scenes, assets);
  if (!scenes.empty()) {
    throw core::Error("this is a single scene", path.string(), "leave --scene out");
  }
  return PoseFile(file, assets).Read();
}

void RefuseOutputOver(const fs::path& path, const fs::path& output) {
  const fs::path from = fs::weakly_canonical(path), to = fs::weakly_canonical(output);
  const auto [above, below] = std::mismatch(to.begin(), to.end(), from.begin(), from.end());
  if (above != to.end()) return;
  throw core::Error("the output would replace its own input", output.string(),
                    "choose another folder");
}

}  // namespace simwright::workflows
