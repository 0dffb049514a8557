#include "asset_build/true_size.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace simwright::asset_build {
namespace {

constexpr double kSmaller = 0.95;  // of the area of the axis-aligned rectangle

}  // namespace

void Validate(const StatedSize& size) {
  const bool positive = std::all_of(size.begin(), size.end(),
                                    [](double side) { return side > 0.0 && std::isfinite(side); });
  if ((size.empty() || size.size() == 1 || size.size() == 3) && positive) return;
  throw core::Error("a size is the longest side, or length,width,height, in m", "--size",
                    "--size 0.3 or --size 0.3,0.2,0.1");
}

GroundBox GroundBoxOf(const core::TriangleMesh& mesh) {
  const Eigen::AlignedBox3d box = core::Bounds(mesh);
  GroundBox best{0.0, box.sizes()};
  if (box.isEmpty()) return best;
  double least = kSmaller * best.sides.x() * best.sides.y();
  constexpr int kAngles = 90;
  for (int i = 1; i < kAngles; ++i) {
    const double angle = 0.5 * M_PI * i / kAngles;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
    Eigen::AlignedBox2d turned;
    for (const Eigen::Vector3d& vertex : mesh.vertices) {
      turned.extend(Eigen::Vector2d(along.dot(vertex.head<2>()), across.dot(vertex.head<2>())));
    }
    const Eigen::Vector2d sides = turned.sizes();
    if (sides.prod() >= least) continue;
    least = sides.prod();
    best = {angle, {sides.x(), sides.y(), box.sizes().z()}};
  }
  return best;
}

Eigen::Vector3d ScalesTo(const StatedSize& size, const Eigen::Vector3d& sides) {
  if (size.empty()) return Eigen::Vector3d::Ones();
  if (size.size() == 1) return Eigen::Vector3d::Constant(size[0] / sides.maxCoeff());
  const double longer = std::max(size[0], size[1]), shorter = std::min(size[0], size[1]);
  const bool along_x = sides.x() >= sides.y();
  return Eigen::Vector3d(along_x ? longer : shorter, along_x ? shorter : longer, size[2])
      .cwiseQuotient(sides);
}

void ScaleToSize(const StatedSize& size, const std::string& where, core::TriangleMesh* mesh,
                 core::Findings* findings) {
  if (size.empty()) return;
  const GroundBox box = GroundBoxOf(*mesh);
  const Eigen::Vector3d& sides = box.sides;
  const double least = size.size() == 1 ? sides.maxCoeff() : sides.minCoeff();
  if (!(least > 0.0)) {
    throw core::Error("a mesh without extent cannot be scaled to a size", where,
                      "use --unit instead");
  }
  const Eigen::Vector3d scales = ScalesTo(size, sides);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(box.angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  map.linear() = turn * scales.asDiagonal() * turn.transpose();
  core::Transform(map, mesh);
  const double stretch = scales.maxCoeff() / scales.minCoeff();
  constexpr double kNoticed = 1.05;
  if (stretch <= kNoticed) return;
  findings->push_back({"stretched", core::Severity::kWarning, where,
                       "the stated size has different proportions from the shape, which was "
                       "stretched by this factor: " +
                           std::to_string(stretch).substr(0, 4),
                       stretch, "--size with only the longest side keeps the proportions"});
}

double ScaleToSampledSize(const physics_params::PhysicalParameters& sampled,
                          const core::TriangleMesh& mesh, const std::string& where) {
  const double volume = GroundBoxOf(mesh).sides.prod();
  if (!(volume > 0.0)) {
    throw core::Error("the mesh is flat: it has no extent along a side", where,
                      "give its true size with --size");
  }
  const double wanted = sampled.length.sample * sampled.width.sample * sampled.height.sample;
  return std::cbrt(wanted / volume);
}

core::Finding SizeDrawn(const physics_params::Category& category, const Eigen::Vector3d& sides,
                        const std::string& where) {
  const bool unknown = category.name == "object";
  return {"size-drawn",
          unknown ? core::Severity::kWarning : core::Severity::kInfo,
          where,
          "its size was sampled from the usual range of '" + category.name +
              "': " + physics_params::SizeText(sides),
          sides.maxCoeff(),
          "give the true size with --height or --size"};
}

void RequirePlausibleSize(const physics_params::Category& category, const Eigen::Vector3d& sides,
                          double unit, const std::string& where, double most) {
  const double factor = physics_params::SizeFactor(category, sides);
  if (factor <= most && factor >= 1.0 / most) return;
  std::vector<std::string> fits = physics_params::UnitsThatFit(category, sides / unit);
  constexpr size_t kNamed = 2;
  if (fits.size() > kNamed) fits.resize(kNamed);
  std::string remedy;
  for (const std::string& one : fits) {
    remedy += (remedy.empty() ? "" : ", ") + ("--unit " + one) + " makes it " +
              physics_params::SizeText(sides / unit * physics_params::MetresOfUnit(one));
  }
  if (!fits.empty()) {
    remedy += "; or give --height or --size";
  } else {
    remedy = "give its true size with --height or --size, or its unit with --unit";
  }
  throw core::Error(physics_params::SizeSentence(category, sides), where, remedy);
}

}  // namespace simwright::asset_build
