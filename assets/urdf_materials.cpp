#include "assets/urdf_materials.h"

#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include <tinyxml2.h>

namespace simwright::assets {
namespace {

using tinyxml2::XMLElement;

std::string MaterialAttribute(const XMLElement* element, const char* name) {
  const char* value = element == nullptr ? nullptr : element->Attribute(name);
  return value == nullptr ? "" : value;
}

struct Paint {
  std::string rgba, texture;  // as written; either may be empty
  bool defined() const { return !rgba.empty() || !texture.empty(); }
};

// Returns four numbers; with three the fourth is 1. Returns an empty string for anything else.
std::string Rgba(const std::string& text) {
  std::istringstream words(text);
  std::string rgba;
  int count = 0;
  for (double value = 0.0; words >> value; ++count) {
    if (!std::isfinite(value)) return "";
    rgba += (count > 0 ? " " : "") + std::to_string(value);
  }
  if (count == 3) return rgba + " 1";
  return count == 4 ? text : "";
}

Paint PaintOf(const XMLElement& material) {
  return {Rgba(MaterialAttribute(material.FirstChildElement("color"), "rgba")),
          MaterialAttribute(material.FirstChildElement("texture"), "filename")};
}

class Materials {
 public:
  explicit Materials(core::Findings* findings) : findings_(findings) {}

  // `global`: defined beside the links, where a name must be unique.
  void Define(const XMLElement& material, bool global) {
    const std::string name = MaterialAttribute(&material, "name");
    const Paint paint = PaintOf(material);
    if (name.empty() || !paint.defined()) return;
    const auto [known, is_new] = paints_.emplace(name, paint);
    const Paint& first = known->second;
    if (is_new || !global || (first.rgba == paint.rgba && first.texture == paint.texture)) return;
    findings_->push_back({"urdf-material-twice", core::Severity::kWarning, name,
                          "this material has two different definitions: the first is used", 0.0,
                          "give one of them another name"});
  }

  void Apply(const std::string& link, XMLElement* visual, XMLElement* material) {
    const std::string name = MaterialAttribute(material, "name");
    Paint paint = PaintOf(*material);
    if (!paint.defined()) {
      const auto found = paints_.find(name);
      if (found != paints_.end()) paint = found->second;
    }
    visual->DeleteChild(material);
    if (!paint.defined()) {
      if (!name.empty() && unknown_.insert(name).second) {
        findings_->push_back(
            {"urdf-unknown-material", core::Severity::kInfo, link,
             "the material '" + name + "' is not defined: the mesh's own, or grey, is used", 0.0,
             "give it a <color rgba>"});
      }
      return;
    }
    if (!paint.texture.empty() && textures_.insert(paint.texture).second) {
      findings_->push_back({"urdf-texture", core::Severity::kWarning, link,
                            "the texture '" + paint.texture +
                                "' of its <material> is ignored: the mesh's own is used",
                            0.0, "name the texture in the mesh file"});
    }
    XMLElement* own = visual->InsertNewChildElement("material");
    own->SetAttribute("name", ("material_" + std::to_string(count_++)).c_str());
    if (!paint.rgba.empty()) {
      own->InsertNewChildElement("color")->SetAttribute("rgba", paint.rgba.c_str());
    }
    if (!paint.texture.empty()) {
      own->InsertNewChildElement("texture")->SetAttribute("filename", paint.texture.c_str());
    }
  }

 private:
  core::Findings* findings_;
  std::map<std::string, Paint> paints_;
  std::set<std::string> unknown_, textures_;
  int count_ = 0;
};

// Calls visit(link, visual, material) for each visual that has a material.
template <typename Visit>
void ForEachVisual(XMLElement* robot, const Visit& visit) {
  for (auto* link = robot->FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    for (auto* visual = link->FirstChildElement("visual"); visual;
         visual = visual->NextSiblingElement("visual")) {
      if (auto* material = visual->FirstChildElement("material")) visit(link, visual, material);
    }
  }
}

}  // namespace

void ResolveMaterials(XMLElement* robot, core::Findings* findings) {
  Materials materials(findings);
  while (auto* material = robot->FirstChildElement("material")) {
    materials.Define(*material, true);
    robot->DeleteChild(material);
  }
  ForEachVisual(robot, [&](XMLElement*, XMLElement*, XMLElement* material) {
    materials.Define(*material, false);
  });
  ForEachVisual(robot, [&](XMLElement* link, XMLElement* visual, XMLElement* material) {
    materials.Apply(MaterialAttribute(link, "name"), visual, material);
  });
}

}  // namespace simwright::assets
