#include "scene/export/scene_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/json.h"

namespace simwright::scene {
namespace {

using assets::WorldObject;

Eigen::Quaterniond RotationOf(const WorldObject& instance) {
  Eigen::Quaterniond turn = Eigen::Quaterniond(instance.world_from_object.linear()).normalized();
  if (turn.w() < 0.0) turn.coeffs() *= -1.0;
  return turn;
}

// Returns the number with a decimal point: YAML 1.1 parses 1e-05 as a string.
std::string Number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  std::string number = text;
  if (number.find('.') == std::string::npos) {
    number.insert(std::min(number.find('e'), number.size()), ".0");
  }
  return number;
}

// Quotes a name, so that a name of digits remains a string.
std::string Quoted(const std::string& name) {
  return "\"" + name + "\"";
}

std::string List(const Eigen::Vector3d& v) {
  return "[" + Number(v.x()) + ", " + Number(v.y()) + ", " + Number(v.z()) + "]";
}

std::string PoseLines(const WorldObject& instance, const std::string& indent) {
  const Eigen::AngleAxisd turn(RotationOf(instance));
  return indent + "translation: " + List(instance.world_from_object.translation()) + "\n" + indent +
         "rotation: !AngleAxis {angle_deg: " + Number(turn.angle() * (180.0 / M_PI)) +
         ", axis: " + List(turn.axis()) + "}\n";
}

}  // namespace

std::string SceneJson(const ExportedScene& scene) {
  core::OrderedJson json;
  json["format"] = 1;
  json["name"] = scene.name;
  json["type"] = scene.type;
  json["scene"] = scene.index;
  json["objects"] = core::OrderedJson::array();
  for (const WorldObject& instance : scene.objects) {
    const Eigen::Vector3d& place = instance.world_from_object.translation();
    const Eigen::Quaterniond turn = RotationOf(instance);
    core::OrderedJson object;
    object["name"] = instance.name;
    object["slot"] = instance.asset->key;
    object["urdf"] = instance.asset->folder + instance.asset->asset.name + ".urdf";
    object["translation"] = {place.x(), place.y(), place.z()};
    object["quaternion_wxyz"] = {turn.w(), turn.x(), turn.y(), turn.z()};
    object["welded"] = instance.welded;
    json["objects"].push_back(std::move(object));
  }
  return core::JsonText(json);
}

std::string DrakeDirectives(const ExportedScene& scene, const std::string& package) {
  std::string text = "# " + scene.name + ": model directives of Drake\ndirectives:\n";
  text += "- add_model:\n    name: ground\n    file: package://" + package + "/ground.sdf\n";
  for (const WorldObject& instance : scene.objects) {
    const std::string& link = instance.asset->asset.name;
    text += "- add_model:\n    name: " + Quoted(instance.name) + "\n    file: package://" +
            package + "/assets/" + instance.asset->key + "/" + link + ".sdf\n";
    if (instance.welded) {
      text += "- add_weld:\n    parent: world\n    child: " + Quoted(instance.name + "::" + link) +
              "\n    X_PC:\n" + PoseLines(instance, "      ");
    } else {
      text += "    default_free_body_pose:\n      " + Quoted(link) + ":\n" +
              PoseLines(instance, "        ");
    }
  }
  return text;
}

std::string PackageXml(const std::string& package) {
  return "<?xml version=\"1.0\"?>\n<package format=\"2\">\n  <name>" + package +
         "</name>\n  <version>1.0.0</version>\n  <description>Scenes and their "
         "assets</description>\n</package>\n";
}

}  // namespace simwright::scene
