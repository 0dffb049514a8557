#include "assets/world_writer.h"

#include <algorithm>
#include <map>
#include <set>

#include <tinyxml2.h>

#include "assets/mjcf_elements.h"
#include "assets/model_writer.h"
#include "assets/xml_element.h"
#include "core/error.h"

namespace simwright::assets {
namespace {

// The step in s. At the 2 ms of a single asset, contacts with a time constant of 5 ms oscillate in
// stacks of four or five, whose upper objects creep by millimetres per second; at 1 ms no object
// moves by more than 0.1 mm.
constexpr double kMjcfStep = 1e-3;

void RequireName(const std::string& name) {
  if (FileSafeName(name) != name) throw core::Error("this is not a valid file name", name);
}

// Writes <size>. MuJoCo 2.2 reserves contacts and constraint rows, six per contact, in advance, and
// memory for the square of the rows, 0.8 GB for 8000; above 15 000 it fails. Scenes of tables and
// shelves have up to two contacts per part of a free object. `nstack`, its working memory, would
// also be reserved by the square.
void MjcfSize(tinyxml2::XMLPrinter* printer, const std::vector<WorldObject>& objects) {
  int contacts = 100, free = 0;
  for (const WorldObject& object : objects) {
    if (object.welded) continue;
    ++free;
    contacts += std::min(8 + 2 * static_cast<int>(object.asset->asset.parts.size()), 60);
  }
  const int rows = std::min(6 * contacts, 12'000);
  const int working = 1'000'000 + 2 * rows * std::min(6 * free, 600);
  Element(printer, "size")
      .Set("njmax", std::to_string(rows))
      .Set("nconmax", std::to_string(contacts))
      .Set("nstack", std::to_string(working));
}

void SdfModel(tinyxml2::XMLPrinter* printer, const WorldObject& object) {
  const Asset& asset = object.asset->asset;
  Element model(printer, "model");
  model.Set("name", object.name);
  if (object.welded) Leaf(printer, "static", "true");
  {
    const Eigen::Vector3d& place = object.world_from_object.translation();
    const Eigen::Quaterniond turn(object.world_from_object.linear());
    Element(printer, "pose")
        .Set("rotation_format", "quat_xyzw")
        .Text(Numbers({place.x(), place.y(), place.z(), turn.x(), turn.y(), turn.z(), turn.w()}));
  }
  Element link(printer, "link");
  link.Set("name", asset.name);
  SdfInertial(printer, asset.inertial);
  SdfVisual(printer, "visual", object.asset->folder + "visual.obj");
  const HydroelasticContact contact = ContactOf(asset);
  for (size_t i = 0; i < asset.parts.size(); ++i) {
    const std::string file = CollisionFileName(static_cast<int>(i));
    SdfCollision(printer, file.substr(0, file.find('.')), object.asset->folder + file, contact);
  }
}

void SdfPhysics(tinyxml2::XMLPrinter* printer) {
  Element physics(printer, "physics");
  physics.Set("name", "steady").Set("default", "true").Set("type", "ode");
  Leaf(printer, "max_step_size", "0.001");
  Leaf(printer, "real_time_factor", "1");
}

// Writes a light, without which the scene is dark.
void SdfSun(tinyxml2::XMLPrinter* printer) {
  Element light(printer, "light");
  light.Set("name", "sun").Set("type", "directional");
  Leaf(printer, "pose", "0 0 10 0 0 0");
  Leaf(printer, "cast_shadows", "true");
  Leaf(printer, "diffuse", "0.8 0.8 0.8 1");
  Leaf(printer, "specular", "0.2 0.2 0.2 1");
  Leaf(printer, "direction", "-0.5 0.2 -0.9");
}

}  // namespace

// Writes the ground as a box, because Drake's contact of meshes with a plane's half space failed in
// scenes. The box is rigid, because the objects on it are compliant, and two rigid bodies have no
// hydroelastic contact.
void SdfGround(tinyxml2::XMLPrinter* printer) {
  Element model(printer, "model");
  model.Set("name", kWorldGround);
  Leaf(printer, "static", "true");
  Element link(printer, "link");
  link.Set("name", kWorldGround);
  for (const char* const role : {"collision", "visual"}) {
    Element owner(printer, role);
    owner.Set("name", role);
    Leaf(printer, "pose", "0 0 -0.5 0 0 0");
    {
      Element geometry(printer, "geometry");
      Element box(printer, "box");
      Leaf(printer, "size", "20 20 1");
    }
    if (role != std::string("collision")) continue;
    {
      Element properties(printer, "drake:proximity_properties");
      Element(printer, "drake:rigid_hydroelastic");
      Leaf(printer, "drake:mesh_resolution_hint", "1");
    }
    SdfSurface(printer, kWorldGroundFriction);
  }
}

std::map<std::string, const WorldAsset*> WorldAssetsOf(const std::vector<WorldObject>& objects) {
  std::map<std::string, const WorldAsset*> assets;
  std::set<std::string> names = {kWorldGround};
  for (const WorldObject& object : objects) {
    RequireName(object.name);
    RequireName(object.asset->key);
    if (!names.insert(object.name).second) {
      throw core::Error("two objects of a world have the same name", object.name);
    }
    if (assets.emplace(object.asset->key, object.asset).first->second != object.asset) {
      throw core::Error("two assets of a world have the same key", object.asset->key);
    }
  }
  return assets;
}

std::string WorldMjcf(const std::string& name, const std::vector<WorldObject>& objects) {
  const std::map<std::string, const WorldAsset*> assets = WorldAssetsOf(objects);
  tinyxml2::XMLPrinter printer;
  {
    Element mujoco(&printer, "mujoco");
    mujoco.Set("model", name);
    Element(&printer, "compiler").Set("angle", "radian");
    MjcfOption(&printer, kMjcfStep);
    MjcfSize(&printer, objects);
    {
      Element meshes(&printer, "asset");
      for (const auto& [key, asset] : assets) {
        MjcfMeshes(&printer, asset->asset, {key, asset->folder});
      }
    }
    Element worldbody(&printer, "worldbody");
    // MuJoCo uses the greater friction of two, so the objects' own applies.
    Element(&printer, "geom")
        .Set("name", kWorldGround)
        .Set("type", "plane")
        .Set("size", "0 0 1")
        .Set("condim", "6")
        .Set("friction", "0.01 1e-5 1e-5");
    for (const WorldObject& object : objects) {
      MjcfBody(&printer, object.asset->asset, {object.asset->key, object.asset->folder},
               {object.name, &object.world_from_object, !object.welded});
    }
  }
  return printer.CStr();
}

std::string WorldSdf(const std::string& name, const std::vector<WorldObject>& objects,
                     SdfReader reader) {
  WorldAssetsOf(objects);
  tinyxml2::XMLPrinter printer;
  printer.PushHeader(false, true);
  {
    Element sdf(&printer, "sdf");
    sdf.Set("version", "1.9").Set("xmlns:drake", kDrakeNamespace);
    Element world(&printer, "world");
    world.Set("name", name);
    if (reader == SdfReader::kGazebo) {
      Leaf(&printer, "gravity", "0 0 -9.81");
      SdfPhysics(&printer);
      SdfSun(&printer);
    }
    SdfGround(&printer);
    for (const WorldObject& object : objects) SdfModel(&printer, object);
  }
  return printer.CStr();
}

std::string GroundSdf() {
  tinyxml2::XMLPrinter printer;
  printer.PushHeader(false, true);
  {
    Element sdf(&printer, "sdf");
    sdf.Set("version", "1.9").Set("xmlns:drake", kDrakeNamespace);
    SdfGround(&printer);
  }
  return printer.CStr();
}

}  // namespace simwright::assets
