#include "assets/usd_asset.h"

#include <cstdio>
#include <map>
#include <utility>

#include "assets/usd_body.h"
#include "assets/usd_material.h"
#include "assets/usd_mesh.h"
#include "assets/usd_prim.h"
#include "assets/usd_tree.h"
#include "core/files.h"

namespace simwright::assets {
namespace {

std::string Numbered(const std::string& stem, size_t number) {
  char text[32];
  std::snprintf(text, sizeof(text), "_%03zu", number);
  return stem + text;
}

// The root prim of an asset, and what its parts share.
class AssetPrim {
 public:
  AssetPrim(const std::string& name, const physics_params::PhysicalParameters& parameters)
      : root_("Xform", UsdNames().Unique(name)) {
    root_.Meta("kind", "\"component\"").Meta("displayName", UsdString(name));
    Label(parameters.category, "category", &root_);
  }

  UsdPrim& root() { return root_; }
  std::string path() const { return "/" + root_.name(); }

  static void Label(const std::string& label, const std::string& taxonomy, UsdPrim* prim) {
    if (label.empty()) return;
    prim->Apply("SemanticsLabelsAPI:" + taxonomy)
        .Set("token[] semantics:labels:" + taxonomy, "[" + UsdString(label) + "]");
  }

  // Adds the files of images, named after `stem`; equal pictures share a file.
  std::vector<std::string> Files(const std::vector<core::Image>& pictures,
                                 const std::string& stem) {
    std::vector<std::string> files;
    for (const core::Image& picture : pictures) files.push_back(FileOf(picture, stem));
    return files;
  }

  // Adds the visual's materials, and returns their paths.
  std::vector<std::string> Materials(const core::TexturedMesh& visual, const PbrLook& look,
                                     const std::string& stem) {
    const UsdTextureFiles files{Files(visual.textures, stem), Files(look.images, stem + "_map")};
    std::vector<std::string> paths;
    for (size_t m = 0; m < visual.materials.size(); ++m) {
      const core::Material& material = visual.materials[m];
      const std::string name = names_.Unique(material.name.empty() ? stem : material.name);
      const PbrMaterial* pbr = m < look.materials.size() ? &look.materials[m] : nullptr;
      looks_.Add(UsdMaterial(path() + "/looks", name, material, pbr, files));
      paths.push_back(path() + "/looks/" + name);
    }
    return paths;
  }

  // Adds a material of contacts unless there is an equal one, and returns its path.
  std::string Contact(const UsdContact& contact) {
    const auto [at, is_new] = contacts_.try_emplace(contact);
    if (is_new) {
      const std::string name = names_.Unique("contact");
      looks_.Add(UsdPhysicsMaterial(name, contact));
      at->second = path() + "/looks/" + name;
    }
    return at->second;
  }

  UsdFiles Finish(const std::string& comment) {
    root_.Add(std::move(looks_));
    return {UsdLayerText(root_, comment), std::move(images_)};
  }

 private:
  std::string FileOf(const core::Image& picture, const std::string& stem) {
    for (const UsdFiles::ImageFile& known : images_) {
      if (known.image->width == picture.width && known.image->height == picture.height &&
          known.image->channels == picture.channels && known.image->pixels == picture.pixels) {
        return known.path;
      }
    }
    images_.push_back({"./textures/" + Numbered(stem, images_.size()) + ".png", &picture});
    return images_.back().path;
  }

  UsdPrim root_, looks_{"Scope", "looks"};
  UsdNames names_;                              // of looks
  std::map<UsdContact, std::string> contacts_;  // paths
  std::vector<UsdFiles::ImageFile> images_;
};

void AddShapes(const core::TexturedMesh& visual, const std::vector<core::TriangleMesh>& parts,
               const std::vector<std::string>& materials, const std::string& contact,
               UsdPrim* prim) {
  if (!visual.mesh.empty()) prim->Add(UsdVisualMesh("visual", visual, materials));
  for (size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty()) continue;
    prim->Add(UsdCollisionMesh(Numbered("collision", i), parts[i], contact));
  }
}

}  // namespace

UsdFiles UsdOf(const Asset& asset, const PbrLook& look) {
  AssetPrim prim(asset.name, asset.parameters);
  SetUsdBody(asset.inertial, &prim.root());
  const std::vector<std::string> materials = prim.Materials(asset.visual, look, asset.name);
  AddShapes(asset.visual, asset.parts, materials,
            prim.Contact({asset.friction, asset.restitution, asset.rolling_friction}),
            &prim.root());
  return prim.Finish("Simwright " SIMWRIGHT_VERSION ": " + asset.name);
}

UsdFiles UsdOf(const ArticulatedAsset& asset) {
  AssetPrim prim(asset.name, asset.parameters);
  prim.root().Apply("PhysicsArticulationRootAPI");
  UsdTreeStart start;
  start.fixed = asset.fixed;
  const UsdTree tree(MakeKinematicModel(asset), start, prim.path());
  std::vector<UsdPrim> links;
  for (size_t i = 0; i < asset.links.size(); ++i) {
    const ArticulatedLink& link = asset.links[i];
    UsdPrim body = tree.Link(i);
    AssetPrim::Label(link.label, "part", &body);
    const std::vector<std::string> materials = prim.Materials(link.visual, {}, link.name);
    AddShapes(link.visual, link.parts, materials,
              prim.Contact({link.friction, link.restitution, 0.0}), &body);
    if (tree.IsBody(i)) SetUsdFilteredPairs(tree.ExcludedPaths(i), &body);
    links.push_back(std::move(body));
  }
  tree.AddLinks(std::move(links), &prim.root());
  prim.root().Add(tree.Joints());
  return prim.Finish("Simwright " SIMWRIGHT_VERSION ": " + asset.name);
}

void WriteUsd(const UsdFiles& files, const std::filesystem::path& folder, const std::string& file) {
  core::WriteFile(folder / file, files.text);
  for (const UsdFiles::ImageFile& image : files.images) {
    std::filesystem::create_directories((folder / image.path).parent_path());
    core::WritePng(folder / image.path, *image.image);
  }
}

}  // namespace simwright::assets
