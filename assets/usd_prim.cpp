#include "assets/usd_prim.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "core/json.h"

namespace simwright::assets {
namespace {

std::string Formatted(const char* format, double value) {
  char text[40];
  std::snprintf(text, sizeof(text), format, value == 0.0 ? 0.0 : value);
  return text;
}

Eigen::Quaterniond WithPositiveReal(const Eigen::Quaterniond& rotation) {
  const Eigen::Quaterniond unit = rotation.normalized();
  return unit.w() < 0.0 ? Eigen::Quaterniond(-unit.coeffs()) : unit;
}

bool IsLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace

UsdPrim::UsdPrim(std::string type, std::string name)
    : type_(std::move(type)), name_(std::move(name)) {}

UsdPrim& UsdPrim::Add(UsdPrim child) {
  children_.push_back(std::move(child));
  return children_.back();
}

UsdPrim& UsdPrim::Apply(std::string schema) {
  schemas_.push_back(std::move(schema));
  return *this;
}

UsdPrim& UsdPrim::Meta(const std::string& name, const std::string& value) {
  metadata_.push_back(name + " = " + value);
  return *this;
}

UsdPrim& UsdPrim::Set(const std::string& declaration, const std::string& value) {
  properties_.push_back(declaration + " = " + value);
  return *this;
}

UsdPrim& UsdPrim::Declare(const std::string& declaration) {
  properties_.push_back(declaration);
  return *this;
}

UsdPrim& UsdPrim::Place(const Eigen::Isometry3d& parent_from_prim) {
  Set("double3 xformOp:translate", UsdDoubles(parent_from_prim.translation()));
  Set("quatd xformOp:orient", UsdDoubles(Eigen::Quaterniond(parent_from_prim.linear())));
  return Set("uniform token[] xformOpOrder", R"(["xformOp:translate", "xformOp:orient"])");
}

void UsdPrim::AppendMetadata(const std::string& indent, std::string* text) const {
  if (schemas_.empty() && metadata_.empty()) return;
  *text += " (\n";
  if (!schemas_.empty()) {
    *text += indent + "    prepend apiSchemas = [";
    for (size_t i = 0; i < schemas_.size(); ++i) {
      *text += (i > 0 ? ", \"" : "\"") + schemas_[i] + "\"";
    }
    *text += "]\n";
  }
  for (const std::string& line : metadata_) *text += indent + "    " + line + "\n";
  *text += indent + ")";
}

void UsdPrim::AppendTo(int depth, std::string* text) const {
  const std::string indent(4 * static_cast<size_t>(depth), ' ');
  *text += indent + "def " + (type_.empty() ? "" : type_ + " ") + "\"" + name_ + "\"";
  AppendMetadata(indent, text);
  *text += "\n" + indent + "{\n";
  for (const std::string& line : properties_) *text += indent + "    " + line + "\n";
  for (const UsdPrim& child : children_) child.AppendTo(depth + 1, text);
  *text += indent + "}\n";
}

std::string UsdLayerText(const UsdPrim& root, const std::string& comment) {
  std::string text = "#usda 1.0\n(\n    defaultPrim = \"" + root.name() + "\"\n";
  text += "    doc = " + UsdString(comment) + "\n";
  text += "    kilogramsPerUnit = 1\n    metersPerUnit = 1\n    upAxis = \"Z\"\n)\n\n";
  root.AppendTo(0, &text);
  return text;
}

std::string UsdNames::Unique(std::string_view text) {
  std::string name;
  for (const char c : text) name += IsLetter(c) || IsDigit(c) ? c : '_';
  if (name.empty() || IsDigit(name.front())) name.insert(0, 1, '_');
  std::string unique = name;
  for (int number = 2; !taken_.insert(unique).second; ++number) {
    unique = name + "_" + std::to_string(number);
  }
  return unique;
}

std::string UsdFloat(double value) {
  return Formatted("%.9g", value);
}
std::string UsdDouble(double value) {
  return Formatted("%.17g", value);
}

std::string UsdFloats(const Eigen::Vector3d& v) {
  return "(" + UsdFloat(v.x()) + ", " + UsdFloat(v.y()) + ", " + UsdFloat(v.z()) + ")";
}

std::string UsdDoubles(const Eigen::Vector3d& v) {
  return "(" + UsdDouble(v.x()) + ", " + UsdDouble(v.y()) + ", " + UsdDouble(v.z()) + ")";
}

std::string UsdFloats(const Eigen::Quaterniond& rotation) {
  const Eigen::Quaterniond q = WithPositiveReal(rotation);
  return "(" + UsdFloat(q.w()) + ", " + UsdFloat(q.x()) + ", " + UsdFloat(q.y()) + ", " +
         UsdFloat(q.z()) + ")";
}

std::string UsdDoubles(const Eigen::Quaterniond& rotation) {
  const Eigen::Quaterniond q = WithPositiveReal(rotation);
  return "(" + UsdDouble(q.w()) + ", " + UsdDouble(q.x()) + ", " + UsdDouble(q.y()) + ", " +
         UsdDouble(q.z()) + ")";
}

std::string UsdString(std::string_view text) {
  // USDA's escapes of quotes and backslashes are those of JSON; it has none of \u.
  std::string clean;
  for (const char c : text) clean += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  std::string quoted = core::JsonText(core::Json(clean), core::InvalidUtf8::kReplace, -1);
  if (quoted.back() == '\n') quoted.pop_back();
  return quoted;
}

std::string UsdAsset(const std::string& path) {
  const char* quote = path.find('@') == std::string::npos ? "@" : "@@@";
  return quote + path + quote;
}

}  // namespace simwright::assets
