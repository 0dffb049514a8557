#include "assets/urdf_reader.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <console_bridge/console.h>
#include <tinyxml2.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include "assets/collision_exclusion.h"
#include "assets/mesh_import.h"
#include "assets/primitive_meshes.h"
#include "assets/urdf_meshes.h"
#include "assets/urdf_sanity.h"
#include "assets/urdf_text.h"
#include "assets/urdf_up_axis.h"
#include "core/error.h"
#include "core/files.h"
#include "geometry/mass_properties.h"

namespace simwright::assets {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMaxUrdfBytes = 16ull << 20;

Eigen::Isometry3d ToIsometry(const urdf::Pose& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  result.linear() =
      Eigen::Quaterniond(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z)
          .normalized()
          .toRotationMatrix();
  return result;
}

// Collects urdfdom's messages, which it would print otherwise.
class UrdfdomMessages : public console_bridge::OutputHandler {
 public:
  UrdfdomMessages() : previous_(console_bridge::getOutputHandler()) {
    console_bridge::useOutputHandler(this);
  }
  ~UrdfdomMessages() override { console_bridge::useOutputHandler(previous_); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_WARN) messages.push_back(text);
  }
  std::vector<std::string> messages;

 private:
  console_bridge::OutputHandler* previous_;
};

struct MeshShape {
  core::TriangleMesh mesh;
  char up = 0;  // see UrdfShape::up
};

class UrdfParser {
 public:
  UrdfParser(const fs::path& path, const UrdfReadOptions& options)
      : path_(path),
        options_(options),
        finder_(path, options.root.empty() ? PackageRootOf(path) : options.root) {}
  UrdfModel Read();

 private:
  void Warn(const std::string& code, const std::string& sentence, const std::string& remedy = "") {
    Say(code, core::Severity::kWarning, sentence, 0.0, remedy);
  }
  void Say(const std::string& code, core::Severity severity, const std::string& sentence,
           double figure, const std::string& remedy = "") {
    model_.findings.push_back({code, severity, path_.string(), sentence, figure, remedy});
  }
  void AddLink(const urdf::Link& link);
  void AddInertial(const urdf::Inertial& from, UrdfLink* link);
  void AddJoint(const urdf::Joint& joint);
  void AddShape(const urdf::Geometry& geometry, const urdf::Pose& origin,
                const urdf::MaterialSharedPtr& material, std::vector<UrdfShape>* shapes);
  // Returns the mesh of a file, in its own coordinates; null, with a finding, if it is skipped.
  const MeshShape* MeshNamed(const std::string& name, std::string* file);
  void ReadContacts(const std::string& text);

  fs::path path_;
  UrdfReadOptions options_;
  MeshFinder finder_;
  std::map<std::string, MeshShape> meshes_;   // by file: visual and collision share them
  std::map<std::string, std::string> files_;  // by name; empty if skipped
  std::string text_;                          // the input of urdfdom
  UrdfModel model_;
};

const MeshShape* UrdfParser::MeshNamed(const std::string& name, std::string* file) {
  const auto known = files_.find(name);
  if (known == files_.end()) {
    std::string& place = files_[name];
    const std::optional<FoundMesh> found = finder_.Find(name);
    if (!found) {
      Warn("urdf-missing-mesh", "the mesh '" + name + "' is missing and skipped",
           "put it into the URDF's folder or package, or give the folder that holds both");
      return nullptr;
    }
    if (!found->resolution_note.empty())
      Say("urdf-mesh-name", core::Severity::kInfo, found->resolution_note, 0.0);
    try {
      if (!meshes_.contains(found->file.string())) {
        MeshShape shape;
        if (found->file.extension() == ".obj") {
          shape.mesh = ReadBareObj(found->file);
        } else {
          MeshFile read = ReadMeshFile(found->file);
          shape = {std::move(read.mesh.mesh), read.up};
        }
        meshes_.emplace(found->file.string(), std::move(shape));
      }
      place = found->file.string();
    } catch (const core::Error& error) {
      Warn("urdf-unreadable-mesh", std::string("a mesh is skipped: ") + error.what());
    }
  }
  *file = files_.at(name);
  return file->empty() ? nullptr : &meshes_.at(*file);
}

