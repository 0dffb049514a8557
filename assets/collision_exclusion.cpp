#include "assets/collision_exclusion.h"

#include <map>
#include <set>
#include <string>

#include <tinyxml2.h>

#include "assets/xml_element.h"

namespace simwright::assets {
namespace {

constexpr const char* kGroup = "drake:collision_filter_group";
constexpr const char* kMember = "drake:member";
constexpr const char* kIgnored = "drake:ignored_collision_filter_group";

std::string GroupOf(const std::string& link) {
  return "group_" + link;
}

// Returns the links that each link ignores; every link of a pair has an entry.
std::map<std::string, std::set<std::string>> IgnoredBy(const std::vector<ExcludedPair>& pairs) {
  std::map<std::string, std::set<std::string>> ignored;
  for (const auto& [a, b] : pairs) {
    ignored[a].insert(b);
    ignored[b];
  }
  return ignored;
}

std::string AttributeOf(const tinyxml2::XMLElement* element, const char* key) {
  const char* value = element == nullptr ? nullptr : element->Attribute(key);
  return value == nullptr ? "" : value;
}

}  // namespace

void UrdfExclusions(tinyxml2::XMLPrinter* printer, const ArticulatedAsset& asset) {
  for (const auto& [link, others] : IgnoredBy(asset.excluded_pairs)) {
    Element group(printer, kGroup);
    group.Set("name", GroupOf(link));
    Element(printer, kMember).Set("link", link);
    for (const std::string& other : others) Element(printer, kIgnored).Set("name", GroupOf(other));
  }
}

void SdfExclusions(tinyxml2::XMLPrinter* printer, const ArticulatedAsset& asset) {
  for (const auto& [link, others] : IgnoredBy(asset.excluded_pairs)) {
    Element group(printer, kGroup);
    group.Set("name", GroupOf(link));
    Leaf(printer, kMember, link);
    for (const std::string& other : others) Leaf(printer, kIgnored, GroupOf(other));
  }
}

void MjcfExclusions(tinyxml2::XMLPrinter* printer, const ArticulatedAsset& asset) {
  if (asset.excluded_pairs.empty()) return;
  Element contact(printer, "contact");
  for (const auto& [a, b] : asset.excluded_pairs) {
    Element(printer, "exclude").Set("body1", a).Set("body2", b);
  }
}

std::vector<ExcludedPair> ExcludedPairsIn(const tinyxml2::XMLElement& robot) {
  std::map<std::string, std::string> member;
  std::vector<ExcludedPair> ignored, pairs;
  for (auto* group = robot.FirstChildElement(kGroup); group != nullptr;
       group = group->NextSiblingElement(kGroup)) {
    const auto* link = group->FirstChildElement(kMember);
    if (link == nullptr || link->NextSiblingElement(kMember) != nullptr) continue;
    const std::string name = AttributeOf(group, "name");
    member[name] = AttributeOf(link, "link");
    for (auto* other = group->FirstChildElement(kIgnored); other != nullptr;
         other = other->NextSiblingElement(kIgnored)) {
      ignored.emplace_back(name, AttributeOf(other, "name"));
    }
  }
  for (const auto& [a, b] : ignored) {
    if (a != b && member.contains(a) && member.contains(b)) {
      pairs.emplace_back(member[a], member[b]);
    }
  }
  return pairs;
}

}  // namespace simwright::assets
