#include "assets/usd_tree_world.h"

#include <array>
#include <utility>

#include "assets/usd_body.h"
#include "assets/usd_material.h"
#include "assets/usd_mesh.h"
#include "assets/usd_prim.h"
#include "assets/usd_surroundings.h"
#include "assets/usd_tree.h"
#include "core/error.h"

namespace simwright::assets {
namespace {

class TreeUsd {
 public:
  TreeUsd(const std::string& name, const std::map<std::string, const core::TriangleMesh*>& meshes)
      : meshes_(meshes), root_(UsdWorldRoot(name)), names_(UsdWorldNames()) {
    names_.Unique("looks");
  }

  void Add(const TreeBody& body) {
    const std::string name = names_.Unique(body.name);
    UsdPrim prim("Xform", name);
    prim.Meta("kind", "\"component\"").Meta("displayName", UsdString(body.name));
    prim.Place(body.world_from_root);
    const bool is_tree = body.links.size() > 1;
    if (is_tree) prim.Apply("PhysicsArticulationRootAPI");
    const UsdTree tree(body.kinematics,
                       {body.positions, body.world_from_root, body.fixed && is_tree, body.motors},
                       "/" + root_.name() + "/" + name);
    std::vector<UsdPrim> links;
    for (size_t i = 0; i < body.links.size(); ++i) {
      UsdPrim link = tree.Link(i);
      if (!is_tree && body.fixed) {
        link = UsdPrim("Xform", tree.LinkName(i));  // static
      } else if (tree.IsBody(i)) {
        SetUsdFilteredPairs(FilteredPaths(body, tree, i), &link);
      }
      AddShapes(body.links[i], &link);
      links.push_back(std::move(link));
    }
    tree.AddLinks(std::move(links), &prim);
    if (is_tree) prim.Add(tree.Joints());
    root_.Add(std::move(prim));
  }

  std::string Finish(const std::string& name) {
    root_.Add(std::move(looks_));
    return UsdLayerText(root_, "Simwright " SIMWRIGHT_VERSION ": " + name);
  }

 private:
  // The bodies after this one in its tree, and the floor where the link does not meet it.
  std::vector<std::string> FilteredPaths(const TreeBody& body, const UsdTree& tree,
                                         size_t link) const {
    std::vector<std::string> paths;
    for (size_t i = link + 1; i < body.links.size(); ++i) {
      if (tree.IsBody(i)) paths.push_back(tree.LinkPath(i));
    }
    if (!body.links[link].meets_floor) paths.push_back(UsdFloorPath(root_));
    return paths;
  }

  const core::TriangleMesh& MeshOf(const TreeShape& shape) const {
    const auto found = meshes_.find(shape.file);
    if (found == meshes_.end()) throw core::Error("the shape's mesh is missing", shape.name);
    return *found->second;
  }

  void AddShapes(const TreeLink& link, UsdPrim* prim) {
    UsdNames shapes;
    for (const TreeShape& shape : link.visuals) {
      core::TexturedMesh visual;
      visual.mesh = MeshOf(shape);
      if (visual.mesh.empty()) continue;
      visual.triangle_material.assign(visual.mesh.triangles.size(), 0);
      prim->Add(UsdVisualMesh(shapes.Unique(shape.name), visual, {LookOf(shape.color)}));
    }
    const std::string contact = ContactOf({link.friction, link.restitution, 0.0});
    for (const TreeShape& shape : link.collisions) {
      const std::string name = shapes.Unique(shape.name);
      if (shape.capsule) {
        prim->Add(UsdCollisionCapsule(name, shape.capsule->a, shape.capsule->b,
                                      shape.capsule->radius, contact));
      } else if (!MeshOf(shape).empty()) {
        prim->Add(UsdCollisionMesh(name, MeshOf(shape), contact));
      }
    }
  }

  std::string LooksPath() const { return "/" + root_.name() + "/looks"; }

  std::string LookOf(const Eigen::Vector4f& color) {
    const auto [at, is_new] = colors_.try_emplace({color.x(), color.y(), color.z(), color.w()}, "");
    if (is_new) {
      const std::string name = look_names_.Unique("color");
      core::Material material;
      material.base_color = color;
      looks_.Add(UsdMaterial(LooksPath(), name, material, nullptr, {}));
      at->second = LooksPath() + "/" + name;
    }
    return at->second;
  }

  std::string ContactOf(const UsdContact& contact) {
    const auto [at, is_new] = contacts_.try_emplace(contact, "");
    if (is_new) {
      const std::string name = look_names_.Unique("contact");
      looks_.Add(UsdPhysicsMaterial(name, contact));
      at->second = LooksPath() + "/" + name;
    }
    return at->second;
  }

  const std::map<std::string, const core::TriangleMesh*>& meshes_;
  UsdPrim root_, looks_{"Scope", "looks"};
  UsdNames names_, look_names_;
  std::map<std::array<float, 4>, std::string> colors_;  // paths
  std::map<UsdContact, std::string> contacts_;          // paths
};

}  // namespace

std::string TreeWorldUsd(const std::string& name, const std::vector<TreeBody>& bodies,
                         const std::map<std::string, const core::TriangleMesh*>& meshes) {
  RequireTreeNames(bodies);
  TreeUsd world(name, meshes);
  for (const TreeBody& body : bodies) world.Add(body);
  return world.Finish(name);
}

}  // namespace simwright::assets
