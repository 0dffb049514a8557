#include "viewer/model_document.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Eigenvalues>

#include "assets/link_visuals.h"
#include "core/error.h"
#include "core/finding_json.h"

namespace simwright::viewer {
namespace {

using core::OrderedJson;

const Eigen::Vector4f kPlainColor(0.78f, 0.79f, 0.81f, 1.0f);

OrderedJson LinkJson(const std::string& name, const assets::Inertial* inertial) {
  OrderedJson link = {{"name", name}};
  if (inertial != nullptr && inertial->mass > 0.0) {
    const EquivalentBox box = EquivalentBoxOf(*inertial);
    link["mass"] = inertial->mass;
    link["center_of_mass"] = VectorNumbers(inertial->center_of_mass);
    link["box_size"] = VectorNumbers(box.size);
    link["link_from_box"] = PoseNumbers(box.link_from_box);
  }
  for (const char* layer : {"visual", "solid", "parts"}) link[layer] = OrderedJson::array();
  return link;
}

std::string TypeName(assets::JointType type) {
  switch (type) {
    case assets::JointType::kFixed:
      return "fixed";
    case assets::JointType::kRevolute:
      return "revolute";
    case assets::JointType::kContinuous:
      return "continuous";
    case assets::JointType::kPrismatic:
      return "prismatic";
    case assets::JointType::kFloating:
      return "floating";
    case assets::JointType::kPlanar:
      return "planar";
  }
  return "fixed";
}

// `links`: the index of each link by name.
OrderedJson JointJson(const assets::Joint& joint, const std::map<std::string, int>& links) {
  const auto parent = links.find(joint.parent);
  OrderedJson json = {{"name", joint.name},
                      {"type", TypeName(joint.type)},
                      {"parent", parent == links.end() ? 0 : parent->second},
                      {"parent_from_joint", PoseNumbers(joint.parent_from_joint)},
                      {"axis", VectorNumbers(joint.axis)},
                      {"lower", joint.lower},
                      {"upper", joint.upper}};
  if (joint.mimic) {
    json["mimic"] = {{"joint", joint.mimic->joint},
                     {"multiplier", joint.mimic->multiplier},
                     {"offset", joint.mimic->offset}};
  }
  return json;
}

OrderedJson JointsJson(const std::vector<assets::Joint>& joints,
                       const std::map<std::string, int>& links) {
  OrderedJson list = OrderedJson::array();
  for (const assets::Joint& joint : joints) list.push_back(JointJson(joint, links));
  return list;
}

int MovingJoints(const std::vector<assets::Joint>& joints) {
  return static_cast<int>(std::count_if(joints.begin(), joints.end(),
                                        [](const assets::Joint& joint) { return joint.Moves(); }));
}

std::string SizeText(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return "empty";
  const Eigen::Vector3d size = 1000.0 * box.sizes();
  return Quantity(size.x(), "") + " x " + Quantity(size.y(), "") + " x " + Quantity(size.z(), "mm");
}

void AddFindings(const core::Findings& findings, DocumentBuilder* builder) {
  for (const core::Finding& finding : findings) AddFinding(finding, builder);
}

OrderedJson FactsOf(const assets::Asset& asset) {
  return FactsJson({{"category", asset.parameters.category},
                    {"size", SizeText(core::Bounds(asset.solid))},
                    {"mass", Quantity(asset.inertial.mass, "kg")},
                    {"material", asset.parameters.material},
                    {"volume of the solid", Quantity(1e6 * asset.volume, "cm³")},
                    {"friction", Quantity(asset.friction, "")},
                    {"restitution", Quantity(asset.restitution, "")},
                    {"visual triangles", std::to_string(asset.visual.mesh.triangles.size())},
                    {"solid triangles", std::to_string(asset.solid.triangles.size())},
                    {"convex parts", std::to_string(asset.parts.size())}});
}

}  // namespace

EquivalentBox EquivalentBoxOf(const assets::Inertial& inertial) {
  EquivalentBox box;
  box.link_from_box.translation() = inertial.center_of_mass;
  if (!(inertial.mass > 0.0) || !inertial.inertia.allFinite()) return box;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertial.inertia);
  Eigen::Matrix3d axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);
  box.link_from_box.linear() = axes;
  const Eigen::Vector3d moments = solver.eigenvalues();
  for (int i = 0; i < 3; ++i) {
    const double square = 6.0 * (moments.sum() - 2.0 * moments[i]) / inertial.mass;
    box.size[i] = std::sqrt(std::max(0.0, square));
  }
  return box;
}

