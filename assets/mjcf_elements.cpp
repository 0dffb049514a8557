#include "assets/mjcf_elements.h"

#include <tinyxml2.h>

#include "assets/model_writer.h"
#include "assets/pbr_look.h"
#include "assets/xml_element.h"

namespace simwright::assets {
namespace {

// Returns true if the mesh has one texture, the most that MuJoCo supports.
bool IsTextured(const Asset& asset) {
  return asset.visual.textures.size() == 1 && VisualSuitsMujoco(asset.visual.mesh);
}

// Returns "cup_collision_007".
std::string CollisionMeshName(const MjcfNames& names, size_t part) {
  const std::string file = CollisionFileName(static_cast<int>(part));
  return names.prefix + "_" + file.substr(0, file.find('.'));
}

void VisualGeom(tinyxml2::XMLPrinter* printer, const Asset& asset, const MjcfNames& names) {
  Element visual(printer, "geom");
  visual.Set("type", "mesh")
      .Set("mesh", names.prefix + "_visual")
      .Set("contype", "0")
      .Set("conaffinity", "0")
      .Set("group", "2");
  if (IsTextured(asset)) {
    visual.Set("material", names.prefix + "_material");
  } else if (!asset.visual.materials.empty()) {
    const auto main = static_cast<size_t>(MainMaterial(asset.visual));
    const Eigen::Vector4f& c = asset.visual.materials[main].base_color;
    visual.Set("rgba", Numbers({c.x(), c.y(), c.z(), 1.0}));
  }
}

}  // namespace

void MjcfMeshes(tinyxml2::XMLPrinter* printer, const Asset& asset, const MjcfNames& names) {
  if (IsTextured(asset)) {
    Element(printer, "texture")
        .Set("name", names.prefix + "_texture")
        .Set("type", "2d")
        .Set("file", names.folder + "texture.png");
    Element(printer, "material")
        .Set("name", names.prefix + "_material")
        .Set("texture", names.prefix + "_texture");
  }
  const bool suits = VisualSuitsMujoco(asset.visual.mesh);
  Element(printer, "mesh")
      .Set("name", names.prefix + "_visual")
      .Set("file", names.folder + (suits ? "visual.obj" : "solid.obj"));
  for (size_t i = 0; i < asset.parts.size(); ++i) {
    Element(printer, "mesh")
        .Set("name", CollisionMeshName(names, i))
        .Set("file", names.folder + CollisionFileName(static_cast<int>(i)));
  }
}

void MjcfBody(tinyxml2::XMLPrinter* printer, const Asset& asset, const MjcfNames& names,
              const MjcfInstance& place) {
  Element body(printer, "body");
  body.Set("name", place.body);
  if (place.pose != nullptr) {
    const Eigen::Quaterniond turn(place.pose->linear());
    body.Set("pos", Numbers(Eigen::Vector3d(place.pose->translation())))
        .Set("quat", Numbers({turn.w(), turn.x(), turn.y(), turn.z()}));
  }
  if (place.free) Element(printer, "freejoint").Set("name", place.body + "_free");
  MjcfInertial(printer, asset.inertial);
  VisualGeom(printer, asset, names);
  for (size_t i = 0; i < asset.parts.size(); ++i) {
    Element(printer, "geom")
        .Set("type", "mesh")
        .Set("mesh", CollisionMeshName(names, i))
        .Set("group", "3")
        .Set("condim", "6")
        .Set("friction", Numbers({asset.friction, asset.rolling_friction, asset.rolling_friction}))
        .Set("solref", Numbers({0.005, DampingRatio(asset.restitution)}));
  }
}

}  // namespace simwright::assets
