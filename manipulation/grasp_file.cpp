#include "manipulation/grasp_file.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>
#include <utility>

#include "core/error.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr const char* kGraspFormat = "simwright_grasps";
constexpr std::uint64_t kMostBytes = 256ull << 20;
constexpr double kRigid = 1e-6;    // of a rotation matrix
constexpr double kFarthest = 1e3;  // m
constexpr size_t kMostGraspsInFile = 100000;
constexpr double kSamePose = 1e-4;  // of equal poses of a gripper's base link, m and rad

core::OrderedJson VectorJson(const Vector3d& vector) {
  return core::OrderedJson::array({vector.x(), vector.y(), vector.z()});
}

core::OrderedJson MatrixJson(const Isometry3d& pose) {
  core::OrderedJson rows = core::OrderedJson::array();
  for (int row = 0; row < 4; ++row) {
    const Eigen::RowVector4d values = pose.matrix().row(row);
    rows.push_back({values[0], values[1], values[2], values[3]});
  }
  return rows;
}

Isometry3d PoseFrom(const core::JsonField& field) {
  Eigen::Matrix4d matrix;
  const std::vector<core::JsonField> rows = field.Elements(4);
  for (int row = 0; row < 4; ++row) {
    matrix.row(row) = rows[static_cast<size_t>(row)].Vector<4>().transpose();
  }
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const bool rigid = (rotation * rotation.transpose()).isIdentity(kRigid) &&
                     rotation.determinant() > 0.0 &&
                     matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), kRigid);
  if (!rigid) field.FailAs("a rigid transform of 4 x 4");
  Isometry3d pose(Eigen::Quaterniond(rotation).normalized());
  pose.translation() = matrix.topRightCorner<3, 1>();
  return pose;
}

core::OrderedJson GraspArrays(const GraspSet& set) {
  core::OrderedJson transforms = core::OrderedJson::array(), held = transforms;
  core::OrderedJson quality = transforms, tools = transforms, widths = transforms;
  core::OrderedJson openings = transforms, contacts = transforms, normals = transforms;
  core::OrderedJson clears = transforms;
  for (const Grasp& grasp : set.grasps) {
    transforms.push_back(MatrixJson(GraspGenPose(set, grasp)));
    held.push_back(true);
    quality.push_back(grasp.quality);
    tools.push_back(MatrixJson(grasp.object_from_tool));
    widths.push_back(grasp.width);
    openings.push_back(grasp.opening);
    clears.push_back(grasp.clears_support);
    contacts.push_back({VectorJson(grasp.contacts[0]), VectorJson(grasp.contacts[1])});
    normals.push_back({VectorJson(grasp.normals[0]), VectorJson(grasp.normals[1])});
  }
  core::OrderedJson arrays = {
      {"transforms", transforms}, {"object_in_gripper", held}, {"quality", quality},
      {"tool_transforms", tools}, {"width_m", widths},         {"opening_m", openings},
      {"contacts_m", contacts},   {"normals", normals},        {"clears_support", clears}};
  if (GraspedLinks(set).empty()) return arrays;
  for (const Grasp& grasp : set.grasps) {
    arrays["link"].push_back(grasp.link);
    arrays["joint"].push_back(grasp.joint);
  }
  return arrays;
}

core::OrderedJson JointProofsJson(const GraspSet& set) {
  core::OrderedJson json = core::OrderedJson::array();
  for (const JointProof& proof : set.joint_proofs) {
    core::OrderedJson one = {{"joint", proof.joint},
                             {"link", proof.link},
                             {"grasps", proof.grasps},
                             {"friction", proof.friction},
                             {"tried", proof.tried},
                             {"held_in_bullet", proof.held_in_bullet},
                             {"held_in_both", proof.held_in_both},
                             {"coverage", proof.coverage}};
    if (!proof.reason.empty()) one["reason"] = proof.reason;
    json.push_back(one);
  }
  return json;
}

