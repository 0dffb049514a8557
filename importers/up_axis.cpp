#include "importers/up_axis.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "assets/mesh_import.h"
#include "geometry/stable_poses.h"
#include "physics_params/size_plausibility.h"

namespace simwright::importers {
namespace fs = std::filesystem;
namespace {

std::string EndingOf(const fs::path& mesh) {
  std::string ending = mesh.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

// Returns the centre of the surface, which an open mesh has too.
Eigen::Vector3d CenterOfSurface(const core::TriangleMesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area = 0.0;
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[static_cast<size_t>(triangle[0])];
    const Eigen::Vector3d& b = mesh.vertices[static_cast<size_t>(triangle[1])];
    const Eigen::Vector3d& c = mesh.vertices[static_cast<size_t>(triangle[2])];
    const double twice = (b - a).cross(c - a).norm();
    sum += twice * (a + b + c) / 3.0;
    area += twice;
  }
  return area > 0.0 ? Eigen::Vector3d(sum / area) : core::Bounds(mesh).center();
}

bool Stands(const core::TriangleMesh& mesh, const Eigen::Vector3d& center, char up) {
  const Eigen::Vector3d down = -assets::ZUpRotation(up).transpose() * Eigen::Vector3d::UnitZ();
  const double slack = 2e-3 * core::Bounds(mesh).diagonal().norm();
  constexpr double kLeast = 3.0 * M_PI / 180.0;
  return geometry::TippingAngle(mesh, center, down, slack) >= kLeast;
}

Eigen::Vector3d SidesWith(const core::TriangleMesh& mesh, char up) {
  return (assets::ZUpRotation(up) * core::Bounds(mesh).sizes()).cwiseAbs();
}

struct Suit {
  double misfit = 0.0;
  bool stands = false;
  // Falling over costs as much as proportions that are wrong by a third.
  double cost() const { return misfit + (stands ? 0.0 : 0.3); }
};

}  // namespace

char UsualUpAxis(const fs::path& mesh) {
  const std::string ending = EndingOf(mesh);
  return ending == ".stl" || ending == ".ply" ? 'z' : 'y';
}

bool LeavesUpOpen(const fs::path& mesh) {
  const std::string ending = EndingOf(mesh);
  return ending == ".obj" || ending == ".stl" || ending == ".ply";
}

char GuessUpAxis(const fs::path& path, const core::TriangleMesh& mesh,
                 const physics_params::Category& category, core::Findings* findings) {
  const char usual = UsualUpAxis(path), other = usual == 'y' ? 'z' : 'y';
  const Eigen::AlignedBox3d box = core::Bounds(mesh);
  if (!LeavesUpOpen(path) || box.isEmpty() || !(box.sizes().minCoeff() > 0.0)) return usual;
  const Eigen::Vector3d center = CenterOfSurface(mesh);
  const auto suit = [&](char up) {
    // The catch-all category has no proportions.
    const double misfit = category.name == "object"
                              ? 0.0
                              : physics_params::ProportionMisfit(category, SidesWith(mesh, up));
    return Suit{misfit, Stands(mesh, center, up)};
  };
  const Suit as_usual = suit(usual), turned = suit(other);
  constexpr double kClearly = 0.25;
  const bool turn = turned.cost() + kClearly < as_usual.cost();
  const char up = turn ? other : usual;
  const bool by_shape = std::abs(as_usual.misfit - turned.misfit) > kClearly;
  std::string reason = turn ? (by_shape ? "which matches the proportions of '" + category.name + "'"
                                        : std::string("in which it is stable"))
                            : std::string("the usual one of its format");
  findings->push_back(
      {"up-axis", turn ? core::Severity::kWarning : core::Severity::kInfo, path.filename().string(),
       std::string("the file does not specify the up axis: ") + up + " was used, " + reason, 0.0,
       std::string("--up ") + (up == 'y' ? "z" : "y") + " uses the other"});
  return up;
}

}  // namespace simwright::importers
