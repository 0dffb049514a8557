// The truth that the browser's test compares the page with: forward kinematics by KinematicModel,
// and silhouettes by render/.
//   viewer_reference microwave DIR
//   viewer_reference box DIR
//   viewer_reference poses PATH [JOINT=POSITION]...
//   viewer_reference silhouette PATH WIDTH HEIGHT MASK.pgm [JOINT=POSITION]...
// `poses` prints the pose of each link in the root's frame, 12 numbers row by row; `silhouette`
// prints its camera and writes the mask, 255 where an object covers at least half of the pixel.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "assets/kinematic_model.h"
#include "assets/link_visuals.h"
#include "assets/mesh_import.h"
#include "assets/urdf_reader.h"
#include "core/camera.h"
#include "core/files.h"
#include "core/json.h"
#include "library/articulated/articulated_kinds.h"
#include "render/forward.h"
#include "render/scene.h"
#include "tests/assets/sample_asset.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

constexpr double kFov = 0.6;  // rad, vertical

// The links of an asset with their meshes.
struct Posed {
  std::vector<std::string> links;
  std::vector<Eigen::Isometry3d> poses;  // root from link
  std::vector<std::pair<int, core::TexturedMesh>> meshes;
};

using Positions = std::map<std::string, double>;

std::vector<double> InOrder(const assets::KinematicModel& model, const Positions& positions) {
  std::vector<double> list;
  for (const assets::Joint& joint : model.joints()) {
    const auto found = positions.find(joint.name);
    list.push_back(found == positions.end() ? 0.0 : found->second);
  }
  return list;
}

void Pose(const assets::KinematicModel& model, const Positions& positions, Posed* posed) {
  for (const assets::KinematicLink& link : model.links()) posed->links.push_back(link.name);
  posed->poses = model.LinkPoses(InOrder(model, positions));
}

Posed Read(const fs::path& path, const Positions& positions) {
  Posed posed;
  if (assets::HasMeshExtension(path)) {
    posed.links = {path.filename().string()};
    posed.poses = {Eigen::Isometry3d::Identity()};
    posed.meshes.emplace_back(0, assets::ReadMesh(path));
  } else if (fs::is_directory(path)) {
    const assets::ArticulatedAsset asset = assets::ReadArticulatedAsset(path);
    Pose(*assets::MakeKinematicModel(asset), positions, &posed);
    for (std::size_t i = 0; i < asset.links.size(); ++i) {
      posed.meshes.emplace_back(static_cast<int>(i), asset.links[i].visual);
    }
  } else {
    const assets::UrdfModel model = assets::ReadUrdf(path);
    Pose(*assets::MakeKinematicModel(model), positions, &posed);
    for (const assets::LinkVisual& visual : assets::LinkVisuals(model)) {
      posed.meshes.emplace_back(visual.link, assets::ReadVisual(visual, Eigen::Vector4f::Ones()));
    }
  }
  return posed;
}

core::Json Numbers(const Eigen::Isometry3d& pose) {
  core::Json numbers = core::Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) numbers.push_back(pose.matrix()(row, column));
  }
  return numbers;
}

void PrintPoses(const Posed& posed) {
  core::Json poses = core::Json::object();
  for (std::size_t i = 0; i < posed.links.size(); ++i) {
    poses[posed.links[i]] = Numbers(posed.poses[i]);
  }
  std::puts(core::JsonLine(poses).c_str());
}

void WriteSilhouette(const Posed& posed, int width, int height, const fs::path& file) {
  render::Scene scene;
  Eigen::AlignedBox3d box;
  for (const auto& [link, mesh] : posed.meshes) {
    const Eigen::Isometry3d& pose = posed.poses[static_cast<std::size_t>(link)];
    if (mesh.mesh.empty()) continue;
    scene.Add(&mesh, pose);
    for (const Eigen::Vector3d& vertex : mesh.mesh.vertices) box.extend(pose * vertex);
  }
  scene.Commit();
  const double distance = 0.62 * box.diagonal().norm() / std::sin(0.5 * kFov);
  const core::Camera camera =
      core::OrbitCamera(box.center(), distance, 0.4, -2.3, kFov, width, height);
  render::ForwardOptions options;
  options.samples_per_side = 3;
  const render::ForwardBuffers buffers = render::RenderForward(scene, camera, options);
  std::string pgm = "P5\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
  for (const float covered : buffers.mask) pgm += covered >= 0.5f ? '\xff' : '\0';
  core::WriteFile(file, pgm);
  std::puts(core::JsonLine(core::Json{{"height", height},
                                      {"fy", camera.fy},
                                      {"world_from_camera", Numbers(camera.world_from_camera)}})
                .c_str());
}

int Main(const std::vector<std::string>& arguments) {
  if (arguments.size() < 2) return 2;
  const fs::path path = arguments[1];
  if (arguments[0] == "microwave") {
    fs::create_directories(path);
    library::Options options;
    options.seed = 3;
    assets::ArticulatedAsset asset = library::MakeMicrowave(options);
    asset.name = path.filename().string();
    assets::WriteArticulatedAsset(asset, path);
    return 0;
  }
  if (arguments[0] == "box") {
    fs::create_directories(path);
    assets::Asset asset = assets::SampleAsset();
    asset.name = path.filename().string();
    assets::WriteAsset(asset, path);
    return 0;
  }
  const bool silhouette = arguments[0] == "silhouette";
  Positions positions;
  for (std::size_t i = silhouette ? 5 : 2; i < arguments.size(); ++i) {
    const std::size_t at = arguments[i].find('=');
    positions[arguments[i].substr(0, at)] = std::stod(arguments[i].substr(at + 1));
  }
  const Posed posed = Read(path, positions);
  if (silhouette) {
    WriteSilhouette(posed, std::stoi(arguments[2]), std::stoi(arguments[3]), arguments[4]);
  } else {
    PrintPoses(posed);
  }
  return 0;
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  return simwright::Main({argv + 1, argv + argc});
}
