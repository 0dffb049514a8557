#include "assets/model_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <tinyxml2.h>
#include <Eigen/Geometry>

#include "assets/mjcf_elements.h"
#include "assets/xml_element.h"

namespace simwright::assets {
std::string CollisionFileName(int part) {
  char name[32];
  std::snprintf(name, sizeof(name), "collision_%03d.obj", part);
  return name;
}

HydroelasticContact ContactOf(const Asset& asset) {
  return HydroelasticContactOf(asset.parameters.material, asset.inertial.mass,
                               core::Bounds(asset.solid).sizes(), asset.friction);
}

bool VisualSuitsMujoco(const core::TriangleMesh& visual) {
  if (visual.triangles.size() > 200'000) return false;
  // MuJoCo 2.2 sums |volume| of the cones over all faces from their centre and rejects < 1e-15.
  double volume = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vertex : visual.vertices) centre += vertex;
  centre /= std::max<double>(1.0, static_cast<double>(visual.vertices.size()));
  for (size_t i = 0; i < visual.triangles.size(); ++i) {
    const Eigen::Vector3d& corner = visual.vertices[visual.triangles[i][0]];
    volume += core::TriangleAreaVector(visual, static_cast<int>(i)).dot(corner - centre) / 6.0;
  }
  return std::abs(volume) > 1e-10;
}

std::string UrdfText(const Asset& asset) {
  tinyxml2::XMLPrinter printer;
  printer.PushHeader(false, true);
  {
    Element robot(&printer, "robot");
    robot.Set("name", asset.name).Set("xmlns:drake", kDrakeNamespace);
    Element link(&printer, "link");
    link.Set("name", asset.name);
    UrdfInertial(&printer, asset.inertial);
    UrdfVisual(&printer, "visual.obj");
    const HydroelasticContact contact = ContactOf(asset);
    for (size_t i = 0; i < asset.parts.size(); ++i) {
      UrdfCollision(&printer, CollisionFileName(static_cast<int>(i)), contact);
    }
    UrdfContact(&printer, asset.friction, asset.rolling_friction, asset.restitution);
  }
  return printer.CStr();
}

std::string SdfText(const Asset& asset) {
  tinyxml2::XMLPrinter printer;
  printer.PushHeader(false, true);
  {
    Element sdf(&printer, "sdf");
    sdf.Set("version", "1.9").Set("xmlns:drake", kDrakeNamespace);
    Element model(&printer, "model");
    model.Set("name", asset.name);
    Element link(&printer, "link");
    link.Set("name", asset.name);
    SdfInertial(&printer, asset.inertial);
    SdfVisual(&printer, "visual", "visual.obj");
    const HydroelasticContact contact = ContactOf(asset);
    for (size_t i = 0; i < asset.parts.size(); ++i) {
      const std::string file = CollisionFileName(static_cast<int>(i));
      SdfCollision(&printer, file.substr(0, file.find('.')), file, contact);
    }
  }
  return printer.CStr();
}

std::string MjcfText(const Asset& asset) {
  tinyxml2::XMLPrinter printer;
  {
    Element mujoco(&printer, "mujoco");
    mujoco.Set("model", asset.name);
    Element(&printer, "compiler").Set("angle", "radian");
    const MjcfNames names{asset.name, ""};
    {
      Element meshes(&printer, "asset");
      MjcfMeshes(&printer, asset, names);
    }
    Element worldbody(&printer, "worldbody");
    MjcfBody(&printer, asset, names, {asset.name, nullptr, true});
  }
  return printer.CStr();
}

}  // namespace simwright::assets
