#include "assets/urdf_sanity.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include <tinyxml2.h>

#include "core/error.h"
#include "geometry/mass_properties.h"

namespace simwright::assets {
namespace {

std::string LinkOf(const tinyxml2::XMLElement& joint, const char* role) {
  const auto* element = joint.FirstChildElement(role);
  const char* name = element == nullptr ? nullptr : element->Attribute("link");
  return name == nullptr ? "" : name;
}

void RequireUrdfTree(const tinyxml2::XMLElement& robot, const std::string& where) {
  std::set<std::string> links;
  for (auto* link = robot.FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    if (const char* name = link->Attribute("name")) links.insert(name);
  }
  if (links.empty()) throw core::Error("the robot has no link", where);
  std::map<std::string, std::string> parent_of;
  for (auto* joint = robot.FirstChildElement("joint"); joint;
       joint = joint->NextSiblingElement("joint")) {
    const char* name = joint->Attribute("name");
    const std::string parent = LinkOf(*joint, "parent"), child = LinkOf(*joint, "child");
    for (const std::string& link : {parent, child}) {
      if (!links.contains(link)) {
        throw core::Error("joint '" + std::string(name ? name : "") + "' names the link '" + link +
                              "', which does not exist",
                          where, "add the link or correct the joint");
      }
    }
    if (!parent_of.emplace(child, parent).second) {
      throw core::Error("link '" + child + "' has two parents: the joints form a loop", where,
                        "a URDF is a tree of links");
    }
  }
  for (const auto& [child, parent] : parent_of) {
    std::string link = child;
    for (size_t steps = 0; parent_of.contains(link); ++steps) {
      if (steps > parent_of.size()) {
        throw core::Error("the joints form a loop through link '" + child + "'", where,
                          "a URDF is a tree of links");
      }
      link = parent_of[link];
    }
  }
}

}  // namespace

void RequireSafeUrdfText(const std::string& text, const std::string& where) {
  if (text.find("<!DOCTYPE") != std::string::npos || text.find("<!ENTITY") != std::string::npos) {
    throw core::Error("declares a DOCTYPE or entities, which a URDF does not need", where,
                      "remove the declaration");
  }
  if (text.empty()) throw core::Error("the file is empty", where, "copy or download it again");
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw core::Error("this is not XML: line " + std::to_string(document.ErrorLineNum()), where,
                      "correct the file there");
  }
  const auto* robot = document.FirstChildElement("robot");
  if (robot == nullptr) {
    throw core::Error("this is not a URDF: it has no <robot>", where,
                      "give a URDF, or the folder of an asset");
  }
  RequireUrdfTree(*robot, where);
}

InertialFault FaultOf(const Inertial& inertial) {
  if (!(inertial.mass > 0.0) || !std::isfinite(inertial.mass)) {
    char text[60];
    std::snprintf(text, sizeof(text), "the mass is %g kg", inertial.mass);
    return {text, "a mass must be above zero"};
  }
  if (!inertial.inertia.allFinite() || !inertial.center_of_mass.allFinite()) {
    return {"the inertia is not finite", "compute the inertia from the shape"};
  }
  const Eigen::Vector3d moments = geometry::PrincipalInertiaOf(inertial.inertia).moments;
  if (!geometry::SatisfiesTriangleInequality(moments, 1e-3)) {
    return {
        "no rigid body has this inertia: one principal moment exceeds the sum of "
        "the other two, or is not positive",
        "compute the inertia from the shape"};
  }
  return {};
}

void RequirePhysical(const Inertial& inertial, const std::string& where) {
  const InertialFault fault = FaultOf(inertial);
  if (!fault.sentence.empty()) throw core::Error(fault.sentence, where, fault.remedy);
}

}  // namespace simwright::assets
