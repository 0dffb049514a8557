#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <Eigen/Core>

#include "assets/obj_file.h"
#include "assets/primitive_meshes.h"

namespace simwright {

// A cabinet in PartNet-Mobility's layout: y up, front to +z, 1.2 units high; a door on the lower
// left, a drawer above, each with a bar handle. All meshes are in one frame, so that their origins
// are the negated origins of the joints. A mesh of the door is missing. The door's rear face lies
// 0.002 units inside the body.
class PartnetCabinet {
 public:
  explicit PartnetCabinet(const std::filesystem::path& folder) : folder_(folder) {
    std::filesystem::create_directories(folder / "textured_objs");
  }

  // link_0: door, link_1: drawer, link_2: body, and for GAPartNet link_3: the door's handle.
  void Write(bool gapartnet) {
    const std::string body =
        Box("b0", {-.5, -.6, -.4}, {.5, -.55, .4}) + Box("b1", {-.5, .57, -.4}, {.5, .6, .4}) +
        Box("b2", {-.5, -.55, -.4}, {-.47, .57, .4}) + Box("b3", {.47, -.55, -.4}, {.5, .57, .4}) +
        Box("b4", {-.47, -.55, -.4}, {.47, .57, -.37}) +
        Box("b5", {-.47, .10, -.37}, {.47, .13, .4});
    const Eigen::Vector3d hinge(-.5, 0, .4), slide(0, .33, .44);
    const std::string handle = Box("h0", {.40, -.3, .48}, {.42, -.1, .50}, hinge) +
                               Box("h1", {.40, -.3, .44}, {.42, -.28, .48}, hinge) +
                               Box("h2", {.40, -.12, .44}, {.42, -.1, .48}, hinge);
    std::string door =
        Box("d0", {-.5, -.54, .398}, {.49, .09, .44}, hinge) + Visual("not_there", hinge);
    if (!gapartnet) door += handle;
    const std::string drawer = Box("w0", {-.49, .12, .41}, {.49, .55, .44}, slide) +
                               Box("w1", {-.44, .16, -.3}, {.44, .18, .41}, slide) +
                               Box("w2", {-.44, .18, -.3}, {-.42, .45, .41}, slide) +
                               Box("w3", {.42, .18, -.3}, {.44, .45, .41}, slide) +
                               Box("w4", {-.42, .18, -.3}, {.42, .45, -.28}, slide) +
                               Box("w5", {-.1, .33, .47}, {.1, .35, .49}, slide) +
                               Box("w6", {-.1, .33, .44}, {-.08, .35, .47}, slide) +
                               Box("w7", {.08, .33, .44}, {.1, .35, .47}, slide);
    std::string urdf =
        "<?xml version=\"1.0\" ?>\n<robot name=\"partnet_1\">\n<link name=\"base\"/>";
    urdf += "<link name=\"link_0\">" + door + "</link><link name=\"link_1\">" + drawer +
            "</link><link name=\"link_2\">" + body + "</link>";
    if (gapartnet) urdf += "<link name=\"link_3\">" + handle + "</link>";
    urdf += Joint("joint_0", "revolute", "link_2", "link_0", hinge,
                  "<axis xyz=\"0 -1 0\"/><limit lower=\"0\" upper=\"1.5707963267948966\"/>");
    urdf += Joint("joint_1", "prismatic", "link_2", "link_1", slide,
                  "<axis xyz=\"0 0 1\"/><limit lower=\"0\" upper=\"0.48\"/>");
    urdf +=
        "<joint name=\"joint_2\" type=\"fixed\">"
        "<origin rpy=\"1.570796326794897 0 -1.570796326794897\" xyz=\"0 0 0\"/>"
        "<child link=\"link_2\"/><parent link=\"base\"/></joint>";
    if (gapartnet) urdf += Joint("joint_3", "fixed", "link_0", "link_3", {0, 0, 0}, "");
    WriteText(gapartnet ? "mobility_annotation_gapartnet.urdf" : "mobility.urdf",
              urdf + "</robot>\n");
    WriteText("meta.json", "{\"model_cat\": \"StorageFurniture\", \"anno_id\": \"1\"}");
    WriteText("bounding_box.json", "{\"min\": [-0.5, -0.6, -0.4], \"max\": [0.5, 0.6, 0.5]}");
    if (gapartnet) {
      WriteText("semantics_gapartnet.txt",
                "link_0 hinge hinge_door\nlink_1 slider slider_drawer\nlink_2 heavy body\n"
                "link_3 fixed line_fixed_handle\n");
    } else {
      WriteText("semantics.txt",
                "link_0 hinge door\nlink_1 slider drawer\nlink_2 heavy furniture_body\n");
    }
  }

  // Where a point of the files lands in the asset's root frame, the height being `height` m: the
  // turn of "base" takes (x, y, z) to (-z, -x, y); the whole spans y in [-0.6, 0.6], z in [-0.4,
  // 0.5].
  static Eigen::Vector3d InRoot(const Eigen::Vector3d& p, double height) {
    return height / 1.2 * Eigen::Vector3d(-p.z() + 0.05, -p.x(), p.y() + 0.6);
  }

  // A point of the door (in the files' frame) after it was opened by `angle`.
  static Eigen::Vector3d OnDoor(const Eigen::Vector3d& p, double angle) {
    const double x = p.x() + 0.5, z = p.z() - 0.4;
    return {x * std::cos(angle) - z * std::sin(angle) - 0.5, p.y(),
            x * std::sin(angle) + z * std::cos(angle) + 0.4};
  }

  void WriteText(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

 private:
  std::string Visual(const std::string& name, const Eigen::Vector3d& joint) const {
    const std::string shape = "<origin xyz=\"" + Text(-joint) +
                              "\"/><geometry><mesh filename=\"textured_objs/" + name +
                              ".obj\"/></geometry>";
    return "<visual name=\"board-1\">" + shape + "</visual><collision>" + shape + "</collision>";
  }
  std::string Box(const std::string& name, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                  const Eigen::Vector3d& joint = Eigen::Vector3d::Zero()) const {
    core::TriangleMesh mesh = assets::BoxMesh(high - low);
    core::Transform(Eigen::Affine3d(Eigen::Translation3d(0.5 * (low + high))), &mesh);
    std::ofstream(folder_ / "textured_objs" / (name + ".mtl"))
        << "newmtl wood\nKd 0.6 0.4 0.2\nnewmtl metal\nKd 0.7 0.7 0.7\n";
    const bool metal = name[0] == 'h' || name > "w4";
    std::ofstream(folder_ / "textured_objs" / (name + ".obj"))
        << "mtllib " << name << ".mtl\nusemtl " << (metal ? "metal" : "wood") << "\n"
        << assets::ObjText(mesh);
    return Visual(name, joint);
  }
  static std::string Text(const Eigen::Vector3d& v) {
    return std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z());
  }
  static std::string Joint(const std::string& name, const std::string& type,
                           const std::string& parent, const std::string& child,
                           const Eigen::Vector3d& origin, const std::string& more) {
    return "<joint name=\"" + name + "\" type=\"" + type + "\"><origin xyz=\"" + Text(origin) +
           "\"/><child link=\"" + child + "\"/><parent link=\"" + parent + "\"/>" + more +
           "</joint>";
  }

  std::filesystem::path folder_;
};

}  // namespace simwright
