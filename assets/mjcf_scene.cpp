#include "assets/mjcf_scene.h"

#include <algorithm>

#include <tinyxml2.h>

#include "assets/xml_element.h"

namespace simwright::assets {
namespace {

using Printer = tinyxml2::XMLPrinter;

void Physics(Printer* printer, int parts) {
  MjcfOption(printer);
  // MuJoCo 2.2 reserves 500 constraint rows and 100 contacts, which an object of many parts
  // overflows (three contacts of six rows per part on a plane), and memory for their square: not
  // more rows than a lying comb needs. MuJoCo 3 ignores both.
  Element(printer, "size")
      .Set("njmax", std::to_string(std::min(500 + 40 * parts, 2500)))
      .Set("nconmax", std::to_string(200 + 4 * parts));
}

void Ground(Printer* printer) {
  Element(printer, "geom")
      .Set("name", "ground")
      .Set("type", "plane")
      .Set("size", "0 0 1")
      .Set("condim", "6")
      .Set("friction", "0.01 1e-5 1e-5");
}

}  // namespace

std::string MjcfSceneFileName(const std::string& asset) {
  return asset == "scene" ? "scene_scene.xml" : "scene.xml";
}

std::string MjcfSceneText(const std::string& asset, int parts, const Eigen::AlignedBox3d& bounds) {
  Printer printer;
  {
    Element mujoco(&printer, "mujoco");
    mujoco.Set("model", asset + "_scene");
    Element(&printer, "include").Set("file", asset + ".xml");
    Physics(&printer, parts);
    Element(&printer, "statistic")
        .Set("center", Numbers(Eigen::Vector3d(bounds.center())))
        .Set("extent", Number(std::max(1e-3, bounds.diagonal().norm())));
    Element worldbody(&printer, "worldbody");
    Element(&printer, "light")
        .Set("name", "sun")
        .Set("directional", "true")
        .Set("pos", "0 0 10")
        .Set("dir", "-0.5 0.2 -0.9");
    Ground(&printer);
  }
  return printer.CStr();
}

std::string MjcfPhysicsText(int parts) {
  Printer printer(nullptr, true);
  Physics(&printer, parts);
  return printer.CStr();
}

std::string MjcfGroundText() {
  Printer printer(nullptr, true);
  Ground(&printer);
  return printer.CStr();
}

}  // namespace simwright::assets
