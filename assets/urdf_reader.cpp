#include "assets/urdf_reader.h"

#include <algorithm>
#include <cmath>

#include <console_bridge/console.h>
#include <tinyxml2.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include "assets/mesh_import.h"
#include "assets/primitive_meshes.h"
#include "assets/urdf_mesh_up.h"
#include "assets/urdf_sanity.h"
#include "core/error.h"
#include "core/files.h"

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

// Collects what urdfdom says, which it would print otherwise.
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

// urdfdom refuses a <limit> without effort or velocity, which PartNet-Mobility leaves out: they are
// given as 0, "none". The text as it is where nothing is missing.
std::string WithWholeLimits(const std::string& text) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return text;
  bool changed = false;
  auto* robot = document.FirstChildElement("robot");
  for (auto* joint = robot ? robot->FirstChildElement("joint") : nullptr; joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    auto* limit = joint->FirstChildElement("limit");
    if (limit == nullptr) continue;
    for (const char* name : {"effort", "velocity"}) {
      if (limit->Attribute(name) != nullptr) continue;
      limit->SetAttribute(name, "0");
      changed = true;
    }
  }
  if (!changed) return text;
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

class Reader {
 public:
  Reader(const fs::path& path, const UrdfReadOptions& options)
      : path_(path), folder_(fs::absolute(path).parent_path()), root_(options.root) {
    if (root_.empty()) root_ = folder_.filename() == "urdf" ? folder_.parent_path() : folder_;
  }
  UrdfModel Read();

 private:
  void Warn(const std::string& code, const std::string& sentence) {
    model_.findings.push_back({code, core::Severity::kWarning, path_.string(), sentence, 0.0});
  }
  void AddLink(const urdf::Link& link, const std::string& text);
  void AddJoint(const urdf::Joint& joint);
  void AddShape(const urdf::Geometry& geometry, const urdf::Pose& origin,
                const urdf::MaterialSharedPtr& material, std::vector<UrdfShape>* shapes);
  std::optional<fs::path> FindMesh(const std::string& name);
  void ReadContacts(const std::string& text);

  fs::path path_, folder_, root_;
  UrdfModel model_;
};

std::optional<fs::path> Reader::FindMesh(const std::string& name) {
  std::string relative = name;
  std::vector<fs::path> places{folder_};
  if (relative.starts_with("file://")) relative = relative.substr(7);
  if (relative.starts_with("package://")) {
    relative = relative.substr(10);
    const size_t slash = relative.find('/');
    const std::string package = relative.substr(0, slash);
    relative = slash == std::string::npos ? "" : relative.substr(slash + 1);
    for (fs::path place = folder_; place != place.root_path(); place = place.parent_path()) {
      places.push_back(place);
      places.push_back(place / package);
      if (place == root_) break;
    }
  }
  std::optional<fs::path> inside;
  for (const fs::path& place : places) {
    // Throws for a path that leaves the root: such a file is refused, not skipped.
    const fs::path candidate = core::ResolveInside(
        root_, fs::path(relative).is_absolute() ? fs::path(relative)
                                                : (place / relative).lexically_normal());
    if (fs::is_regular_file(candidate)) return candidate;
  }
  return std::nullopt;
}

void Reader::AddShape(const urdf::Geometry& geometry, const urdf::Pose& origin,
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
      const std::optional<fs::path> file = FindMesh(mesh.filename);
      if (!file) {
        Warn("urdf-missing-mesh", "the mesh '" + mesh.filename + "' is missing and left out");
        return;
      }
      try {
        if (file->extension() == ".obj") {
          shape.mesh = ReadBareObj(*file);
        } else {
          MeshFile read = ReadMeshFile(*file);
          shape.mesh = std::move(read.mesh.mesh);
          shape.up = read.up;
        }
      } catch (const core::Error& error) {
        Warn("urdf-unreadable-mesh", std::string("a mesh is left out: ") + error.what());
        return;
      }
      shape.file = file->string();
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

void Reader::AddLink(const urdf::Link& source, const std::string& where) {
  UrdfLink link;
  link.name = source.name;
  if (source.inertial) {
    const urdf::Inertial& from = *source.inertial;
    const Eigen::Isometry3d pose = ToIsometry(from.origin);
    Inertial inertial;
    inertial.mass = from.mass;
    inertial.center_of_mass = pose.translation();
    Eigen::Matrix3d local;
    local << from.ixx, from.ixy, from.ixz, from.ixy, from.iyy, from.iyz, from.ixz, from.iyz,
        from.izz;
    inertial.inertia = pose.linear() * local * pose.linear().transpose();
    RequirePhysical(inertial, where + " link '" + source.name + "'");
    link.inertial = inertial;
  } else if (!source.collision_array.empty() || !source.visual_array.empty()) {
    Warn("urdf-no-inertial", "link '" + source.name + "' has no inertial");
  }
  for (const auto& visual : source.visual_array) {
    if (!visual || !visual->geometry) continue;
    AddShape(*visual->geometry, visual->origin, visual->material, &link.visuals);
  }
  for (const auto& collision : source.collision_array) {
    if (collision && collision->geometry) {
      AddShape(*collision->geometry, collision->origin, nullptr, &link.collisions);
    }
  }
  model_.links.push_back(std::move(link));
}

// urdfdom does not hand on <contact>, so it is read from the text.
void Reader::ReadContacts(const std::string& text) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return;
  const auto* robot = document.FirstChildElement("robot");
  for (auto* link = robot ? robot->FirstChildElement("link") : nullptr; link != nullptr;
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

UrdfJointType TypeOf(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::REVOLUTE:
      return UrdfJointType::kRevolute;
    case urdf::Joint::CONTINUOUS:
      return UrdfJointType::kContinuous;
    case urdf::Joint::PRISMATIC:
      return UrdfJointType::kPrismatic;
    case urdf::Joint::FLOATING:
      return UrdfJointType::kFloating;
    case urdf::Joint::PLANAR:
      return UrdfJointType::kPlanar;
    default:
      return UrdfJointType::kFixed;
  }
}

void Reader::AddJoint(const urdf::Joint& source) {
  UrdfJoint joint;
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

UrdfModel Reader::Read() {
  const std::string text = core::ReadFile(path_, kMaxUrdfBytes);
  RequireHarmlessUrdfText(text, path_.string());
  urdf::ModelInterfaceSharedPtr parsed;
  {
    UrdfdomMessages heard;
    parsed = urdf::parseURDF(WithWholeLimits(text));
    if (!parsed || !parsed->getRoot()) {
      throw core::Error("this is not a valid URDF" +
                            (heard.messages.empty() ? "" : ": " + heard.messages.front()),
                        path_.string(), "mend the file as said");
    }
    for (const std::string& message : heard.messages) Warn("urdfdom", message);
  }
  model_.name = parsed->getName();
  // Breadth first from the root: parents before children, siblings by name.
  std::vector<urdf::LinkConstSharedPtr> queue{parsed->getRoot()};
  for (size_t i = 0; i < queue.size(); ++i) {
    AddLink(*queue[i], path_.string());
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
  ReadContacts(text);
  TurnMeshesUp(&model_);
  return std::move(model_);
}

}  // namespace

UrdfModel ReadUrdf(const fs::path& path, const UrdfReadOptions& options) {
  return Reader(path, options).Read();
}

}  // namespace simwright::assets
