#include "assets/usd_mesh.h"

#include <bit>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "assets/corner_normals.h"

namespace simwright::assets {
namespace {

// Returns "[a, b]" of the texts of `count` values.
template <typename TextOf>
std::string List(size_t count, const TextOf& text_of) {
  std::string text = "[";
  for (size_t i = 0; i < count; ++i) {
    if (i > 0) text += ", ";
    text += text_of(i);
  }
  return text + "]";
}

UsdPrim Mesh(const std::string& name, const core::TriangleMesh& mesh) {
  const Eigen::AlignedBox3d box = core::Bounds(mesh);
  UsdPrim prim("Mesh", name);
  prim.Set("float3[] extent", "[" + UsdFloats(box.min()) + ", " + UsdFloats(box.max()) + "]");
  prim.Set("int[] faceVertexCounts",
           List(mesh.triangles.size(), [](size_t) { return std::string("3"); }));
  prim.Set("int[] faceVertexIndices", List(mesh.triangles.size(), [&](size_t i) {
             const Eigen::Vector3i& t = mesh.triangles[i];
             return std::to_string(t[0]) + ", " + std::to_string(t[1]) + ", " +
                    std::to_string(t[2]);
           }));
  prim.Set("point3f[] points",
           List(mesh.vertices.size(), [&](size_t i) { return UsdFloats(mesh.vertices[i]); }));
  prim.Set("uniform token subdivisionScheme", "\"none\"");
  return prim;
}

void SetTextureCoordinates(const std::vector<Eigen::Vector2f>& corners, UsdPrim* prim) {
  std::unordered_map<std::uint64_t, size_t> known;
  std::vector<Eigen::Vector2f> values;
  std::vector<size_t> indices;
  indices.reserve(corners.size());
  for (const Eigen::Vector2f& corner : corners) {
    const std::uint64_t key = static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(corner.x()))
                                  << 32 |
                              std::bit_cast<std::uint32_t>(corner.y());
    const auto [at, is_new] = known.try_emplace(key, values.size());
    if (is_new) values.push_back(corner);
    indices.push_back(at->second);
  }
  const std::string list = List(values.size(), [&](size_t i) {
    return "(" + UsdFloat(values[i].x()) + ", " + UsdFloat(values[i].y()) + ")";
  });
  prim->Set("texCoord2f[] primvars:st",
            list + " (\n            interpolation = \"faceVarying\"\n        )");
  prim->Set("int[] primvars:st:indices",
            List(indices.size(), [&](size_t i) { return std::to_string(indices[i]); }));
}

// Returns the area vectors of the triangles (core::TriangleAreaVector).
std::vector<Eigen::Vector3d> AreaVectors(const core::TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> vectors;
  vectors.reserve(mesh.triangles.size());
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    vectors.push_back(core::TriangleAreaVector(mesh, static_cast<int>(i)));
  }
  return vectors;
}

// A unit vector, or the z axis for one of no length.
Eigen::Vector3d Unit(const Eigen::Vector3d& vector) {
  const double length = vector.norm();
  return length > 0.0 ? Eigen::Vector3d(vector / length) : Eigen::Vector3d::UnitZ();
}

void SetNormals(const std::vector<Eigen::Vector3d>& normals, const char* interpolation,
                UsdPrim* prim) {
  prim->Set("normal3f[] normals",
            List(normals.size(), [&](size_t i) { return UsdFloats(normals[i]); }) +
                " (\n            interpolation = \"" + interpolation + "\"\n        )");
}

void SetFlatNormals(const core::TriangleMesh& mesh, UsdPrim* prim) {
  std::vector<Eigen::Vector3d> normals = AreaVectors(mesh);
  for (Eigen::Vector3d& normal : normals) normal = Unit(normal);
  SetNormals(normals, "uniform", prim);
}

std::vector<std::vector<int>> FacesByMaterial(const core::TexturedMesh& visual) {
  std::vector<std::vector<int>> faces(visual.materials.size());
  for (size_t i = 0; i < visual.triangle_material.size(); ++i) {
    const auto material = static_cast<size_t>(visual.triangle_material[i]);
    if (material < faces.size()) faces[material].push_back(static_cast<int>(i));
  }
  return faces;
}

void Bind(const std::string& material, UsdPrim* prim) {
  prim->Apply("MaterialBindingAPI").Set("rel material:binding", "<" + material + ">");
}

}  // namespace

UsdPrim UsdVisualMesh(const std::string& name, const core::TexturedMesh& visual,
                      const std::vector<std::string>& materials) {
  UsdPrim prim = Mesh(name, visual.mesh);
  prim.Set("uniform bool doubleSided", "1");
  SetNormals(CornerNormals(visual.mesh), "faceVarying", &prim);
  if (!visual.corner_uvs.empty()) SetTextureCoordinates(visual.corner_uvs, &prim);
  if (materials.empty()) return prim;
  if (materials.size() == 1 || visual.triangle_material.empty()) {
    Bind(materials.front(), &prim);
    return prim;
  }
  // The family's type tells readers that the subsets share no face.
  prim.Apply("MaterialBindingAPI");
  prim.Set("uniform token subsetFamily:materialBind:familyType", "\"nonOverlapping\"");
  const std::vector<std::vector<int>> faces = FacesByMaterial(visual);
  for (size_t m = 0; m < faces.size(); ++m) {
    if (faces[m].empty()) continue;
    UsdPrim subset("GeomSubset", "material_" + std::to_string(m));
    subset.Set("uniform token elementType", "\"face\"")
        .Set("uniform token familyName", "\"materialBind\"")
        .Set("int[] indices",
             List(faces[m].size(), [&](size_t i) { return std::to_string(faces[m][i]); }));
    Bind(materials[m], &subset);
    prim.Add(std::move(subset));
  }
  return prim;
}

UsdPrim UsdCollisionMesh(const std::string& name, const core::TriangleMesh& part,
                         const std::string& material) {
  UsdPrim prim = Mesh(name, part);
  SetFlatNormals(part, &prim);
  prim.Apply("PhysicsCollisionAPI")
      .Apply("PhysicsMeshCollisionAPI")
      .Apply("MaterialBindingAPI")
      .Set("uniform token physics:approximation", "\"convexHull\"")
      .Set("uniform token purpose", "\"guide\"")
      .Set("rel material:binding:physics", "<" + material + ">");
  return prim;
}

UsdPrim UsdCollisionCapsule(const std::string& name, const Eigen::Vector3d& a,
                            const Eigen::Vector3d& b, double radius, const std::string& material) {
  const double length = (b - a).norm();
  const bool is_sphere = length < 1e-9;
  UsdPrim prim(is_sphere ? "Sphere" : "Capsule", name);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = 0.5 * (a + b);
  const Eigen::Vector3d half(radius, radius, radius + (is_sphere ? 0.0 : 0.5 * length));
  if (!is_sphere) {
    pose.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), b - a).matrix();
    prim.Set("uniform token axis", "\"Z\"").Set("double height", UsdDouble(length));
  }
  prim.Apply("PhysicsCollisionAPI")
      .Apply("MaterialBindingAPI")
      .Set("double radius", UsdDouble(radius))
      .Set("float3[] extent",
           "[" + UsdFloats(Eigen::Vector3d(-half)) + ", " + UsdFloats(half) + "]")
      .Set("uniform token purpose", "\"guide\"")
      .Set("rel material:binding:physics", "<" + material + ">")
      .Place(pose);
  return prim;
}

}  // namespace simwright::assets
