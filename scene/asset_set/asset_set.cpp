#include "scene/asset_set/asset_set.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/content_hash.h"
#include "core/error.h"
#include "geometry/convex_hull.h"

namespace simwright::scene {
namespace {

// Returns the height at which the vertical line through the origin meets the triangle; -1 if it
// does not.
double HeightAtOrigin(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      const Eigen::Vector3d& c) {
  const auto cross = [](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    return p.x() * q.y() - p.y() * q.x();
  };
  const Eigen::Vector3d weights(cross(b, c), cross(c, a), cross(a, b));
  const double area = weights.sum();
  if (std::abs(area) < 1e-14) return -1.0;  // m^2: a vertical triangle
  const Eigen::Vector3d share = weights / area;
  if (share.minCoeff() < -1e-9) return -1.0;
  return share.dot(Eigen::Vector3d(a.z(), b.z(), c.z()));
}

// Returns the height of an object placed in or on the middle of the body.
double RestHeight(const sim::RigidBody& body) {
  double height = 0.0;
  for (const core::TriangleMesh& part : body.parts) {
    for (const Eigen::Vector3i& triangle : part.triangles) {
      height = std::max(height, HeightAtOrigin(part.vertices[static_cast<size_t>(triangle[0])],
                                               part.vertices[static_cast<size_t>(triangle[1])],
                                               part.vertices[static_cast<size_t>(triangle[2])]));
    }
  }
  return height;
}

CategorySize SizeOfBody(const sim::RigidBody& body) {
  Eigen::AlignedBox3d box;
  for (const core::TriangleMesh& part : body.parts) {
    for (const Eigen::Vector3d& vertex : part.vertices) box.extend(vertex);
  }
  // The size is measured around the origin, at which grammars place the asset.
  const Eigen::Vector3d farthest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs());
  return BoxSize(farthest.x(), farthest.y(), box.max().z(), RestHeight(body));
}

}  // namespace

void AssetSet::Add(const std::string& category, sim::RigidBody body, core::TexturedMesh visual,
                   std::filesystem::path folder) {
  if (Has(category)) throw core::Error("a category has two assets", category);
  if (body.parts.empty()) throw core::Error("an asset needs collision parts", category);
  SceneAsset asset;
  asset.size = SizeOfBody(body);
  for (const core::TriangleMesh& part : body.parts) asset.parts.push_back({part.vertices, 0.0});
  if (visual.mesh.triangles.empty()) {
    for (const core::TriangleMesh& part : body.parts) core::Append(part, &visual.mesh);
  }
  asset.visual = std::move(visual);
  asset.folder = std::move(folder);
  asset.body = std::move(body);
  assets_.emplace(category, std::move(asset));
}

void AssetSet::UseConvexHullCollision(const std::string& category) {
  At(category);  // throws for an unknown category
  SceneAsset& asset = assets_.at(category);
  std::vector<Eigen::Vector3d> vertices;
  for (const core::TriangleMesh& part : asset.body.parts) {
    vertices.insert(vertices.end(), part.vertices.begin(), part.vertices.end());
  }
  asset.body.parts = {geometry::ConvexHull(vertices)};
  asset.body.capsules.clear();
  asset.parts = {{asset.body.parts[0].vertices, 0.0}};
  asset.size = SizeOfBody(asset.body);
  asset.folder.clear();
}

const SceneAsset& AssetSet::At(const std::string& category) const {
  const auto found = assets_.find(category);
  if (found == assets_.end()) {
    throw core::Error("this category of the scene has no asset", category,
                      "add one to the asset set");
  }
  return found->second;
}

std::string AssetSet::HashOf(const std::string& category) const {
  const SceneAsset& asset = At(category);
  std::string bytes;
  const auto add = [&](const double* numbers, Eigen::Index count) {
    bytes.append(reinterpret_cast<const char*>(numbers),
                 static_cast<size_t>(count) * sizeof(double));
  };
  for (const core::TriangleMesh& part : asset.body.parts) {
    for (const Eigen::Vector3d& vertex : part.vertices) add(vertex.data(), 3);
    bytes += '|';
  }
  const assets::Inertial& inertial = asset.body.inertial;
  for (const double number :
       {inertial.mass, asset.body.friction, asset.body.restitution, asset.body.rolling_friction}) {
    add(&number, 1);
  }
  add(inertial.center_of_mass.data(), 3);
  add(inertial.inertia.data(), 9);
  return core::ContentHash(bytes);
}

CategorySizes AssetSet::Sizes(const CategorySizes& others) const {
  CategorySizes sizes = others;
  for (const auto& [category, asset] : assets_) sizes[category] = asset.size;
  return sizes;
}

}  // namespace simwright::scene