JointProof JointProofFrom(const core::JsonField& field) {
  JointProof proof;
  proof.joint = field["joint"].Name();
  proof.link = field["link"].Name();
  proof.grasps = field["grasps"].Int(0);
  proof.friction = field["friction"].NumberWithin(0.0);
  proof.tried = field["tried"].Int(0);
  proof.held_in_bullet = field["held_in_bullet"].Int(0);
  proof.held_in_both = field["held_in_both"].Int(0);
  proof.coverage = field["coverage"].NumberWithin(0.0, 1.0);
  proof.reason = field.TextOr("reason", "");
  return proof;
}

std::vector<Grasp> GraspsFrom(const core::JsonField& grasps) {
  const std::vector<core::JsonField> tools = grasps["tool_transforms"].Elements();
  if (tools.size() > kMostGraspsInFile)
    grasps["tool_transforms"].Fail("has more than 100000 grasps");
  const std::vector<double> quality = grasps["quality"].Numbers(tools.size());
  const std::vector<double> widths = grasps["width_m"].Numbers(tools.size());
  const std::vector<double> openings = grasps["opening_m"].Numbers(tools.size());
  const std::vector<core::JsonField> contacts = grasps["contacts_m"].Elements(tools.size());
  const std::vector<core::JsonField> normals = grasps["normals"].Elements(tools.size());
  const std::vector<core::JsonField> clears = grasps["clears_support"].Elements(tools.size());
  std::vector<core::JsonField> links, joints;
  const bool articulated = grasps.Has("link") || grasps.Has("joint");
  if (articulated) {
    links = grasps["link"].Elements(tools.size());
    joints = grasps["joint"].Elements(tools.size());
  }
  std::vector<Grasp> all;
  for (size_t i = 0; i < tools.size(); ++i) {
    Grasp grasp;
    grasp.clears_support = clears[i].Flag();
    grasp.object_from_tool = PoseFrom(tools[i]);
    grasp.quality = quality[i];
    grasp.width = widths[i];
    if (!(grasp.quality >= 0.0) || grasp.quality > 1.0) grasps["quality"].Fail("is not 0 to 1");
    if (!(grasp.width > 0.0) || grasp.width > kFarthest) {
      grasps["width_m"].Fail("has a width that is not positive");
    }
    if (articulated) {
      grasp.link = links[i].Name();
      grasp.joint = joints[i].Name();
      if (grasp.link.empty() || grasp.joint.empty()) links[i].Fail("or its joint has no name");
    }
    grasp.opening = openings[i];
    if (!(grasp.opening > 0.0) || grasp.opening > kFarthest) {
      grasps["opening_m"].Fail("has an opening that is not positive");
    }
    const std::vector<core::JsonField> points = contacts[i].Elements(2);
    const std::vector<core::JsonField> outward = normals[i].Elements(2);
    for (size_t c = 0; c < 2; ++c) {
      grasp.contacts[c] = points[c].Vector<3>();
      grasp.normals[c] = outward[c].Vector<3>();
      const double farthest =
          std::max(grasp.contacts[c].cwiseAbs().maxCoeff(), grasp.normals[c].cwiseAbs().maxCoeff());
      if (farthest > kFarthest) contacts[i].Fail("is farther than 1 km");
    }
    if (grasp.object_from_tool.translation().cwiseAbs().maxCoeff() > kFarthest) {
      tools[i].Fail("is farther than 1 km");
    }
    all.push_back(std::move(grasp));
  }
  return all;
}

}  // namespace

std::vector<Grasp> GraspsOfJoint(const GraspSet& set, const std::string& joint) {
  std::vector<Grasp> grasps;
  std::copy_if(set.grasps.begin(), set.grasps.end(), std::back_inserter(grasps),
               [&](const Grasp& grasp) { return !grasp.joint.empty() && grasp.joint == joint; });
  return grasps;
}

