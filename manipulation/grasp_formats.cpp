#include "manipulation/grasp_formats.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>
#include <vector>

#include "assets/usd_prim.h"
#include "core/error.h"
#include "core/files.h"
#include "core/hdf5.h"

namespace simwright::manipulation {
namespace fs = std::filesystem;
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

struct GraspFormatRow {
  GraspFormat format;
  const char* name;
  std::vector<const char*> extensions;
};

const std::vector<GraspFormatRow>& GraspFormatRows() {
  static const std::vector<GraspFormatRow> rows = {
      {GraspFormat::kJson, "json", {".json"}},
      {GraspFormat::kIsaac, "isaac", {".yaml", ".yml"}},
      {GraspFormat::kAcronym, "acronym", {".h5", ".hdf5"}},
      {GraspFormat::kMjcf, "mjcf", {".xml"}},
      {GraspFormat::kUsd, "usd", {".usda"}}};
  return rows;
}

std::string NumberText(double value) {
  char text[40];
  std::snprintf(text, sizeof(text), "%.9g", value);
  return text;
}

std::string Joined(const std::vector<double>& values, const char* separator) {
  std::string text;
  for (const double value : values) {
    if (!text.empty()) text += separator;
    text += NumberText(value);
  }
  return text;
}

std::string GraspName(size_t index) {
  return "grasp_" + std::to_string(index);
}

// Returns a quaternion with w >= 0.
Eigen::Quaterniond Rotation(const Isometry3d& pose) {
  Eigen::Quaterniond rotation(pose.linear());
  rotation.normalize();
  if (rotation.w() < 0.0) rotation.coeffs() *= -1.0;
  return rotation;
}

// Returns the polyline of a gripper in the tool frame: a fingertip, the palm and the other one.
std::array<Vector3d, 4> GraspGlyph(double opening) {
  const double half = 0.5 * opening, back = -0.045;
  return {Vector3d(0, -half, 0), Vector3d(0, -half, back), Vector3d(0, half, back),
          Vector3d(0, half, 0)};
}

// Returns the link or object in whose frame all grasps of a file are.
std::string FrameName(const GraspSet& set) {
  const std::vector<std::string> links = GraspedLinks(set);
  return links.empty() ? set.object : links.front();
}

// Returns the grasps of one link, with their places in `set`: all for "".
std::vector<std::pair<size_t, const Grasp*>> AtLink(const GraspSet& set, const std::string& link) {
  std::vector<std::pair<size_t, const Grasp*>> grasps;
  for (size_t i = 0; i < set.grasps.size(); ++i) {
    if (set.grasps[i].link == link) grasps.emplace_back(i, &set.grasps[i]);
  }
  return grasps;
}

// Returns the links of a set, or "" for a rigid asset.
std::vector<std::string> LinksOrNone(const GraspSet& set) {
  std::vector<std::string> links = GraspedLinks(set);
  if (links.empty()) links.emplace_back();
  return links;
}

void WriteAcronym(const GraspSet& set, const assets::Inertial& inertial, const fs::path& file) {
  std::vector<double> transforms, quality;
  std::vector<std::uint8_t> held;
  std::vector<std::string> joints;
  for (const Grasp& grasp : set.grasps) {
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix = GraspGenPose(set, grasp).matrix();
    transforms.insert(transforms.end(), matrix.data(), matrix.data() + 16);
    quality.push_back(grasp.quality);
    held.push_back(1);
    joints.push_back(grasp.joint);
  }
  core::Hdf5Writer writer(file);
  core::Hdf5Group object = writer.root().Create("object");
  object.WriteText("file", set.mesh);
  const double scale = 1.0;
  object.Write("scale", {}, &scale);
  object.Write("mass", {}, &inertial.mass);
  object.Write("com", {3}, inertial.center_of_mass.data());
  const Eigen::Matrix3d inertia = inertial.inertia;  // symmetric
  object.Write("inertia", {3, 3}, inertia.data());
  object.Write("friction", {}, &set.friction);
  if (!GraspedLinks(set).empty()) {
    object.WriteText("link", FrameName(set));
  }
  core::Hdf5Group gripper = writer.root().Create("gripper");
  gripper.WriteText("type", set.gripper);
  const std::vector<double> open(set.joints.size(), 0.5 * set.max_opening);
  gripper.Write("configuration", {open.size()}, open.data());
  const size_t count = set.grasps.size();
  core::Hdf5Group grasps = writer.root().Create("grasps");
  grasps.Write("transforms", {count, 4, 4}, transforms.data());
  if (!GraspedLinks(set).empty()) grasps.WriteTexts("joint", joints);
  core::Hdf5Group qualities = grasps.Create("qualities");
  qualities.Create("flex").Write("object_in_gripper", {count}, held.data());
  qualities.Create("simwright").Write("perturbed", {count}, quality.data());
  writer.Commit();
}

assets::UsdPrim UsdGrasp(const Grasp& grasp, size_t index) {
  assets::UsdPrim one("Xform", GraspName(index));
  one.Place(grasp.object_from_tool);
  if (!grasp.joint.empty()) {
    one.Set("custom string simwright:joint", assets::UsdString(grasp.joint));
  }
  one.Set("custom double simwright:quality", assets::UsdDouble(grasp.quality));
  one.Set("custom double simwright:width", assets::UsdDouble(grasp.width));
  one.Set("custom double simwright:opening", assets::UsdDouble(grasp.opening));
  assets::UsdPrim curve("BasisCurves", "gripper");
  std::string points;
  for (const Vector3d& point : GraspGlyph(grasp.opening)) {
    points += (points.empty() ? "" : ", ") + assets::UsdFloats(point);
  }
  curve.Set("uniform token type", "\"linear\"");
  curve.Set("int[] curveVertexCounts", "[4]");
  curve.Set("point3f[] points", "[" + points + "]");
  curve.Set("float[] widths", "[0.002]");
  curve.Set("color3f[] primvars:displayColor",
            "[" + assets::UsdFloats(Vector3d(1.0 - grasp.quality, grasp.quality, 0.1)) + "]");
  curve.Set("uniform token purpose", "\"guide\"");
  one.Add(std::move(curve));
  return one;
}

}  // namespace

