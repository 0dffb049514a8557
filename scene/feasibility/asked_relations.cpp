#include "scene/feasibility/asked_relations.h"

#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "core/error.h"
#include "scene/prompt/object_names.h"

namespace simwright::scene {
namespace {

class RelationSearch {
 public:
  RelationSearch(const std::vector<SceneObject>& objects, const CategorySizes& sizes)
      : boxes_(objects.size()) {
    std::map<std::string, std::vector<int>> unordered;
    for (size_t i = 0; i < objects.size(); ++i) {
      if (objects[i].welded) continue;
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
        if (a == b) continue;
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

 private:
  std::vector<int> Selected(const ObjectReference& reference) const {
    const auto found = by_name_.find(reference.name);
    if (found == by_name_.end()) return {};
    if (reference.ordinal == 0) return found->second;
    const auto at = static_cast<size_t>(reference.ordinal) - 1;
    if (at >= found->second.size()) return {};
    return {found->second[at]};
  }

  std::vector<PlacedBox> boxes_;                     // by object; of free ones
  std::map<std::string, std::vector<int>> by_name_;  // objects in the order of their ordinals
};

}  // namespace

std::vector<KeptRelation> AskedRelations(const Prompt& prompt,
                                         const std::vector<SceneObject>& objects,
                                         const CategorySizes& sizes) {
  std::string error;
  if (!prompt.IsValid(&error)) throw core::Error(error, "prompt");
  if (prompt.relations.empty()) return {};
  const RelationSearch search(objects, sizes);
  std::vector<KeptRelation> asked;
  for (const RelationStatement& statement : prompt.relations) {
    if (const auto found = search.Find(statement)) asked.push_back(*found);
  }
  return asked;
}

}  // namespace simwright::scene
