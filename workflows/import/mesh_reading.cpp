#include "workflows/import/mesh_reading.h"

#include <algorithm>
#include <cstdio>

#include "asset_build/true_size.h"
#include "core/error.h"
#include "importers/file_scale.h"
#include "importers/hole_closing.h"
#include "importers/link_shapes.h"
#include "importers/loose_faces.h"
#include "importers/rigid_urdf.h"
#include "importers/surface_noise.h"
#include "importers/t_junctions.h"
#include "importers/torn_bottom.h"
#include "importers/up_axis.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

// Returns a URDF without moving joints as one mesh in the file's units.
core::TexturedMesh RigidUrdfMesh(const fs::path& urdf, const assets::UrdfModel& model,
                                 core::Findings* findings) {
  for (core::Finding finding : model.findings) {
    if (finding.code == "urdf-no-inertial") continue;  // it is recomputed
    if (finding.place == urdf.string()) finding.place = urdf.filename().string();
    findings->push_back(finding);
  }
  if (std::any_of(model.links.begin(), model.links.end(), importers::HasOwnCollisions)) {
    findings->push_back(
        {"urdf-collisions-left-out", core::Severity::kInfo, urdf.filename().string(),
         "its collision shapes are ignored: parts are computed from the visuals", 0.0});
  }
  findings->push_back({"urdf-rigid", core::Severity::kInfo, urdf.filename().string(),
                       "no joint moves: it becomes one rigid object", 0.0});
  return importers::RigidVisual(model, findings);
}

bool StatesSize(const ImportOptions& options) {
  return options.height > 0.0 || !options.size.empty();
}

void ScaleToHeight(double height, const std::string& where, core::TriangleMesh* mesh) {
  const double own = core::Bounds(*mesh).sizes().z();
  if (!(own > 0.0)) {
    throw core::Error("a flat mesh cannot be scaled to a height", where, "use --unit instead");
  }
  core::Transform(Eigen::Affine3d(Eigen::Scaling(height / own)), mesh);
}

// Scales the mesh to the stated size, or to a plausible one. A URDF is in metres by its
// specification, so that an implausible size is refused.
void ScaleToMeantSize(const fs::path& path, bool urdf, const physics_params::Category& category,
                      const ImportOptions& options, core::TriangleMesh* mesh,
                      core::Findings* findings) {
  const std::string file = path.filename().string();
  const importers::FileScale scale{options.source.empty() ? file : options.source, options.unit,
                                   options.seed};
  if (options.height > 0.0) ScaleToHeight(options.height, path.string(), mesh);
  asset_build::ScaleToSize(options.size, path.string(), mesh, findings);
  if (StatesSize(options)) return;
  if (options.sampled_size) {
    findings->push_back(importers::ScaleToCategory(category, scale, mesh));
  } else if (urdf && !options.unit_stated) {
    asset_build::RequirePlausibleSize(category, core::Bounds(*mesh).sizes(), options.unit,
                                      path.string(), asset_build::kAbsurdUrdf);
  } else if (!options.unit_stated) {
    importers::ScaleAbsurdMesh(category, scale, mesh, findings);
  }
}

// Refuses a size that cannot be simulated.
void RequireSimulable(const core::TriangleMesh& mesh, const fs::path& path) {
  const double longest = core::Bounds(mesh).sizes().maxCoeff();
  if (longest >= 1e-4 && longest <= 100.0) return;
  char text[120];
  std::snprintf(text, sizeof(text), "the mesh is %.3g m across", longest);
  throw core::Error(text, path.string(),
                    "0.1 mm to 100 m can be simulated: correct --unit, --height or --size");
}

}  // namespace

ItemMesh ReadInWorld(const fs::path& mesh_path, const assets::UrdfModel* urdf,
                     const physics_params::Category& category, const ImportOptions& options,
                     core::Findings* findings) {
  assets::MeshFile file;
  if (urdf != nullptr) {
    file.mesh = RigidUrdfMesh(mesh_path, *urdf, findings);
    file.up = 'z';
  } else {
    file = assets::ReadMeshFile(mesh_path);
  }
  findings->insert(findings->end(), file.findings.begin(), file.findings.end());
  ItemMesh item;
  if (options.report) item.as_read = file.mesh;
  item.visual = std::move(file.mesh);
  item.look = std::move(file.look);
  core::TriangleMesh& mesh = item.visual.mesh;
  const std::string place = mesh_path.filename().string();
  if (urdf == nullptr) {
    importers::JoinTJunctions(place, &item.visual, findings);  // so that pieces are closed
    importers::RemoveLooseFaces(place, &item.visual, findings);
  }
  char up = options.up != 0 ? options.up : file.up;
  if (up == 0) up = importers::GuessUpAxis(mesh_path, mesh, category, findings);
  Eigen::Affine3d world_from_file = Eigen::Affine3d::Identity();
  world_from_file.linear() = options.unit * assets::ZUpRotation(up);
  core::Transform(world_from_file, &mesh);
  core::Transform(world_from_file, &item.as_read.mesh);
  if (urdf == nullptr) {
    importers::RemoveTornBottom(place, &item.visual, findings);
    const std::size_t open = mesh.triangles.size();
    importers::CloseHoles(category, place, &item.visual, findings);
    if (mesh.triangles.size() != open) {
      importers::RemoveInnerShells(place, &item.visual, findings);
    }
  }
  ScaleToMeantSize(mesh_path, urdf != nullptr, category, options, &mesh, findings);
  RequireSimulable(mesh, mesh_path);
  if (urdf == nullptr) importers::WarnOfNoise(place, mesh, findings);
  return item;
}

}  // namespace simwright::workflows