GraspFormat GraspFormatOf(const std::string& name, const fs::path& file) {
  for (const GraspFormatRow& row : GraspFormatRows()) {
    const auto matches = [&](const char* extension) { return file.extension() == extension; };
    const bool ends = std::any_of(row.extensions.begin(), row.extensions.end(), matches);
    if (name.empty() ? ends : name == row.name) {
      if (ends || file.empty()) return row.format;
      throw core::Error("does not end as files of the format " + name + " do", file.string(),
                        std::string("let it end in ") + row.extensions.front());
    }
  }
  throw core::Error("is no format of grasps", name.empty() ? file.string() : name,
                    "give --format json, isaac, acronym, mjcf or usd, or a file that ends in "
                    ".json, .yaml, .h5, .xml or .usda");
}

std::string GraspExtension(GraspFormat format) {
  for (const GraspFormatRow& row : GraspFormatRows()) {
    if (row.format == format) return row.extensions.front();
  }
  return "";
}

std::string IsaacGraspText(const GraspSet& set) {
  std::string text = "format: isaac_grasp\nformat_version: 1.0\n\nobject_frame_link: \"" +
                     FrameName(set) + "\"\ngripper_frame_link: \"" + set.base_link +
                     "\"\n\ngrasps:\n";
  for (size_t i = 0; i < set.grasps.size(); ++i) {
    const Grasp& grasp = set.grasps[i];
    const Isometry3d base = BaseLinkPose(set, grasp);
    const Eigen::Quaterniond turn = Rotation(base);
    const Vector3d& at = base.translation();
    text += "  \"" + GraspName(i) + "\":\n    confidence: " + NumberText(grasp.quality);
    text += "\n    position: [" + Joined({at.x(), at.y(), at.z()}, ", ") + "]";
    text += "\n    orientation: {w: " + NumberText(turn.w()) + ", xyz: [" +
            Joined({turn.x(), turn.y(), turn.z()}, ", ") + "]}\n";
    for (const bool closed : {true, false}) {
      text += closed ? "    cspace_position:\n" : "    pregrasp_cspace_position:\n";
      const double opening = closed ? grasp.width : grasp.opening;
      for (const auto& joint : set.joints) {
        const double position = joint.open + joint.closing * 0.5 * (set.max_opening - opening);
        text += "      " + joint.name + ": " + NumberText(position) + "\n";
      }
    }
  }
  return text;
}

