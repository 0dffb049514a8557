#include <tinyxml2.h>

#include "assets/articulated_writer.h"
#include "assets/tree_world.h"
#include "assets/world_writer.h"
#include "assets/xml_element.h"

namespace simwright::assets {
namespace {

constexpr const char* kTreeVisual = "visual";

std::string SdfPoseNumbers(const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d p = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  return Numbers({p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
}

// Writes a pose with a quaternion, which keeps all digits near gimbal lock.
void SdfPoseElement(tinyxml2::XMLPrinter* printer, const Eigen::Isometry3d& pose,
                    const std::string& relative_to) {
  Element element(printer, "pose");
  if (!relative_to.empty()) element.Set("relative_to", relative_to);
  element.Set("rotation_format", "quat_xyzw");
  element.Text(SdfPoseNumbers(pose));
}

// Writes a capsule, whose axis is z in SDF.
void SdfCapsule(tinyxml2::XMLPrinter* printer, const TreeShape& shape, double friction) {
  const TreeCapsule& capsule = *shape.capsule;
  Element collision(printer, "collision");
  collision.Set("name", shape.name);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = 0.5 * (capsule.a + capsule.b);
  const Eigen::Vector3d axis = capsule.b - capsule.a;
  const bool sphere = axis.norm() < 1e-9;
  if (!sphere) {
    pose.linear() =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
  }
  SdfPoseElement(printer, pose, "");
  {
    Element geometry(printer, "geometry");
    Element form(printer, sphere ? "sphere" : "capsule");
    Leaf(printer, "radius", Number(capsule.radius));
    if (!sphere) Leaf(printer, "length", Number(axis.norm()));
  }
  SdfSurface(printer, friction);
}

void SdfTreeLink(tinyxml2::XMLPrinter* printer, const TreeBody& body, size_t index) {
  const KinematicLink& link = body.kinematics->links()[index];
  const TreeLink& shapes = body.links[index];
  Element element(printer, "link");
  element.Set("name", link.name);
  if (index > 0) {
    const Joint& joint = body.kinematics->joints()[index - 1];
    SdfPoseElement(printer, joint.parent_from_joint, joint.parent);
  }
  if (link.inertial.mass > 0.0) SdfInertial(printer, TreeInertial(link.inertial));
  for (const TreeShape& shape : shapes.visuals) {
    Element visual(printer, kTreeVisual);
    visual.Set("name", shape.name);
    {
      Element geometry(printer, "geometry");
      Element mesh(printer, "mesh");
      Leaf(printer, "uri", shape.file);
    }
    Element material(printer, "material");
    Leaf(printer, "diffuse",
         Numbers({shape.color.x(), shape.color.y(), shape.color.z(), shape.color.w()}));
  }
  HydroelasticContact contact;
  contact.friction = shapes.friction;
  for (const TreeShape& shape : shapes.collisions) {
    if (shape.capsule) {
      SdfCapsule(printer, shape, shapes.friction);
    } else {
      SdfCollision(printer, shape.name, shape.file, contact);
    }
  }
}

void SdfTreeJoint(tinyxml2::XMLPrinter* printer, const Joint& joint) {
  Element element(printer, "joint");
  element.Set("name", joint.name).Set("type", JointTypeName(joint.type));
  Leaf(printer, "parent", joint.parent);
  Leaf(printer, "child", joint.child);
  if (!joint.Moves()) return;
  Element axis(printer, "axis");
  Leaf(printer, "xyz", Numbers(joint.axis));
  {
    Element limit(printer, "limit");
    if (joint.type != JointType::kContinuous) {
      Leaf(printer, "lower", Number(joint.lower));
      Leaf(printer, "upper", Number(joint.upper));
    }
    Leaf(printer, "effort", Number(joint.effort));
    Leaf(printer, "velocity", Number(joint.velocity));
  }
  Element dynamics(printer, "dynamics");
  Leaf(printer, "damping", Number(joint.damping));
  Leaf(printer, "friction", Number(joint.friction));
}

// `placed`: writes the pose, and attaches a fixed root to the world.
void SdfTreeModel(tinyxml2::XMLPrinter* printer, const TreeBody& body, bool placed) {
  Element model(printer, "model");
  model.Set("name", body.name);
  if (placed) SdfPoseElement(printer, body.world_from_root, "");
  for (size_t l = 0; l < body.links.size(); ++l) SdfTreeLink(printer, body, l);
  if (placed && body.fixed) {
    Element held(printer, "joint");
    held.Set("name", "held").Set("type", "fixed");
    Leaf(printer, "parent", "world");
    Leaf(printer, "child", body.kinematics->links().front().name);
  }
  for (const Joint& joint : body.kinematics->joints()) SdfTreeJoint(printer, joint);
}

}  // namespace

std::string TreeWorldSdf(const std::string& name, const std::vector<TreeBody>& bodies) {
  tinyxml2::XMLPrinter printer;
  printer.PushHeader(false, true);
  {
    Element sdf(&printer, "sdf");
    sdf.Set("version", "1.9").Set("xmlns:drake", kDrakeNamespace);
    Element world(&printer, "world");
    world.Set("name", name);
    SdfGround(&printer);
    for (const TreeBody& body : bodies) SdfTreeModel(&printer, body, true);
  }
  return printer.CStr();
}

std::string TreeModelSdf(const TreeBody& body) {
  tinyxml2::XMLPrinter printer;
  printer.PushHeader(false, true);
  {
    Element sdf(&printer, "sdf");
    sdf.Set("version", "1.9").Set("xmlns:drake", kDrakeNamespace);
    SdfTreeModel(&printer, body, false);
  }
  return printer.CStr();
}

}  // namespace simwright::assets
