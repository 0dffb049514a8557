#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace simwright::assets {

// A prim of an OpenUSD layer: what its text has between the prim's braces. The properties are in
// the order in which they were set.
class UsdPrim {
 public:
  // An empty `type` gives a prim without a type.
  UsdPrim(std::string type, std::string name);

  // Appends a child and returns it; the reference is valid until the next child is added.
  UsdPrim& Add(UsdPrim child);
  // Applies API schemas, such as "PhysicsMassAPI".
  UsdPrim& Apply(std::string schema);
  // Sets metadata by the text of its value: Meta("kind", "\"component\"").
  UsdPrim& Meta(const std::string& name, const std::string& value);
  // Sets a property by its declaration and the text of its value: Set("float physics:mass", "0.3").
  UsdPrim& Set(const std::string& declaration, const std::string& value);
  // Declares a property without a value: an output, or an attribute of a schema.
  UsdPrim& Declare(const std::string& declaration);
  // Sets the translation and the orientation of a pose in the parent's frame.
  UsdPrim& Place(const Eigen::Isometry3d& parent_from_prim);

  const std::string& name() const { return name_; }
  // Appends the prim's text, indented by 4 `depth` blanks.
  void AppendTo(int depth, std::string* text) const;

 private:
  void AppendMetadata(const std::string& indent, std::string* text) const;

  std::string type_, name_;
  std::vector<std::string> schemas_, metadata_, properties_;
  std::vector<UsdPrim> children_;
};

// Returns a layer's text (USDA): metres, kilograms, z up; `root` is the default prim. `comment` is
// the layer's documentation.
std::string UsdLayerText(const UsdPrim& root, const std::string& comment);

// Gives prims of one parent names that USD allows: letters, digits and '_', no digit first.
class UsdNames {
 public:
  // Returns `text` as a name that was not returned before: other characters become '_', and a
  // number is appended where the name is taken. Never empty.
  std::string Unique(std::string_view text);

 private:
  std::set<std::string> taken_;
};

// Return values as text. Numbers have as many digits as their reader keeps: 9 for float, 17 for
// double.
std::string UsdFloat(double value);
std::string UsdDouble(double value);
std::string UsdFloats(const Eigen::Vector3d& vector);        // (x, y, z)
std::string UsdDoubles(const Eigen::Vector3d& vector);       // (x, y, z)
std::string UsdFloats(const Eigen::Quaterniond& rotation);   // (w, x, y, z), w >= 0
std::string UsdDoubles(const Eigen::Quaterniond& rotation);  // (w, x, y, z), w >= 0
// Quotes a string; control characters become blanks, and bytes that are no UTF-8 U+FFFD.
std::string UsdString(std::string_view text);
// Returns the path of a file: @textures/a.png@.
std::string UsdAsset(const std::string& path);

}  // namespace simwright::assets
