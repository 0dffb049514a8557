#include "tasks/language/scene_description.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <vector>

#include "assets/joint_poses.h"
#include "core/error.h"
#include "core/mesh.h"

namespace simwright::tasks {
namespace {

using assets::Joint;
using assets::JointType;

constexpr std::size_t kLongestName = 120;  // bytes; a longer text is not a name

const char* TypeName(JointType type) {
  switch (type) {
    case JointType::kFixed:
      return "fixed";
    case JointType::kRevolute:
      return "revolute";
    case JointType::kContinuous:
      return "continuous";
    case JointType::kPrismatic:
      return "prismatic";
    case JointType::kFloating:
      return "floating";
    case JointType::kPlanar:
      return "planar";
  }
  return "fixed";
}

std::string Decimals(double value) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.3f", value);
  return std::string(text) == "-0.000" ? "0.000" : text;
}

// Returns the range of the joint's state; empty if it has no scalar state.
std::string LimitOf(const Joint& joint) {
  switch (joint.type) {
    case JointType::kRevolute:
      return "[" + Decimals(joint.lower) + ", " + Decimals(joint.upper) + "] rad";
    case JointType::kPrismatic:
      return "[" + Decimals(joint.lower) + ", " + Decimals(joint.upper) + "] m";
    case JointType::kContinuous:
      return "[-3.142, 3.142] rad, turns on without end";
    default:
      return "";
  }
}

// A link with the joint that moves it; null for the root.
struct Part {
  std::string link, label;
  const Joint* joint = nullptr;

  // Returns the rank of the part; parts of a high rank are left out first.
  int Rank() const {
    const bool moves = joint != nullptr && !LimitOf(*joint).empty();
    if (joint == nullptr || (moves && !label.empty())) return 0;
    return moves ? 1 : label.empty() ? 3 : 2;
  }
};

std::vector<Part> PartsOf(const assets::SemanticModel& asset) {
  std::vector<Part> parts;
  const assets::UrdfModel& model = asset.model;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    Part part;
    part.link = model.links[i].name;
    const auto found = asset.semantics.find(part.link);
    if (found != asset.semantics.end()) part.label = found->second.label;
    if (i > 0 && i - 1 < model.joints.size()) part.joint = &model.joints[i - 1];
    const bool named = part.link.size() <= kLongestName &&
                       (part.joint == nullptr || part.joint->name.size() <= kLongestName);
    if (named) parts.push_back(std::move(part));
  }
  return parts;
}

// Returns the `count` parts of the lowest rank, in their order.
std::vector<Part> MostInformative(std::vector<Part> parts, std::size_t count) {
  if (parts.size() <= count) return parts;
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return parts[a].Rank() < parts[b].Rank(); });
  order.resize(count);
  std::sort(order.begin(), order.end());
  std::vector<Part> kept;
  for (const std::size_t i : order) kept.push_back(parts[i]);
  return kept;
}

// Returns the largest number of parts per asset for which all assets together have at most `most`.
std::size_t FairShare(const std::vector<std::vector<Part>>& parts, std::size_t most) {
  std::size_t share = 0;
  for (const auto& of_asset : parts) share = std::max(share, of_asset.size());
  const auto total = [&](std::size_t bound) {
    std::size_t sum = 0;
    for (const auto& of_asset : parts) sum += std::min(of_asset.size(), bound);
    return sum;
  };
  while (share > 1 && total(share) > most) --share;
  return share;
}

std::string SizeText(const assets::UrdfModel& model) {
  const std::vector<Eigen::Isometry3d> poses = assets::LinkPosesAtZero(model);
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const assets::UrdfLink& link = model.links[i];
    for (const assets::UrdfShape& shape : link.visuals.empty() ? link.collisions : link.visuals) {
      for (const Eigen::Vector3d& vertex : shape.mesh.vertices) box.extend(poses[i] * vertex);
    }
  }
  if (box.isEmpty()) return "unknown";
  const Eigen::Vector3d size = box.sizes();
  return Decimals(size.x()) + " x " + Decimals(size.y()) + " x " + Decimals(size.z()) +
         " m along x, y, z";
}

std::string PartText(const Part& part, int number) {
  const std::string label = part.label.empty() ? "part" : part.label;
  std::string text = "   Part " + std::to_string(number) + ": " + Quoted(label) + "\n";
  text += "     - link_name: " + Quoted(part.link) + "\n";
  if (part.joint == nullptr) return text;
  text += "     - attached_to: " + Quoted(part.joint->parent) + "\n";
  const std::string limit = LimitOf(*part.joint);
  if (!limit.empty()) text += "     - joint_name: " + Quoted(part.joint->name) + "\n";
  text += std::string("     - joint_type: \"") + TypeName(part.joint->type) + "\"\n";
  if (!limit.empty()) text += "     - limit: " + limit + "\n";
  return text;
}

std::string AssetText(const NamedModel& asset, const std::vector<Part>& parts, int number) {
  std::string text = std::to_string(number) + ". asset_name: " + Quoted(asset.name) + "\n";
  if (!asset.model->category.empty()) {
    text += "   category: " + Quoted(asset.model->category) + "\n";
  }
  text += "   size: " + SizeText(asset.model->model) + "\n";
  for (std::size_t i = 0; i < parts.size(); ++i) {
    text += PartText(parts[i], static_cast<int>(i) + 1);
  }
  return text;
}

core::Finding CutDescription(const std::string& place, std::size_t left_out,
                             const std::string& what) {
  return {"description-cut", core::Severity::kWarning, place,
          std::to_string(left_out) + " " + what + " omitted from the prompt for the language model",
          static_cast<double>(left_out)};
}

}  // namespace

std::string Quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text.substr(0, kLongestName)) {
    const unsigned char byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += std::string("\\") + c;
    } else if (byte < 0x20 || byte == 0x7F) {
      char escape[8];
      std::snprintf(escape, sizeof(escape), "\\x%02x", byte);
      quoted += escape;
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

SceneDescription DescribeScene(std::span<const NamedModel> scene, const DescriptionBounds& bounds) {
  if (bounds.max_assets < 1 || bounds.max_parts < bounds.max_assets) {
    throw core::Error("the bounds are not in order", "description of the scene",
                      "1 <= max_assets <= max_parts");
  }
  SceneDescription description;
  const std::size_t most = static_cast<std::size_t>(bounds.max_assets);
  const std::span<const NamedModel> told = scene.first(std::min(scene.size(), most));
  std::vector<std::vector<Part>> parts;
  for (const NamedModel& asset : told) parts.push_back(PartsOf(*asset.model));
  const std::size_t share = FairShare(parts, static_cast<std::size_t>(bounds.max_parts));
  description.text = "The environment contains the following assets:\n";
  for (std::size_t i = 0; i < told.size(); ++i) {
    const std::vector<Part> kept = MostInformative(parts[i], share);
    description.text += AssetText(told[i], kept, static_cast<int>(i) + 1);
    const std::size_t all = told[i].model->model.links.size();
    if (kept.size() < all) {
      description.findings.push_back(CutDescription(told[i].name, all - kept.size(), "parts are"));
      description.text += "   (" + std::to_string(all - kept.size()) + " more parts, not to use)\n";
    }
  }
  if (told.size() < scene.size()) {
    description.findings.push_back(CutDescription("", scene.size() - told.size(), "assets are"));
  }
  return description;
}

}  // namespace simwright::tasks
