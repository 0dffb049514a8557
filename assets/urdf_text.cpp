#include "assets/urdf_text.h"

#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include <tinyxml2.h>

#include "assets/urdf_materials.h"
#include "assets/urdf_numbers.h"
#include "core/error.h"

namespace simwright::assets {
namespace {

using tinyxml2::XMLElement;

constexpr const char* kExpand =
    "expand it first: xacro FILE.xacro > FILE.urdf (ROS 2: ros2 run xacro xacro), then give that";

std::string UrdfAttribute(const XMLElement& element, const char* name) {
  const char* value = element.Attribute(name);
  return value == nullptr ? "" : value;
}

// Returns the numbers of an attribute; none if one of its words is not a finite number.
std::vector<double> NumbersOf(const std::string& text) {
  std::istringstream words(text);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (end == word.c_str() || *end != '\0' || !std::isfinite(value)) return {};
    numbers.push_back(value);
  }
  return numbers;
}

// Blanks the <?xml ...?> declaration, because some files have blank lines and licences before it,
// where it is invalid; lines keep their numbers.
std::string WithoutDeclaration(std::string text) {
  const size_t start = text.find("<?xml");
  const size_t end = start == std::string::npos ? start : text.find("?>", start);
  const size_t robot = text.find("<robot");
  if (end == std::string::npos || end > robot) return text;
  for (size_t i = start; i < end + 2; ++i) {
    if (text[i] != '\n') text[i] = ' ';
  }
  return text;
}

// Finds elements and attributes that only xacro understands. `found` is the first, empty if there
// are none.
void FindXacro(const XMLElement& element, std::string* found) {
  if (!found->empty()) return;
  const std::string line = ", line " + std::to_string(element.GetLineNum());
  if (std::string_view(element.Name()).starts_with("xacro:")) {
    *found = "<" + std::string(element.Name()) + ">" + line;
    return;
  }
  if (std::string_view(element.Name()) == "gazebo") return;  // plugins have macros of their own
  for (auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    const std::string_view value = a->Value();
    if (value.find("${") == value.npos && value.find("$(") == value.npos) continue;
    *found = std::string(a->Name()) + "=\"" + std::string(value.substr(0, 60)) + "\"" + line;
    return;
  }
  for (auto* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    FindXacro(*child, found);
  }
}

class Mending {
 public:
  Mending(const std::string& text, const std::string& where) : where_(where) {
    if (text.size() >= 2 && (text.substr(0, 2) == "\xff\xfe" || text.substr(0, 2) == "\xfe\xff")) {
      throw core::Error("is written in UTF-16", where, "save it as UTF-8");
    }
    if (text.empty()) throw core::Error("the file is empty", where, "copy or download it again");
    const std::string body = WithoutDeclaration(text);
    if (document_.Parse(body.data(), body.size()) != tinyxml2::XML_SUCCESS) {
      throw core::Error("this is not XML: line " + std::to_string(document_.ErrorLineNum()), where,
                        "correct the file there");
    }
  }

  RepairedUrdf Mend() {
    XMLElement* robot = document_.FirstChildElement("robot");
    if (robot == nullptr) throw core::Error("this is not a URDF: it has no <robot>", where_);
    std::string xacro;
    FindXacro(*robot, &xacro);
    if (!xacro.empty()) {
      throw core::Error("is a xacro that was not expanded: " + xacro, where_, kExpand);
    }
    if (UrdfAttribute(*robot, "name").empty()) {
      robot->SetAttribute("name", std::filesystem::path(where_).stem().string().c_str());
    }
    RepairNumbers(robot, &findings_);
    ResolveMaterials(robot, &findings_);
    for (auto* link = robot->FirstChildElement("link"); link != nullptr;
         link = link->NextSiblingElement("link")) {
      MendInertial(link);
      MendShapes(link, "visual");
      MendShapes(link, "collision");
    }
    for (auto* joint = robot->FirstChildElement("joint"); joint != nullptr;
         joint = joint->NextSiblingElement("joint")) {
      MendJoint(joint);
    }
    tinyxml2::XMLPrinter printer;
    document_.Print(&printer);
    return {printer.CStr(), std::move(findings_)};
  }

 private:
  void Say(const std::string& code, core::Severity severity, const std::string& place,
           const std::string& sentence, double figure = 0.0, const std::string& remedy = "") {
    findings_.push_back({code, severity, place, sentence, figure, remedy});
  }