std::vector<std::string> GraspedLinks(const GraspSet& set) {
  std::set<std::string> links;
  for (const Grasp& grasp : set.grasps) {
    if (!grasp.link.empty()) links.insert(grasp.link);
  }
  return {links.begin(), links.end()};
}

Isometry3d GraspGenPose(const GraspSet& set, const Grasp& grasp) {
  Isometry3d pose = grasp.object_from_tool;
  pose.translate(Vector3d(0.0, 0.0, set.tool_from_base.translation().z()));
  pose.rotate(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitZ()));
  return pose;
}

Isometry3d BaseLinkPose(const GraspSet& set, const Grasp& grasp) {
  return grasp.object_from_tool * set.tool_from_base;
}

bool IsForGripper(const GraspSet& set, const ParallelGripper& gripper) {
  return set.base_link == gripper.base_link &&
         (set.tool_from_base.matrix() - gripper.tool_from_base.matrix()).norm() < kSamePose &&
         set.max_opening <= gripper.model.max_opening + kSamePose;
}

core::OrderedJson GraspSetJson(const GraspSet& set) {
  core::OrderedJson joints = core::OrderedJson::array();
  for (const ParallelGripper::Joint& joint : set.joints) {
    joints.push_back({{"name", joint.name}, {"open", joint.open}, {"closing", joint.closing}});
  }
  core::OrderedJson json;
  json["format"] = kGraspFormat;
  json["format_version"] = 1;
  json["object"] = {{"name", set.object}, {"file", set.mesh}, {"scale", 1.0}};
  json["gripper"] = {{"name", set.gripper},
                     {"base_link", set.base_link},
                     {"tool_from_base", MatrixJson(set.tool_from_base)},
                     {"max_opening_m", set.max_opening},
                     {"force_n", set.force},
                     {"joints", joints}};
  json["proof"] = {{"engines", {"bullet", "mujoco"}},
                   {"friction", set.friction},
                   {"tried", set.tried},
                   {"held_in_bullet", set.held_in_bullet},
                   {"held_in_both", set.held_in_both},
                   {"coverage", set.coverage}};
  if (!set.joint_proofs.empty()) json["proof"]["joints"] = JointProofsJson(set);
  json["grasps"] = GraspArrays(set);
  return json;
}

GraspSet ReadGraspSet(const std::filesystem::path& file) {
  const core::JsonDocument document =
      core::JsonDocument::Read(file, kMostBytes, "write it again with `simwright grasps`");
  const core::JsonField root = document.root();
  if (root.TextOr("format", "") != kGraspFormat || root.IntOr("format_version", 0) != 1) {
    root.Fail("is not a grasps.json of version 1");
  }
  GraspSet set;
  set.object = root["object"]["name"].Name();
  set.mesh = root["object"]["file"].Text();
  const core::JsonField gripper = root["gripper"];
  set.gripper = gripper["name"].Name();
  set.base_link = gripper["base_link"].Name();
  set.tool_from_base = PoseFrom(gripper["tool_from_base"]);
  set.max_opening = gripper["max_opening_m"].PositiveNumber();
  set.force = gripper["force_n"].PositiveNumber();
  for (const core::JsonField& joint : gripper["joints"].Elements()) {
    set.joints.push_back({joint["name"].Name(), joint["open"].Number(), joint["closing"].Number()});
  }
  const core::JsonField proof = root["proof"], grasps = root["grasps"];
  set.friction = proof["friction"].NumberWithin(0.0);
  set.tried = proof["tried"].Int(0);
  set.held_in_bullet = proof["held_in_bullet"].Int(0);
  set.held_in_both = proof["held_in_both"].Int(0);
  set.coverage = proof["coverage"].NumberWithin(0.0, 1.0);
  if (proof.Has("joints")) {
    for (const core::JsonField& joint : proof["joints"].Elements()) {
      set.joint_proofs.push_back(JointProofFrom(joint));
    }
  }
  set.grasps = GraspsFrom(grasps);
  return set;
}
}  // namespace simwright::manipulation