void AddFinding(const core::Finding& finding, DocumentBuilder* builder) {
  OrderedJson& findings = builder->manifest()["findings"];
  for (OrderedJson& json : core::FindingsJson({finding})) {
    const bool known = std::find(findings.begin(), findings.end(), json) != findings.end();
    if (!known) findings.push_back(std::move(json));
  }
}

OrderedJson ModelOf(const assets::Asset& asset, DocumentBuilder* builder) {
  OrderedJson link = LinkJson(asset.name, &asset.inertial);
  link["visual"].push_back(builder->AddMesh(asset.visual, asset.name));
  link["solid"].push_back(builder->AddMesh(asset.solid, asset.name));
  for (const core::TriangleMesh& part : asset.parts) {
    link["parts"].push_back(builder->AddMesh(part, asset.name));
  }
  AddFindings(asset.findings, builder);
  return {{"name", asset.name},
          {"facts", FactsOf(asset)},
          {"links", OrderedJson::array({link})},
          {"joints", OrderedJson::array()}};
}

OrderedJson ModelOf(const assets::ArticulatedAsset& asset, DocumentBuilder* builder) {
  OrderedJson links = OrderedJson::array();
  std::map<std::string, int> indices;
  double mass = 0.0;
  std::size_t parts = 0;
  for (const assets::ArticulatedLink& link : asset.links) {
    indices.emplace(link.name, static_cast<int>(indices.size()));
    OrderedJson json = LinkJson(link.name, &link.inertial);
    json["label"] = link.label;
    if (!link.visual.mesh.empty()) {
      json["visual"].push_back(builder->AddMesh(link.visual, link.name));
    }
    for (const core::TriangleMesh& part : link.parts) {
      json["parts"].push_back(builder->AddMesh(part, link.name));
    }
    mass += link.inertial.mass;
    parts += link.parts.size();
    links.push_back(std::move(json));
  }
  AddFindings(asset.findings, builder);
  const Eigen::AlignedBox3d box = assets::BoundsAtZero(asset);
  return {{"name", asset.name},
          {"facts", FactsJson({{"category", asset.parameters.category},
                               {"size", SizeText(box)},
                               {"mass", Quantity(mass, "kg")},
                               {"links", std::to_string(asset.links.size())},
                               {"moving joints", std::to_string(MovingJoints(asset.joints))},
                               {"convex parts", std::to_string(parts)},
                               {"base", asset.fixed ? "mounted" : "free"}})},
          {"links", links},
          {"joints", JointsJson(asset.joints, indices)}};
}

OrderedJson ModelOf(const assets::UrdfModel& model, const std::string& name,
                    DocumentBuilder* builder) {
  OrderedJson links = OrderedJson::array();
  std::map<std::string, int> indices;
  double mass = 0.0;
  for (const assets::UrdfLink& link : model.links) {
    indices.emplace(link.name, static_cast<int>(indices.size()));
    OrderedJson json = LinkJson(link.name, link.inertial ? &*link.inertial : nullptr);
    for (const assets::UrdfShape& shape : link.collisions) {
      if (!shape.mesh.empty()) json["parts"].push_back(builder->AddMesh(shape.mesh, link.name));
    }
    if (link.inertial) mass += link.inertial->mass;
    links.push_back(std::move(json));
  }
  for (const assets::LinkVisual& visual : assets::LinkVisuals(model)) {
    try {
      const core::TexturedMesh mesh = assets::ReadVisual(visual, kPlainColor);
      if (mesh.mesh.empty()) continue;
      links[static_cast<std::size_t>(visual.link)]["visual"].push_back(
          builder->AddMesh(mesh, visual.file));
    } catch (const core::Error& error) {
      AddFinding({"view-visual-not-read", core::Severity::kWarning, error.where(), error.what()},
                 builder);
    }
  }
  AddFindings(model.findings, builder);
  return {{"name", name.empty() ? model.name : name},
          {"facts", FactsJson({{"mass", Quantity(mass, "kg")},
                               {"links", std::to_string(model.links.size())},
                               {"moving joints", std::to_string(MovingJoints(model.joints))}})},
          {"links", links},
          {"joints", JointsJson(model.joints, indices)}};
}

OrderedJson ModelOf(const core::TexturedMesh& mesh, const std::string& name,
                    DocumentBuilder* builder) {
  OrderedJson link = LinkJson(name, nullptr);
  link["visual"].push_back(builder->AddMesh(mesh, name));
  return {{"name", name},
          {"facts", FactsJson({{"size", SizeText(core::Bounds(mesh.mesh))},
                               {"triangles", std::to_string(mesh.mesh.triangles.size())},
                               {"materials", std::to_string(mesh.materials.size())}})},
          {"links", OrderedJson::array({link})},
          {"joints", OrderedJson::array()}};
}

}  // namespace simwright::viewer