  // Repairs incomplete inertials, for which urdfdom rejects the file.
  void MendInertial(XMLElement* link) {
    XMLElement* inertial = link->FirstChildElement("inertial");
    if (inertial == nullptr) return;
    XMLElement* inertia = inertial->FirstChildElement("inertia");
    const XMLElement* mass = inertial->FirstChildElement("mass");
    bool whole = mass != nullptr && inertia != nullptr &&
                 NumbersOf(UrdfAttribute(*mass, "value")).size() == 1;
    for (const char* key : {"ixx", "iyy", "izz", "ixy", "ixz", "iyz"}) {
      if (!whole) break;
      if (key[1] != key[2] && inertia->Attribute(key) == nullptr) inertia->SetAttribute(key, "0");
      whole = NumbersOf(UrdfAttribute(*inertia, key)).size() == 1;
    }
    if (whole) return;
    Say("urdf-bad-inertial", core::Severity::kWarning, UrdfAttribute(*link, "name"),
        "its inertial lacks a readable mass or inertia and is ignored", 0.0,
        "give <mass value> and all of <inertia>");
    link->DeleteChild(inertial);
  }

  void MendShapes(XMLElement* link, const char* kind) {
    for (XMLElement* shape = link->FirstChildElement(kind); shape != nullptr;) {
      XMLElement* next = shape->NextSiblingElement(kind);
      XMLElement* geometry = shape->FirstChildElement("geometry");
      XMLElement* what = geometry == nullptr ? nullptr : geometry->FirstChildElement();
      const std::string name = what == nullptr ? "" : what->Name();
      if (name == "capsule") {
        ReplaceCapsule(link, shape, *what);
      } else if (name == "mesh") {
        MendMesh(link, shape, what);
      } else if (name == "sphere" && what->DoubleAttribute("radius", -1.0) == 0.0) {
        Skip(link, shape, "a sphere of radius 0");
      } else if (name != "box" && name != "cylinder" && name != "sphere") {
        Skip(link, shape, name.empty() ? "no geometry" : "the geometry <" + name + ">");
      }
      shape = next;
    }
  }

  void Skip(XMLElement* link, XMLElement* shape, const std::string& what) {
    Say("urdf-unknown-geometry", core::Severity::kWarning, UrdfAttribute(*link, "name"),
        std::string("a <") + shape->Name() + "> has " + what + " and is skipped", 0.0,
        "use a mesh, box, cylinder, sphere or capsule");
    link->DeleteChild(shape);
  }

  void MendMesh(XMLElement* link, XMLElement* shape, XMLElement* mesh) {
    if (UrdfAttribute(*mesh, "filename").empty()) {
      Skip(link, shape, "a mesh without a file");
      return;
    }
    const std::string scale = UrdfAttribute(*mesh, "scale");
    if (!scale.empty() && NumbersOf(scale).size() == 1) {
      mesh->SetAttribute("scale", (scale + " " + scale + " " + scale).c_str());
    }
  }

