#include "assets/articulated_writer.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <utility>

#include <tinyxml2.h>

#include "assets/collision_exclusion.h"
#include "assets/model_writer.h"
#include "assets/xml_element.h"
#include "core/error.h"

namespace simwright::assets {
namespace {

using Printer = tinyxml2::XMLPrinter;

constexpr struct {
  JointType type;
  const char* urdf;
  const char* semantics;
} kJointTypes[] = {
    {JointType::kFixed, "fixed", "fixed"},           {JointType::kRevolute, "revolute", "hinge"},
    {JointType::kContinuous, "continuous", "hinge"}, {JointType::kPrismatic, "prismatic", "slider"},
    {JointType::kFloating, "floating", "free"},      {JointType::kPlanar, "planar", "free"}};

void UrdfVisual(Printer* printer, const ColoredPiece& piece) {
  Element visual(printer, "visual");
  Element(printer, "origin").Set("xyz", "0 0 0").Set("rpy", "0 0 0");
  {
    Element geometry(printer, "geometry");
    Element(printer, "mesh").Set("filename", piece.stem + ".obj");
  }
  // A colour would replace the texture that the mesh file names.
  if (!piece.texture.empty()) return;
  const Eigen::Vector4f& c = piece.mesh.materials.front().base_color;
  Element material(printer, "material");
  material.Set("name", piece.stem);
  Element(printer, "color").Set("rgba", Numbers({c.x(), c.y(), c.z(), c.w()}));
}

void UrdfLinkElement(Printer* printer, const ArticulatedAsset& asset, const ArticulatedLink& link) {
  Element element(printer, "link");
  element.Set("name", link.name);
  UrdfInertial(printer, link.inertial);
  for (const ColoredPiece& piece : ColoredPieces(link)) UrdfVisual(printer, piece);
  const HydroelasticContact contact = ContactOf(asset, link);
  for (size_t i = 0; i < link.parts.size(); ++i) {
    UrdfCollision(printer, LinkCollisionFileName(link.name, static_cast<int>(i)), contact);
  }
  UrdfContact(printer, link.friction, 0.0, link.restitution);
}

void UrdfJointElement(Printer* printer, const Joint& joint) {
  Element element(printer, "joint");
  element.Set("name", joint.name).Set("type", JointTypeName(joint.type));
  Element(printer, "parent").Set("link", joint.parent);
  Element(printer, "child").Set("link", joint.child);
  const Eigen::Vector3d angles = joint.parent_from_joint.linear().eulerAngles(2, 1, 0);
  Element(printer, "origin")
      .Set("xyz", Numbers(Eigen::Vector3d(joint.parent_from_joint.translation())))
      .Set("rpy", Numbers({angles[2], angles[1], angles[0]}));
  if (!joint.Moves()) return;
  Element(printer, "axis").Set("xyz", Numbers(joint.axis));
  Element(printer, "dynamics")
      .Set("damping", Number(joint.damping))
      .Set("friction", Number(joint.friction));
  Element(printer, "limit")
      .Set("lower", Number(joint.lower))
      .Set("upper", Number(joint.upper))
      .Set("effort", Number(joint.effort))
      .Set("velocity", Number(joint.velocity));
}

std::string MeshName(const std::string& asset, const std::string& file) {
  return asset + "_" + file.substr(0, file.find('.'));
}

// Declares a texture and the material that shows it, both by the texture's name.
void MjcfTexture(Printer* printer, const std::string& asset, const std::string& file) {
  const std::string name = MeshName(asset, file);
  Element(printer, "texture").Set("name", name).Set("type", "2d").Set("file", file);
  Element(printer, "material").Set("name", name).Set("texture", name);
}

void MjcfMeshes(Printer* printer, const ArticulatedAsset& asset) {
  Element assets(printer, "asset");
  std::set<std::string> textures;
  const auto add = [&](const std::string& file) {
    Element(printer, "mesh").Set("name", MeshName(asset.name, file)).Set("file", file);
  };
  for (const ArticulatedLink& link : asset.links) {
    for (const ColoredPiece& piece : ColoredPieces(link)) {
      if (!VisualSuitsMujoco(piece.mesh.mesh)) continue;
      if (!piece.texture.empty() && textures.insert(piece.texture).second) {
        MjcfTexture(printer, asset.name, piece.texture);
      }
      add(piece.stem + ".obj");
    }
    for (size_t i = 0; i < link.parts.size(); ++i) {
      add(LinkCollisionFileName(link.name, static_cast<int>(i)));
    }
  }
}

void MjcfGeoms(Printer* printer, const std::string& asset, const ArticulatedLink& link) {
  for (const ColoredPiece& piece : ColoredPieces(link)) {
    if (!VisualSuitsMujoco(piece.mesh.mesh)) continue;
    Element geom(printer, "geom");
    geom.Set("type", "mesh")
        .Set("mesh", MeshName(asset, piece.stem))
        .Set("contype", "0")
        .Set("conaffinity", "0")
        .Set("group", "2");
    if (!piece.texture.empty()) {
      geom.Set("material", MeshName(asset, piece.texture));
      continue;
    }
    const Eigen::Vector4f& c = piece.mesh.materials.front().base_color;
    geom.Set("rgba", Numbers({c.x(), c.y(), c.z(), c.w()}));
  }
  for (size_t i = 0; i < link.parts.size(); ++i) {
    const std::string file = LinkCollisionFileName(link.name, static_cast<int>(i));
    Element(printer, "geom")
        .Set("type", "mesh")
        .Set("mesh", MeshName(asset, file))
        .Set("group", "3")
        .Set("condim", "4")
        .Set("friction", Numbers({link.friction, 0.005, 0.0001}))
        .Set("solref", Numbers({0.005, DampingRatio(link.restitution)}));
  }
}

void MjcfJoint(Printer* printer, const Joint& joint) {
  const bool slides = joint.type == JointType::kPrismatic;
  Element(printer, "joint")
      .Set("name", joint.name)
      .Set("type", slides ? "slide" : "hinge")
      .Set("pos", "0 0 0")
      .Set("axis", Numbers(joint.axis))
      .Set("limited", joint.type == JointType::kContinuous ? "false" : "true")
      .Set("range", Numbers({joint.lower, joint.upper}))
      .Set("damping", Number(joint.damping))
      .Set("frictionloss", Number(joint.friction))
      // MuJoCo's friction is a soft constraint: with the default impedance of 0.9 and 0.02 s a lid
      // of g / l = 40 / s^2 creeps by 0.04 rad/s. The stiffest permitted values reduce that to
      // 1e-5.
      .Set("solreffriction", "0.004 1")
      .Set("solimpfriction", "0.9999 0.9999 0.001 0.5 2");
}

void MjcfBodies(Printer* printer, const ArticulatedAsset& asset, size_t link) {
  Element body(printer, "body");
  body.Set("name", asset.links[link].name);
  if (link > 0) {
    const Joint& joint = asset.joints[link - 1];
    const Eigen::Quaterniond q(joint.parent_from_joint.linear());
    body.Set("pos", Numbers(Eigen::Vector3d(joint.parent_from_joint.translation())))
        .Set("quat", Numbers({q.w(), q.x(), q.y(), q.z()}));
    if (joint.Moves()) MjcfJoint(printer, joint);
  } else if (!asset.fixed) {
    Element(printer, "freejoint").Set("name", asset.name + "_free");
  }
  MjcfInertial(printer, asset.links[link].inertial);
  MjcfGeoms(printer, asset.name, asset.links[link]);
  for (size_t i = 0; i < asset.joints.size(); ++i) {
    if (asset.joints[i].parent == asset.links[link].name) MjcfBodies(printer, asset, i + 1);
  }
}

// Returns the triangles of one material with that material alone, and its texture if it has one.
core::TexturedMesh PieceOfMaterial(const core::TexturedMesh& visual, int m) {
  core::TexturedMesh piece;
  core::Material material = visual.materials[static_cast<size_t>(m)];
  const bool textured = material.texture >= 0 && !visual.corner_uvs.empty();
  std::vector<int> index_of(visual.mesh.vertices.size(), -1);
  for (size_t t = 0; t < visual.mesh.triangles.size(); ++t) {
    if (visual.triangle_material[t] != m) continue;
    Eigen::Vector3i triangle = visual.mesh.triangles[t];
    for (int& corner : triangle) {
      int& index = index_of[static_cast<size_t>(corner)];
      if (index < 0) {
        index = static_cast<int>(piece.mesh.vertices.size());
        piece.mesh.vertices.push_back(visual.mesh.vertices[static_cast<size_t>(corner)]);
      }
      corner = index;
    }
    piece.mesh.triangles.push_back(triangle);
    for (size_t k = 0; textured && k < 3; ++k) {
      piece.corner_uvs.push_back(visual.corner_uvs[3 * t + k]);
    }
  }
  if (textured) piece.textures = {visual.textures[static_cast<size_t>(material.texture)]};
  material.texture = textured ? 0 : -1;
  piece.triangle_material.assign(piece.mesh.triangles.size(), 0);
  piece.materials = {material};
  return piece;
}

// Returns "texture_3fa91c0277d1.png" from a hash of the pixels (FNV-1a).
std::string TextureNameOf(const core::Image& texture) {
  std::uint64_t hash = 14695981039346656037ull;
  for (const std::uint8_t byte : texture.pixels) hash = (hash ^ byte) * 1099511628211ull;
  char name[48];
  std::snprintf(name, sizeof(name), "texture_%012llx.png",
                static_cast<unsigned long long>(hash >> 16));
  return name;
}

}  // namespace

std::vector<ColoredPiece> ColoredPieces(const ArticulatedLink& link) {
  std::vector<ColoredPiece> pieces;
  for (size_t m = 0; m < link.visual.materials.size(); ++m) {
    core::TexturedMesh mesh = PieceOfMaterial(link.visual, static_cast<int>(m));
    if (mesh.mesh.empty()) continue;
    char number[32];
    std::snprintf(number, sizeof(number), "_visual_%03zu", m);
    std::string texture = mesh.textures.empty() ? "" : TextureNameOf(mesh.textures.front());
    pieces.push_back({link.name + number, std::move(mesh), std::move(texture)});
  }
  return pieces;
}

HydroelasticContact ContactOf(const ArticulatedAsset& asset, const ArticulatedLink& link) {
  double mass = 0.0;  // any link may bear the whole weight
  for (const ArticulatedLink& one : asset.links) mass += one.inertial.mass;
  Eigen::AlignedBox3d bounds;
  for (const core::TriangleMesh& part : link.parts) bounds.extend(core::Bounds(part));
  const Eigen::Vector3d extents =
      bounds.isEmpty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(bounds.sizes());
  return HydroelasticContactOf(link.material, mass, extents, link.friction);
}

std::string LinkCollisionFileName(const std::string& link, int part) {
  return link + "_" + CollisionFileName(part);
}

std::string ArticulatedUrdfText(const ArticulatedAsset& asset) {
  Printer printer;
  printer.PushHeader(false, true);
  {
    Element robot(&printer, "robot");
    robot.Set("name", asset.name).Set("xmlns:drake", kDrakeNamespace);
    for (const ArticulatedLink& link : asset.links) UrdfLinkElement(&printer, asset, link);
    for (const Joint& joint : asset.joints) UrdfJointElement(&printer, joint);
    UrdfExclusions(&printer, asset);
  }
  return printer.CStr();
}

std::string ArticulatedMjcfText(const ArticulatedAsset& asset) {
  Printer printer;
  {
    Element mujoco(&printer, "mujoco");
    mujoco.Set("model", asset.name);
    Element(&printer, "compiler").Set("angle", "radian");
    MjcfMeshes(&printer, asset);
    MjcfExclusions(&printer, asset);
    Element worldbody(&printer, "worldbody");
    MjcfBodies(&printer, asset, 0);
  }
  return printer.CStr();
}

std::string SemanticsKind(JointType type) {
  for (const auto& row : kJointTypes) {
    if (row.type == type) return row.semantics;
  }
  return "fixed";
}

std::string JointTypeName(JointType type) {
  for (const auto& row : kJointTypes) {
    if (row.type == type) return row.urdf;
  }
  return "fixed";
}

JointType JointTypeNamed(const std::string& name) {
  for (const auto& row : kJointTypes) {
    if (row.urdf == name) return row.type;
  }
  throw core::Error("is not a joint type", name, "fixed, revolute, continuous, prismatic");
}

std::string SemanticsText(const ArticulatedAsset& asset) {
  std::string text;
  for (size_t i = 0; i < asset.links.size(); ++i) {
    const std::string kind = i > 0         ? SemanticsKind(asset.joints[i - 1].type)
                             : asset.fixed ? "static"
                                           : "free";
    text += asset.links[i].name + " " + kind + " " + asset.links[i].label + "\n";
  }
  return text;
}

}  // namespace simwright::assets
