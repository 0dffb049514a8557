#include "viewer/contents/asset_view.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>

#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "assets/mesh_import.h"
#include "assets/semantic_model.h"
#include "core/error.h"
#include "core/progress.h"
#include "geometry/mesh_validity.h"
#include "viewer/contents/drop_replay.h"
#include "viewer/grasp_file.h"
#include "viewer/model_document.h"

namespace simwright::viewer {
namespace fs = std::filesystem;
namespace {

using core::OrderedJson;

constexpr const char* kGraspFile = "grasps.json";
constexpr std::size_t kMostAssets = 300;  // of a folder

// One asset or several, of which rigid ones can be dropped.
class AssetContent : public Content {
 public:
  AssetContent(Document document, std::vector<std::optional<sim::RigidBody>> bodies)
      : Content(std::move(document)), bodies_(std::move(bodies)) {}

  Timeline Replay(int world) override {
    const auto& body = bodies_[static_cast<std::size_t>(world)];
    if (!body) return Content::Replay(world);
    return DropReplay({{body->name, &*body}});
  }

 private:
  std::vector<std::optional<sim::RigidBody>> bodies_;  // by world; none: cannot be dropped
};

void AddGrasps(const fs::path& folder, OrderedJson* model, DocumentBuilder* builder) {
  const fs::path file = folder / kGraspFile;
  if (!fs::exists(file)) return;
  try {
    (*model)["grasps"] = ReadGrasps(file);
  } catch (const core::Error& error) {
    AddFinding({"view-grasps-not-read", core::Severity::kWarning, "", error.what()}, builder);
  }
}

// Warns of a solid that is not closed: its mass, inertia and grasps mean nothing.
void ReportOpenSolid(const assets::Asset& asset, DocumentBuilder* builder) {
  const int open = geometry::Examine(asset.solid, 0).open_edges;
  if (open == 0) return;
  AddFinding({"view-solid-open", core::Severity::kWarning, asset.name,
              "its solid.obj is open: " + std::to_string(open) +
                  " edges have one face, so its mass, inertia and grasps cannot be relied on",
              static_cast<double>(open), "make the asset again"},
             builder);
}

OrderedJson RigidModel(const assets::Asset& asset, const fs::path& folder,
                       DocumentBuilder* builder) {
  OrderedJson model = ModelOf(asset, builder);
  ReportOpenSolid(asset, builder);
  AddGrasps(folder, &model, builder);
  return model;
}

bool IsRigidFolder(const fs::path& path) {
  return fs::is_directory(path) && assets::IsAssetFolder(path) &&
         !assets::IsArticulatedAssetFolder(path);
}

std::string NameOf(const fs::path& path) {
  const fs::path name = fs::absolute(path).lexically_normal();
  return name.has_filename() ? name.filename().string() : name.parent_path().filename().string();
}

// Adds one asset as a world. Returns its body where it can be dropped.
std::optional<sim::RigidBody> AddAssetWorld(const fs::path& path, DocumentBuilder* builder) {
  std::optional<sim::RigidBody> body;
  OrderedJson model;
  if (IsRigidFolder(path)) {
    const assets::Asset asset = assets::ReadAsset(path);
    model = RigidModel(asset, path, builder);
    body = sim::BodyFromAsset(asset);
  } else {
    model = ModelOfPath(path, builder);
  }
  const std::string name = model["name"].get<std::string>();
  OrderedJson world = {{"name", name}};
  world["bodies"] = BodiesJson({{name, builder->AddModel(std::move(model))}});
  if (body) world["replay"] = DropOffer();
  builder->AddWorld(std::move(world));
  return body;
}

}  // namespace

OrderedJson ModelOfPath(const fs::path& path, DocumentBuilder* builder) {
  if (IsRigidFolder(path)) return RigidModel(assets::ReadAsset(path), path, builder);
  if (fs::is_directory(path) && assets::IsArticulatedAssetFolder(path)) {
    OrderedJson model = ModelOf(assets::ReadArticulatedAsset(path), builder);
    AddGrasps(path, &model, builder);
    return model;
  }
  if (assets::HasMeshExtension(path)) {
    const assets::MeshFile file = assets::ReadMeshFile(path);
    for (const core::Finding& finding : file.findings) AddFinding(finding, builder);
    core::TexturedMesh mesh = file.mesh;
    if (file.up != 0) {
      core::Transform(Eigen::Affine3d(assets::ZUpRotation(file.up)), &mesh.mesh);
    }
    return ModelOf(mesh, path.filename().string(), builder);
  }
  const assets::SemanticModel model = assets::ReadSemanticModel(path);
  OrderedJson json = ModelOf(model.model, model.name, builder);
  const fs::path folder = fs::is_directory(path) ? path : path.parent_path();
  AddGrasps(folder, &json, builder);
  return json;
}

std::unique_ptr<Content> ReadAssetView(const fs::path& path) {
  DocumentBuilder builder("asset", NameOf(path));
  std::vector<std::optional<sim::RigidBody>> bodies;
  bodies.push_back(AddAssetWorld(path, &builder));
  return std::make_unique<AssetContent>(builder.Take(), std::move(bodies));
}

std::unique_ptr<Content> ReadAssetsView(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory() && assets::IsAssetFolder(entry.path())) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  DocumentBuilder builder("assets", NameOf(folder));
  if (paths.size() > kMostAssets) {
    AddFinding({"view-assets-left-out", core::Severity::kWarning, folder.string(),
                "only the first " + std::to_string(kMostAssets) + " of " +
                    std::to_string(paths.size()) + " assets are shown",
                static_cast<double>(paths.size() - kMostAssets),
                "view a single asset's folder for the others"},
               &builder);
    paths.resize(kMostAssets);
  }
  std::vector<std::optional<sim::RigidBody>> bodies;
  std::string fault;
  for (const fs::path& path : paths) {
    core::CheckCancelled();
    try {
      bodies.push_back(AddAssetWorld(path, &builder));
    } catch (const core::Error& error) {
      fault = error.what();
      AddFinding({"view-asset-not-read", core::Severity::kError, "", fault}, &builder);
    }
  }
  if (bodies.empty()) throw core::Error("no asset can be read: " + fault, folder.string());
  return std::make_unique<AssetContent>(builder.Take(), std::move(bodies));
}

}  // namespace simwright::viewer