  // Replaces Bullet's and Gazebo's <capsule> by two balls and a cylinder along z, with `length`
  // between the balls' centres.
  void ReplaceCapsule(XMLElement* link, XMLElement* shape, const XMLElement& capsule) {
    const double radius = capsule.DoubleAttribute("radius", 0.0);
    const double length = capsule.DoubleAttribute("length", 0.0);
    if (!(radius > 0.0) || !(length >= 0.0)) {
      Skip(link, shape, "a capsule without a size");
      return;
    }
    const XMLElement* origin = shape->FirstChildElement("origin");
    const auto number = [](double value) {
      char text[40];
      std::snprintf(text, sizeof(text), "%.17g", value);
      return std::string(text);
    };
    std::vector<double> xyz{0, 0, 0}, rpy{0, 0, 0};
    if (origin != nullptr && NumbersOf(UrdfAttribute(*origin, "xyz")).size() == 3) {
      xyz = NumbersOf(UrdfAttribute(*origin, "xyz"));
    }
    if (origin != nullptr && NumbersOf(UrdfAttribute(*origin, "rpy")).size() == 3) {
      rpy = NumbersOf(UrdfAttribute(*origin, "rpy"));
    }
    // The third column of Rz(yaw) Ry(pitch) Rx(roll).
    const double sr = std::sin(rpy[0]), cr = std::cos(rpy[0]), sp = std::sin(rpy[1]);
    const double cp = std::cos(rpy[1]), sy = std::sin(rpy[2]), cy = std::cos(rpy[2]);
    const double z[3] = {cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr};
    for (const double end : {0.0, 0.5 * length, -0.5 * length}) {
      auto* piece = shape->DeepClone(&document_)->ToElement();
      link->InsertEndChild(piece);
      piece->DeleteChild(piece->FirstChildElement("geometry"));
      if (auto* old = piece->FirstChildElement("origin")) piece->DeleteChild(old);
      XMLElement* at = piece->InsertNewChildElement("origin");
      at->SetAttribute("xyz", (number(xyz[0] + end * z[0]) + " " + number(xyz[1] + end * z[1]) +
                               " " + number(xyz[2] + end * z[2]))
                                  .c_str());
      at->SetAttribute("rpy",
                       (number(rpy[0]) + " " + number(rpy[1]) + " " + number(rpy[2])).c_str());
      const bool middle = end == 0.0;
      XMLElement* geometry = piece->InsertNewChildElement("geometry");
      XMLElement* what = geometry->InsertNewChildElement(middle ? "cylinder" : "sphere");
      what->SetAttribute("radius", number(radius).c_str());
      if (middle) what->SetAttribute("length", number(length).c_str());
      if (length == 0.0) {
        what->SetName("sphere");
        break;
      }
    }
    link->DeleteChild(shape);
  }

  void MendJoint(XMLElement* joint) {
    const std::string type = UrdfAttribute(*joint, "type"), name = UrdfAttribute(*joint, "name");
    static const std::set<std::string> kTypes{"fixed",     "revolute", "continuous",
                                              "prismatic", "floating", "planar"};
    if (!kTypes.contains(type)) {
      throw core::Error(
          "joint '" + name + "' is of the type '" + type + "', which is not a URDF type", where_,
          "make it revolute, continuous, prismatic or fixed");
    }
    // These elements concern only a controller, and urdfdom rejects incomplete ones.
    for (const char* unused : {"safety_controller", "calibration"}) {
      while (auto* element = joint->FirstChildElement(unused)) joint->DeleteChild(element);
    }
    if (auto* dynamics = joint->FirstChildElement("dynamics");
        dynamics != nullptr && dynamics->Attribute("damping") == nullptr &&
        dynamics->Attribute("friction") == nullptr) {
      joint->DeleteChild(dynamics);
    }
    if (auto* limit = joint->FirstChildElement("limit")) MendLimit(type, name, limit);
    XMLElement* axis = joint->FirstChildElement("axis");
    if (axis == nullptr) return;
    if (type == "fixed" || type == "floating") {
      joint->DeleteChild(axis);
      return;
    }
    const std::vector<double> xyz = NumbersOf(UrdfAttribute(*axis, "xyz"));
    if (xyz.size() != 3) return;  // urdfdom reports the error
    const double length = std::hypot(xyz[0], xyz[1], xyz[2]);
    if (!(length > 1e-9)) {
      throw core::Error("joint '" + name + "' moves about an axis of length zero", where_,
                        "give <axis xyz> a direction, or make the joint fixed");
    }
    if (std::abs(length - 1.0) > 1e-3) {
      Say("urdf-axis", core::Severity::kInfo, name,
          "its axis is not a unit vector and was normalised", length);
    }
  }

  void MendLimit(const std::string& type, const std::string& name, XMLElement* limit) {
    for (const char* key : {"effort", "velocity"}) {
      if (limit->Attribute(key) == nullptr) limit->SetAttribute(key, "0");
    }
    if (type != "continuous") return;
    const double range =
        limit->DoubleAttribute("upper", 0.0) - limit->DoubleAttribute("lower", 0.0);
    if (range != 0.0) {
      Say("urdf-continuous-limits", core::Severity::kInfo, name,
          "it is continuous: it rotates freely and its limits are ignored", range,
          "make it revolute where it should stop");
    }
    limit->DeleteAttribute("lower");
    limit->DeleteAttribute("upper");
  }

  const std::string where_;
  tinyxml2::XMLDocument document_;
  core::Findings findings_;
};

}  // namespace

RepairedUrdf RepairUrdfText(const std::string& text, const std::string& where) {
  return Mending(text, where).Mend();
}

}  // namespace simwright::assets
