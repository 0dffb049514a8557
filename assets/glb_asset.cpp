#include "assets/glb_asset.h"

#include <map>

#include <Eigen/Geometry>

#include "assets/articulated_writer.h"
#include "assets/glb_buffer.h"
#include "assets/glb_mesh.h"
#include "assets/joint.h"
#include "core/error.h"

namespace simwright::assets {
namespace {

using core::OrderedJson;

OrderedJson Quaternion(const Eigen::Quaterniond& turn) {
  return {turn.x(), turn.y(), turn.z(), turn.w()};
}

// Starts the document with the root node, whose children follow.
void StartDocument(const std::string& name, const std::string& category, double mass,
                   GlbBuffer* glb) {
  glb->root["asset"] = {{"version", "2.0"}, {"generator", "Simwright " SIMWRIGHT_VERSION}};
  glb->root["scene"] = 0;
  glb->root["scenes"] = OrderedJson::array({{{"nodes", OrderedJson::array({0})}}});
  OrderedJson node = {{"name", name}};
  const Eigen::Quaterniond y_from_z(Eigen::AngleAxisd(-0.5 * EIGEN_PI, Eigen::Vector3d::UnitX()));
  node["rotation"] = Quaternion(y_from_z);
  node["extras"] = {{"name", name}, {"category", category}, {"mass_kg", mass}};
  glb->root["nodes"].push_back(node);
}

void AddChild(std::size_t parent, const OrderedJson& node, GlbBuffer* glb) {
  glb->root["nodes"].push_back(node);
  glb->root["nodes"][parent]["children"].push_back(glb->root["nodes"].size() - 1);
}

OrderedJson JointExtras(const Joint& joint) {
  OrderedJson json = {{"name", joint.name}, {"type", JointTypeName(joint.type)}};
  if (!joint.Moves()) return json;
  json["axis"] = {joint.axis.x(), joint.axis.y(), joint.axis.z()};
  if (joint.type != JointType::kContinuous) {
    json["lower"] = joint.lower;
    json["upper"] = joint.upper;
  }
  return json;
}

OrderedJson LinkNode(const ArticulatedLink& link, const Joint* joint, GlbBuffer* glb) {
  OrderedJson node = {{"name", link.name}};
  if (!link.visual.mesh.empty()) {
    node["mesh"] = AddGlbMesh(link.name, link.visual, {}, glb);
  }
  if (joint != nullptr) {
    const Eigen::Isometry3d& pose = joint->parent_from_joint;
    node["translation"] = {pose.translation().x(), pose.translation().y(), pose.translation().z()};
    node["rotation"] = Quaternion(Eigen::Quaterniond(pose.linear()).normalized());
  }
  node["extras"] = {{"label", link.label}, {"mass_kg", link.inertial.mass}};
  if (joint != nullptr) node["extras"]["joint"] = JointExtras(*joint);
  return node;
}

}  // namespace

std::string GlbText(const Asset& asset, const PbrLook& look) {
  GlbBuffer glb;
  StartDocument(asset.name, asset.parameters.category, asset.inertial.mass, &glb);
  glb.root["nodes"][0]["mesh"] = AddGlbMesh(asset.name, asset.visual, look, &glb);
  return glb.Glb();
}

std::string GlbText(const ArticulatedAsset& asset) {
  GlbBuffer glb;
  StartDocument(asset.name, asset.parameters.category, CombinedInertial(ModelOf(asset)).mass, &glb);
  std::map<std::string, std::size_t> node_of;  // by link
  for (std::size_t i = 0; i < asset.links.size(); ++i) {
    const Joint* joint = i == 0 ? nullptr : &asset.joints.at(i - 1);
    std::size_t parent = 0;
    if (joint != nullptr) {
      const auto found = node_of.find(joint->parent);
      if (found == node_of.end()) {
        throw core::Error("joint '" + joint->name + "' names a link that comes later or is missing",
                          asset.name, "make the asset again");
      }
      parent = found->second;
    }
    AddChild(parent, LinkNode(asset.links[i], joint, &glb), &glb);
    node_of[asset.links[i].name] = glb.root["nodes"].size() - 1;
  }
  return glb.Glb();
}

}  // namespace simwright::assets
