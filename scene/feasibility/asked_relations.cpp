#include "scene/feasibility/asked_relations.h"

#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "core/error.h"
#include "scene/feasibility/pgs_solver.h"
#include "scene/prompt/object_names.h"

namespace simwright::scene {
namespace {

constexpr double kContradiction = 1e-4;  // m: the violation of constraints that cannot all hold

// Returns the flags of the objects that a prompt means. Throws core::Error for a wrong number of
// flags.
std::vector<char> NamedOf(const std::vector<char>& named, const std::vector<SceneObject>& objects) {
  if (named.empty()) {
    std::vector<char> free;
    for (const SceneObject& object : objects) free.push_back(!object.welded);
    return free;
  }
  if (named.size() != objects.size()) throw core::Error("each object is named or not");
  return named;
}

class RelationSearch {
 public:
  RelationSearch(const std::vector<SceneObject>& objects, const CategorySizes& sizes,
                 const std::vector<char>& named)
      : objects_(objects), shelves_(objects, sizes), boxes_(objects.size()) {
    std::map<std::string, std::vector<int>> unordered;
    for (size_t i = 0; i < objects.size(); ++i) {
      if (!named[i]) continue;
      boxes_[i] = BoxOf(SizeOf(sizes, objects[i].category), objects[i].world_from_object);
      unordered[NameOfCategory(objects[i].category)].push_back(static_cast<int>(i));
    }
    for (const auto& [name, indices] : unordered) {
      std::vector<const PlacedBox*> boxes;
      for (const int i : indices) boxes.push_back(&boxes_[static_cast<size_t>(i)]);
      for (const int at : OrdinalOrder(boxes)) {
        by_name_[name].push_back(indices[static_cast<size_t>(at)]);
      }
    }
  }

  std::optional<KeptRelation> Find(const RelationStatement& statement) const {
    std::optional<KeptRelation> nearest;
    double least = HUGE_VAL;
    for (const int a : Selected(statement.subject)) {
      for (const int b : Selected(statement.object)) {
        if (a == b || (IsWelded(a) && IsWelded(b))) continue;
        const PlacedBox &subject = boxes_[static_cast<size_t>(a)],
                        &object = boxes_[static_cast<size_t>(b)];
        const KeptRelation one{a, b, statement.relation, subject, object};
        if (Holds(statement.relation, subject, object)) return one;
        const double distance = (subject.center - object.center).norm();
        if (distance >= least) continue;
        least = distance;
        nearest = one;
      }
    }
    return nearest;
  }

  std::optional<KeptRelation> Find(const TierStatement& statement) const {
    std::optional<KeptRelation> nearest;
    double least = HUGE_VAL;
    const std::vector<Shelves::TierSpace> spaces = shelves_.SpacesOf(statement.tier);
    for (const int a : Selected(statement.subject)) {
      if (IsWelded(a)) continue;
      const PlacedBox& subject = boxes_[static_cast<size_t>(a)];
      for (const Shelves::TierSpace& one : spaces) {
        const KeptRelation kept{a, one.object, Relation::kOn, subject, one.space, true};
        const double distance = BoxDistance(subject, one.space);
        if (shelves_.TierOf(subject) == statement.tier && distance == 0.0) return kept;
        if (distance >= least) continue;
        least = distance;
        nearest = kept;
      }
    }
    return nearest;
  }

 private:
  bool IsWelded(int i) const { return objects_[static_cast<size_t>(i)].welded; }

  std::vector<int> Selected(const ObjectReference& reference) const {
    const auto found = by_name_.find(reference.name);
    if (found == by_name_.end()) return {};
    if (reference.ordinal == 0) return found->second;
    const auto at = static_cast<size_t>(reference.ordinal) - 1;
    if (at >= found->second.size()) return {};
    return {found->second[at]};
  }

  const std::vector<SceneObject>& objects_;
  Shelves shelves_;
  std::vector<PlacedBox> boxes_;                     // by object; of named ones
  std::map<std::string, std::vector<int>> by_name_;  // objects in the order of their ordinals
};

}  // namespace

std::vector<KeptRelation> AskedRelations(const Prompt& prompt,
                                         const std::vector<SceneObject>& objects,
                                         const CategorySizes& sizes,
                                         const std::vector<char>& named) {
  std::string error;
  if (!prompt.IsValid(&error)) throw core::Error(error, "prompt");
  if (prompt.relations.empty() && prompt.tiers.empty()) return {};
  const RelationSearch search(objects, sizes, NamedOf(named, objects));
  std::vector<KeptRelation> asked;
  for (const RelationStatement& statement : prompt.relations) {
    if (const auto found = search.Find(statement)) asked.push_back(*found);
  }
  for (const TierStatement& statement : prompt.tiers) {
    if (const auto found = search.Find(statement)) asked.push_back(*found);
  }
  return asked;
}

void EstablishRelations(const Prompt& prompt, const CategorySizes& sizes,
                        const std::vector<char>& named, std::vector<SceneObject>* objects) {
  std::vector<SeparationConstraint> rows;
  for (const KeptRelation& kept : AskedRelations(prompt, *objects, sizes, named)) {
    const std::vector<SeparationConstraint> some = LinearizeRelation(kept);
    rows.insert(rows.end(), some.begin(), some.end());
  }
  if (rows.empty()) return;
  std::vector<char> fixed;
  for (const SceneObject& object : *objects) fixed.push_back(object.welded);
  const PgsOptions options;
  std::vector<Eigen::Vector3d> shifts;
  const double violation = SolveLeastDisplacement(fixed, options, &rows, &shifts);
  if (violation > kContradiction) return;
  for (size_t i = 0; i < objects->size(); ++i) {
    (*objects)[i].world_from_object.pretranslate(shifts[i]);
  }
}

}  // namespace simwright::scene
