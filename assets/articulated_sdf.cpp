#include "assets/articulated_sdf.h"

#include <tinyxml2.h>

#include "assets/articulated_writer.h"
#include "assets/collision_exclusion.h"
#include "assets/xml_element.h"

namespace simwright::assets {
namespace {

using Printer = tinyxml2::XMLPrinter;

void SdfLink(Printer* printer, const ArticulatedAsset& asset, const ArticulatedLink& link,
             const Joint* joint) {
  Element element(printer, "link");
  element.Set("name", link.name);
  if (joint != nullptr) {
    const Eigen::Vector3d p = joint->parent_from_joint.translation();
    const Eigen::Vector3d angles = joint->parent_from_joint.linear().eulerAngles(2, 1, 0);
    Element pose(printer, "pose");
    pose.Set("relative_to", joint->parent);
    pose.Text(Numbers({p.x(), p.y(), p.z(), angles[2], angles[1], angles[0]}));
  }
  SdfInertial(printer, link.inertial);
  for (const ColoredPiece& piece : ColoredPieces(link)) {
    // A colour would replace the texture that the mesh file names.
    const Eigen::Vector4f* color =
        piece.texture.empty() ? &piece.mesh.materials.front().base_color : nullptr;
    SdfVisual(printer, piece.stem, piece.stem + ".obj", color);
  }
  const HydroelasticContact contact = ContactOf(asset, link);
  for (size_t i = 0; i < link.parts.size(); ++i) {
    const std::string file = LinkCollisionFileName(link.name, static_cast<int>(i));
    SdfCollision(printer, file.substr(0, file.find('.')), file, contact);
  }
}

void SdfJoint(Printer* printer, const Joint& joint) {
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

}  // namespace

std::string ArticulatedSdfText(const ArticulatedAsset& asset) {
  Printer printer;
  printer.PushHeader(false, true);
  {
    Element sdf(&printer, "sdf");
    sdf.Set("version", "1.9").Set("xmlns:drake", kDrakeNamespace);
    Element model(&printer, "model");
    model.Set("name", asset.name);
    for (size_t i = 0; i < asset.links.size(); ++i) {
      SdfLink(&printer, asset, asset.links[i], i > 0 ? &asset.joints[i - 1] : nullptr);
    }
    if (asset.fixed) {
      Element held(&printer, "joint");
      held.Set("name", "held").Set("type", "fixed");
      Leaf(&printer, "parent", "world");
      Leaf(&printer, "child", asset.links.front().name);
    }
    for (const Joint& joint : asset.joints) SdfJoint(&printer, joint);
    SdfExclusions(&printer, asset);
  }
  return printer.CStr();
}

}  // namespace simwright::assets
