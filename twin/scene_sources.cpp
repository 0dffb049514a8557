#include "twin/scene_sources.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/image_channels.h"

namespace simwright::twin {
namespace fs = std::filesystem;
namespace {

constexpr int kPhotoSide = 512;                              // pixels, at most
constexpr double kShortestMesh = 0.04, kLongestMesh = 0.55;  // m
constexpr size_t kMostTriangles = 60000;

core::Image ReadRgb(const fs::path& path) {
  core::ImageReadOptions options;
  options.max_side = kPhotoSide;
  return core::InRgb(core::ReadImage(path, options));
}

bool IsPicture(const fs::path& path) {
  static const std::set<std::string> kEndings{".png", ".jpg", ".jpeg", ".webp", ".tif", ".tiff"};
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return kEndings.contains(ending);
}

}  // namespace

std::vector<core::Image> ReadScenePhotos(const std::vector<fs::path>& paths) {
  std::vector<core::Image> photos;
  for (const fs::path& path : paths) {
    if (!fs::exists(path)) {
      throw core::Error("no such file or folder of photos", path.string());
    }
    if (!fs::is_directory(path)) {
      photos.push_back(ReadRgb(path));
      continue;
    }
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
      if (entry.is_regular_file() && IsPicture(entry.path())) files.push_back(entry.path());
    }
    if (files.empty()) throw core::Error("the folder holds no picture", path.string());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) photos.push_back(ReadRgb(file));
  }
  return photos;
}

std::vector<core::TexturedMesh> TableMeshes(std::vector<core::TexturedMesh> meshes) {
  std::vector<core::TexturedMesh> kept;
  for (core::TexturedMesh& mesh : meshes) {
    const Eigen::AlignedBox3d box = core::Bounds(mesh.mesh);
    if (box.isEmpty() || mesh.mesh.triangles.size() > kMostTriangles) continue;
    const double longest = box.sizes().maxCoeff();
    if (longest < kShortestMesh || longest > kLongestMesh) continue;
    Eigen::Affine3d to_table = Eigen::Affine3d::Identity();
    to_table.translation() = -Eigen::Vector3d(box.center().x(), box.center().y(), box.min().z());
    core::Transform(to_table, &mesh.mesh);
    kept.push_back(std::move(mesh));
  }
  return kept;
}

}  // namespace simwright::twin