std::string MjcfGraspText(const GraspSet& set) {
  std::string text = "<mujoco model=\"" + set.object + "_grasps\">\n  <worldbody>\n";
  for (const std::string& link : LinksOrNone(set)) {
    text += "    <body name=\"" + set.object + (link.empty() ? "" : "_" + link) + "_grasps\">\n";
    for (const auto& [i, grasp] : AtLink(set, link)) {
      const Eigen::Quaterniond turn = Rotation(grasp->object_from_tool);
      const Vector3d at = grasp->object_from_tool.translation();
      text += "      <site name=\"" + GraspName(i) + "\" type=\"box\" size=\"" +
              Joined({0.002, 0.5 * grasp->width, 0.002}, " ") + "\" pos=\"" +
              Joined({at.x(), at.y(), at.z()}, " ") + "\" quat=\"" +
              Joined({turn.w(), turn.x(), turn.y(), turn.z()}, " ") + "\" rgba=\"" +
              Joined({1.0 - grasp->quality, grasp->quality, 0.1, 1.0}, " ") + "\" group=\"4\"/>\n";
    }
    text += "    </body>\n";
  }
  return text + "  </worldbody>\n</mujoco>\n";
}

std::string UsdGraspText(const GraspSet& set) {
  assets::UsdNames names;
  assets::UsdPrim root("Scope", names.Unique(set.object + "_grasps"));
  root.Set("custom string simwright:object", assets::UsdString(set.object));
  root.Set("custom string simwright:gripper", assets::UsdString(set.gripper));
  const std::vector<std::string> links = GraspedLinks(set);
  for (const std::string& link : links) {
    assets::UsdPrim scope("Scope", names.Unique(link));
    scope.Set("custom string simwright:link", assets::UsdString(link));
    for (const auto& [i, grasp] : AtLink(set, link)) scope.Add(UsdGrasp(*grasp, i));
    root.Add(std::move(scope));
  }
  if (links.empty()) {
    for (const auto& [i, grasp] : AtLink(set, "")) root.Add(UsdGrasp(*grasp, i));
  }
  return assets::UsdLayerText(root, "Grasps of " + set.object + " by the gripper " + set.gripper +
                                        ": each prim is the tool frame, z along the approach, y "
                                        "from finger to finger");
}

std::vector<fs::path> GraspFiles(GraspFormat format, const fs::path& file,
                                 const std::vector<std::string>& links) {
  const bool one_frame = format == GraspFormat::kIsaac || format == GraspFormat::kAcronym;
  if (links.empty() || !one_frame) return {file};
  std::vector<fs::path> files;
  for (const std::string& link : links) {
    files.push_back(file.parent_path() /
                    (file.stem().string() + "_" + link + file.extension().string()));
  }
  return files;
}

std::vector<fs::path> WriteGrasps(const GraspSet& set, const GraspInertials& inertials,
                                  GraspFormat format, const fs::path& file) {
  const std::vector<std::string> links = GraspedLinks(set);
  const std::vector<fs::path> files = GraspFiles(format, file, links);
  if (format == GraspFormat::kJson) core::WriteFile(file, core::JsonText(GraspSetJson(set)));
  if (format == GraspFormat::kMjcf) core::WriteFile(file, MjcfGraspText(set));
  if (format == GraspFormat::kUsd) core::WriteFile(file, UsdGraspText(set));
  if (format != GraspFormat::kIsaac && format != GraspFormat::kAcronym) return files;
  for (size_t i = 0; i < files.size(); ++i) {
    const std::string link = links.empty() ? "" : links[i];
    GraspSet some = set;
    some.grasps.clear();
    for (const auto& [place, grasp] : AtLink(set, link)) some.grasps.push_back(*grasp);
    if (format == GraspFormat::kIsaac) {
      core::WriteFile(files[i], IsaacGraspText(some));
      continue;
    }
    const auto inertial = inertials.find(link);
    if (inertial == inertials.end()) {
      throw core::Error("has no inertial of the link " + link, set.object);
    }
    WriteAcronym(some, inertial->second, files[i]);
  }
  return files;
}

}  // namespace simwright::manipulation
