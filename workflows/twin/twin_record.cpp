#include "workflows/twin/twin_record.h"

#include <cmath>
#include <cstdint>
#include <initializer_list>

#include "assets/asset.h"
#include "core/error.h"
#include "core/json.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr int kTwinFormat = 1;
constexpr std::uint64_t kMostBytes = 8u << 20;

constexpr const char* kSourceNames[] = {"fitted", "retrieved", "lifted"};

TwinSource TwinSourceOf(const core::JsonField& object) {
  const std::string name = object.TextOr("source", kSourceNames[0]);
  for (int i = 0; i < 3; ++i) {
    if (name == kSourceNames[i]) return static_cast<TwinSource>(i);
  }
  object["source"].FailAs("fitted, retrieved or lifted");
}

core::OrderedJson NumbersOf(std::initializer_list<double> values) {
  core::OrderedJson numbers = core::OrderedJson::array();
  for (const double value : values) numbers.push_back(value);
  return numbers;
}

core::OrderedJson ObjectJson(const TwinObject& object) {
  const Eigen::Vector3d at = object.world_from_object.translation();
  const Eigen::Quaterniond turn(object.world_from_object.linear());
  core::OrderedJson json;
  json["name"] = object.name;
  json["asset"] = "assets/" + object.name;
  json["source"] = kSourceNames[static_cast<int>(object.source)];
  json["kind"] = object.kind;
  json["category"] = object.category;
  json["translation"] = NumbersOf({at.x(), at.y(), at.z()});
  json["quaternion_wxyz"] = NumbersOf({turn.w(), turn.x(), turn.y(), turn.z()});
  json["welded"] = object.articulated;
  if (!object.joints.empty()) json["joints"] = object.joints;
  json["size"] = NumbersOf({object.size.x(), object.size.y(), object.size.z()});
  json["confidence"] = object.confidence;
  json["outline_iou"] = object.outline_iou;
  json["position_error"] = object.position_error;
  json["yaw_error"] = object.yaw_error;
  json["size_error"] = object.size_error;
  json["settled"] = object.settled;
  json["box"] = NumbersOf(
      {object.box.min().x(), object.box.min().y(), object.box.max().x(), object.box.max().y()});
  if (!object.seen_in.empty()) json["seen_in"] = object.seen_in;
  return json;
}

Eigen::Isometry3d PoseIn(const core::JsonField& field) {
  const Eigen::Vector4d turn = field["quaternion_wxyz"].Vector<4>();
  if (std::abs(turn.norm() - 1.0) > 1e-6) {
    field["quaternion_wxyz"].Fail("must have the length 1");
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(turn[0], turn[1], turn[2], turn[3]).toRotationMatrix();
  pose.translation() = field["translation"].Vector<3>();
  return pose;
}

TwinObject ReadObject(const core::JsonField& field) {
  TwinObject object;
  object.name = field["name"].Name();
  if (object.name != assets::FileSafeName(object.name) ||
      field["asset"].Text() != "assets/" + object.name) {
    field["asset"].Fail("must be assets/ and the object's name, a name of a folder");
  }
  object.source = TwinSourceOf(field);
  object.kind = field["kind"].Name();
  object.category = field["category"].Name();
  object.world_from_object = PoseIn(field);
  object.articulated = field["welded"].Flag();
  if (field.Has("joints")) {
    for (const auto& [joint, position] : field["joints"].Members()) {
      object.joints[joint] = position.Number();
    }
  }
  object.size = field["size"].Vector<3>();
  object.confidence = field["confidence"].NumberWithin(0.0, 1.0);
  object.outline_iou = field["outline_iou"].NumberWithin(0.0, 1.0);
  object.position_error = field["position_error"].NumberWithin(0.0);
  object.yaw_error = field["yaw_error"].NumberWithin(0.0);
  object.size_error = field["size_error"].NumberWithin(0.0);
  object.settled = field["settled"].NumberWithin(0.0);
  const Eigen::Vector4d box = field["box"].Vector<4>();
  object.box = {Eigen::Vector2d(box[0], box[1]), Eigen::Vector2d(box[2], box[3])};
  if (field.Has("seen_in")) object.seen_in = field["seen_in"].Ints();
  return object;
}

}  // namespace

std::string TwinJson(const TwinRecord& record) {
  const core::Camera& camera = record.camera;
  const Eigen::Vector3d at = camera.position();
  const Eigen::Quaterniond turn(camera.world_from_camera.linear());
  core::OrderedJson json;
  json["twin_format"] = kTwinFormat;
  json["photo"] = record.photo;
  json["camera"]["size"] = {camera.width, camera.height};
  json["camera"]["focal"] = NumbersOf({camera.fx, camera.fy});
  json["camera"]["principal_point"] = NumbersOf({camera.cx, camera.cy});
  json["camera"]["translation"] = NumbersOf({at.x(), at.y(), at.z()});
  json["camera"]["quaternion_wxyz"] = NumbersOf({turn.w(), turn.x(), turn.y(), turn.z()});
  json["log_scale_error"] = record.log_scale_error;
  json["stands"] = record.stands;
  json["penetration"] = record.penetration;
  json["objects"] = core::OrderedJson::array();
  for (const TwinObject& object : record.objects) json["objects"].push_back(ObjectJson(object));
  return core::JsonText(json, core::InvalidUtf8::kReplace);
}

TwinRecord ReadTwin(const fs::path& folder) {
  const fs::path path = folder / "twin.json";
  if (!fs::exists(path)) {
    throw core::Error("the folder holds no twin", folder.string(),
                      "simwright twin PHOTO -o DIR makes one");
  }
  const core::JsonDocument document =
      core::JsonDocument::Read(path, kMostBytes, "make the twin again");
  const core::JsonField root = document.root();
  if (root["twin_format"].Int() != kTwinFormat) root["twin_format"].FailAs("1");
  TwinRecord record;
  record.photo = root["photo"].Name();
  const core::JsonField camera = root["camera"];
  const Eigen::Vector2d size = camera["size"].Vector<2>(), focal = camera["focal"].Vector<2>(),
                        middle = camera["principal_point"].Vector<2>();
  record.camera.width = static_cast<int>(size[0]);
  record.camera.height = static_cast<int>(size[1]);
  record.camera.fx = focal[0];
  record.camera.fy = focal[1];
  record.camera.cx = middle[0];
  record.camera.cy = middle[1];
  record.camera.world_from_camera = PoseIn(camera);
  record.log_scale_error = root["log_scale_error"].NumberWithin(0.0);
  record.stands = root["stands"].Flag();
  record.penetration = root["penetration"].NumberWithin(0.0);
  for (const core::JsonField& object : root["objects"].Elements()) {
    record.objects.push_back(ReadObject(object));
  }
  return record;
}

}  // namespace simwright::workflows