void UrdfParser::AddShape(const urdf::Geometry& geometry, const urdf::Pose& origin,
                          const urdf::MaterialSharedPtr& material, std::vector<UrdfShape>* shapes) {
  UrdfShape shape;
  if (material && material->texture_filename.empty()) {
    const urdf::Color& c = material->color;
    shape.color = Eigen::Vector4f(c.r, c.g, c.b, c.a);
  }
  shape.link_from_primitive = ToIsometry(origin);
  shape.link_from_file = Eigen::Affine3d(shape.link_from_primitive);
  switch (geometry.type) {
    case urdf::Geometry::BOX: {
      const auto& dim = static_cast<const urdf::Box&>(geometry).dim;
      shape.mesh = BoxMesh({dim.x, dim.y, dim.z});
      shape.geometry = UrdfGeometry::kBox;
      break;
    }
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      shape.mesh = CylinderMesh(cylinder.radius, cylinder.length);
      shape.geometry = UrdfGeometry::kCylinder;
      shape.radius = cylinder.radius;
      shape.length = cylinder.length;
      break;
    }
    case urdf::Geometry::SPHERE:
      shape.radius = static_cast<const urdf::Sphere&>(geometry).radius;
      shape.mesh = SphereMesh(shape.radius);
      shape.geometry = UrdfGeometry::kSphere;
      break;
    case urdf::Geometry::MESH: {
      const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
      const MeshShape* known = MeshNamed(mesh.filename, &shape.file);
      if (known == nullptr) return;
      shape.mesh = known->mesh;
      shape.up = known->up;
      const Eigen::Vector3d scale(mesh.scale.x, mesh.scale.y, mesh.scale.z);
      shape.link_from_file.scale(scale);
      break;
    }
  }
  core::Transform(shape.link_from_file, &shape.mesh);
  if (shape.file.empty()) shape.link_from_file.setIdentity();
  core::RequireValid(shape.mesh, path_.string());
  shapes->push_back(std::move(shape));
}

// Adds the file's inertial, or a replacement for an impossible one.
void UrdfParser::AddInertial(const urdf::Inertial& from, UrdfLink* link) {
  const std::string where = path_.string() + " link '" + link->name + "'";
  const bool shapes = !link->visuals.empty() || !link->collisions.empty();
  if (from.mass == 0.0 && !shapes) return;  // a frame
  const Eigen::Isometry3d pose = ToIsometry(from.origin);
  Inertial inertial;
  inertial.mass = from.mass;
  inertial.center_of_mass = pose.translation();
  Eigen::Matrix3d local;
  local << from.ixx, from.ixy, from.ixz, from.ixy, from.iyy, from.iyz, from.ixz, from.iyz, from.izz;
  inertial.inertia = pose.linear() * local * pose.linear().transpose();
  const InertialFault fault = FaultOf(inertial);
  if (!options_.repair_inertials) {
    RequirePhysical(inertial, where);
    link->inertial = inertial;
    return;
  }
  Eigen::AlignedBox3d box;
  for (const auto* some : {&link->visuals, &link->collisions}) {
    for (const UrdfShape& shape : *some) box.extend(core::Bounds(shape.mesh));
  }
  const bool massive = inertial.mass > 0.0 && std::isfinite(inertial.mass);
  if (!fault.sentence.empty()) {
    Warn("urdf-impossible-inertial",
         "link '" + link->name + "': " + fault.sentence + "; " +
             (massive ? "it is replaced" : "it is ignored"),
         fault.remedy);
    if (!massive) return;
    const Eigen::Vector3d s =
        shapes ? Eigen::Vector3d(box.sizes()) : Eigen::Vector3d(Eigen::Vector3d::Constant(0.01));
    const Eigen::Vector3d q = s.cwiseMax(1e-4).cwiseAbs2();
    inertial.inertia = inertial.mass / 12.0 *
                       Eigen::Vector3d(q.y() + q.z(), q.x() + q.z(), q.x() + q.y()).asDiagonal();
    if (shapes) inertial.center_of_mass = box.center();
  } else if (shapes) {
    // The radius of gyration inside the box is at most half its diagonal.
    const double reach = std::sqrt(
        geometry::PrincipalInertiaOf(inertial.inertia).moments.maxCoeff() / inertial.mass);
    if (reach > 0.5 * box.diagonal().norm()) {
      Say("urdf-implausible-inertia", core::Severity::kWarning,
          "link '" + link->name +
              "' has the inertia of a larger body: its radius of gyration exceeds half of its size",
          reach, "compute the inertia from the shape");
    }
  }
  link->inertial = inertial;
}

void UrdfParser::AddLink(const urdf::Link& source) {
  UrdfLink link;
  link.name = source.name;
  for (const auto& visual : source.visual_array) {
    if (!visual || !visual->geometry) continue;
    AddShape(*visual->geometry, visual->origin, visual->material, &link.visuals);
  }
  for (const auto& collision : source.collision_array) {
    if (collision && collision->geometry) {
      AddShape(*collision->geometry, collision->origin, nullptr, &link.collisions);
    }
  }
  if (source.inertial) {
    AddInertial(*source.inertial, &link);
  } else if (!source.collision_array.empty() || !source.visual_array.empty()) {
    Warn("urdf-no-inertial", "link '" + source.name + "' has no inertial");
  }
  model_.links.push_back(std::move(link));
}

// Reads <contact> from the text, because urdfdom does not provide it.
void UrdfParser::ReadContacts(const std::string& text) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return;
  const auto* robot = document.FirstChildElement("robot");
  if (robot == nullptr) return;
  model_.excluded_pairs = ExcludedPairsIn(*robot);
  for (auto* link = robot->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    const auto* contact = link->FirstChildElement("contact");
    const char* name = link->Attribute("name");
    if (contact == nullptr || name == nullptr) continue;
    for (UrdfLink& known : model_.links) {
      if (known.name != name) continue;
      if (const auto* e = contact->FirstChildElement("lateral_friction")) {
        known.friction = std::clamp(e->DoubleAttribute("value", known.friction), 0.0, 10.0);
      }
      if (const auto* e = contact->FirstChildElement("rolling_friction")) {
        known.rolling_friction = std::clamp(e->DoubleAttribute("value", 0.0), 0.0, 1.0);
      }
      if (const auto* e = contact->FirstChildElement("restitution")) {
        known.restitution = std::clamp(e->DoubleAttribute("value", 0.0), 0.0, 1.0);
      }
    }
  }
}

JointType TypeOf(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::REVOLUTE:
      return JointType::kRevolute;
    case urdf::Joint::CONTINUOUS:
      return JointType::kContinuous;
    case urdf::Joint::PRISMATIC:
      return JointType::kPrismatic;
    case urdf::Joint::FLOATING:
      return JointType::kFloating;
    case urdf::Joint::PLANAR:
      return JointType::kPlanar;
    default:
      return JointType::kFixed;
  }
}

void UrdfParser::AddJoint(const urdf::Joint& source) {
  Joint joint;
  joint.name = source.name;
  joint.parent = source.parent_link_name;
  joint.child = source.child_link_name;
  joint.type = TypeOf(source);
  joint.parent_from_joint = ToIsometry(source.parent_to_joint_origin_transform);
  joint.axis = Eigen::Vector3d(source.axis.x, source.axis.y, source.axis.z).normalized();
  if (source.limits) {
    joint.lower = source.limits->lower;
    joint.upper = source.limits->upper;
    joint.effort = source.limits->effort;
    joint.velocity = source.limits->velocity;
  }
  if (source.dynamics) {
    joint.damping = source.dynamics->damping;
    joint.friction = source.dynamics->friction;
  }
  for (const double value : {joint.lower, joint.upper, joint.damping, joint.friction}) {
    if (std::isfinite(value)) continue;
    throw core::Error("a limit, damping or friction is not finite",
                      path_.string() + " joint '" + joint.name + "'");
  }
  if (joint.damping < 0.0 || joint.friction < 0.0) {
    throw core::Error("damping or friction is negative",
                      path_.string() + " joint '" + joint.name + "'", "both only resist motion");
  }
  if (source.mimic) {
    joint.mimic = {source.mimic->joint_name, source.mimic->multiplier, source.mimic->offset};
    model_.findings.push_back({"urdf-mimic", core::Severity::kInfo, path_.string(),
                               "joint '" + joint.name + "' follows '" + joint.mimic->joint + "'",
                               joint.mimic->multiplier});
  }
  model_.joints.push_back(std::move(joint));
}

UrdfModel UrdfParser::Read() {
  const std::string written = core::ReadFile(path_, kMaxUrdfBytes);
  if (written.find("<!DOCTYPE") == std::string::npos &&
      written.find("<!ENTITY") == std::string::npos) {
    RepairedUrdf mended = RepairUrdfText(written, path_.string());
    text_ = std::move(mended.text);
    model_.findings = std::move(mended.findings);
  } else {
    text_ = written;  // rejected below
  }
  RequireSafeUrdfText(text_, path_.string());
  urdf::ModelInterfaceSharedPtr parsed;
  {
    UrdfdomMessages heard;
    parsed = urdf::parseURDF(text_);
    if (!parsed || !parsed->getRoot()) {
      throw core::Error("this is not a valid URDF" +
                            (heard.messages.empty() ? "" : ": " + heard.messages.front()),
                        path_.string(), "correct the file accordingly");
    }
    for (const std::string& message : heard.messages) Warn("urdfdom", message);
  }
  model_.name = parsed->getName();
  // Breadth first from the root: parents before children, siblings by name.
  std::vector<urdf::LinkConstSharedPtr> queue{parsed->getRoot()};
  for (size_t i = 0; i < queue.size(); ++i) {
    AddLink(*queue[i]);
    std::vector<urdf::LinkSharedPtr> children = queue[i]->child_links;
    std::sort(children.begin(), children.end(),
              [](const auto& a, const auto& b) { return a->name < b->name; });
    for (const auto& child : children) {
      AddJoint(*child->parent_joint);
      queue.push_back(child);
    }
  }
  if (queue.size() != parsed->links_.size()) {
    throw core::Error("the joints form a loop", path_.string(), "a URDF is a tree of links");
  }
  ReadContacts(text_);
  RotateMeshesToZUp(&model_);
  return std::move(model_);
}

}  // namespace

UrdfModel ReadUrdf(const fs::path& path, const UrdfReadOptions& options) {
  return UrdfParser(path, options).Read();
}

}  // namespace simwright::assets
