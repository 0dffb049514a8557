#include "scene/prompt/prompt_agreement.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>

#include "core/error.h"
#include "core/shuffle.h"
#include "scene/prompt/object_names.h"

namespace simwright::scene {
namespace {

// The boxes of a scene's free objects by name, in the order of their ordinals.
using BoxesByName = std::map<std::string, std::vector<PlacedBox>>;

BoxesByName BoxesOf(const std::vector<SceneObject>& objects, const CategorySizes& sizes) {
  BoxesByName by_name;
  for (const SceneObject& object : objects) {
    if (object.welded) continue;
    by_name[NameOfCategory(object.category)].push_back(
        BoxOf(SizeOf(sizes, object.category), object.world_from_object));
  }
  for (auto& [name, boxes] : by_name) {
    std::vector<const PlacedBox*> pointers;
    for (const PlacedBox& box : boxes) pointers.push_back(&box);
    std::vector<PlacedBox> ordered;
    for (const int i : OrdinalOrder(pointers)) ordered.push_back(boxes[static_cast<size_t>(i)]);
    boxes = std::move(ordered);
  }
  return by_name;
}

// Returns the objects that a reference may be.
std::vector<const PlacedBox*> Referents(const BoxesByName& by_name,
                                        const ObjectReference& reference) {
  std::vector<const PlacedBox*> boxes;
  const auto found = by_name.find(reference.name);
  if (found == by_name.end()) return boxes;
  for (size_t i = 0; i < found->second.size(); ++i) {
    const bool selected = reference.ordinal == 0 || static_cast<size_t>(reference.ordinal) == i + 1;
    if (selected) boxes.push_back(&found->second[i]);
  }
  return boxes;
}

bool StatementHolds(const RelationStatement& statement, const BoxesByName& by_name) {
  const std::vector<const PlacedBox*> subjects = Referents(by_name, statement.subject);
  const std::vector<const PlacedBox*> others = Referents(by_name, statement.object);
  return std::any_of(subjects.begin(), subjects.end(), [&](const PlacedBox* a) {
    return std::any_of(others.begin(), others.end(), [&](const PlacedBox* b) {
      return a != b && Holds(statement.relation, *a, *b);
    });
  });
}

bool StatementHolds(const TierStatement& statement, const BoxesByName& by_name,
                    const Shelves& shelves) {
  const std::vector<const PlacedBox*> subjects = Referents(by_name, statement.subject);
  return std::any_of(subjects.begin(), subjects.end(),
                     [&](const PlacedBox* a) { return shelves.TierOf(*a) == statement.tier; });
}

ObjectReference WithoutOrdinal(const ObjectReference& reference) {
  return {reference.name, 0};
}

void CompareStatements(const Prompt& prompt, const BoxesByName& by_name, const Shelves& shelves,
                       PromptAgreement* agreement) {
  for (const RelationStatement& one : prompt.relations) {
    const RelationStatement any{WithoutOrdinal(one.subject), one.relation,
                                WithoutOrdinal(one.object)};
    agreement->holds.push_back(StatementHolds(one, by_name));
    agreement->held_by_any += StatementHolds(any, by_name);
  }
  for (const TierStatement& one : prompt.tiers) {
    const TierStatement any{WithoutOrdinal(one.subject), one.tier};
    agreement->holds.push_back(StatementHolds(one, by_name, shelves));
    agreement->held_by_any += StatementHolds(any, by_name, shelves);
  }
  agreement->held = std::accumulate(agreement->holds.begin(), agreement->holds.end(), 0);
  agreement->statements = static_cast<int>(prompt.relations.size() + prompt.tiers.size());
  agreement->strict = agreement->strict && agreement->held == agreement->statements;
}

void CompareCounts(const Prompt& prompt, const BoxesByName& by_name, PromptAgreement* agreement) {
  int all = 0, named = 0;
  for (const auto& [name, boxes] : by_name) all += static_cast<int>(boxes.size());
  std::vector<int> there;
  for (const NamedCount& one : prompt.names) {
    const auto found = by_name.find(one.name);
    const int count = found == by_name.end() ? 0 : static_cast<int>(found->second.size());
    there.push_back(count);
    named += count;
    const bool enough = prompt.and_others && one.count > 0 && count > one.count;
    agreement->strict = agreement->strict && (count == one.count || enough);
  }
  double sum = 0.0;
  if (prompt.count) sum += CountAgreement(*prompt.count, all);
  if (!prompt.names.empty()) sum += NamesAgreement(prompt.names, there, prompt.and_others);
  const int terms = static_cast<int>(prompt.count.has_value()) + !prompt.names.empty();
  if (terms > 0) agreement->apf = sum / terms;
  if (prompt.count) agreement->strict = agreement->strict && *prompt.count == all;
  if (!prompt.names.empty() && !prompt.and_others) {
    agreement->strict = agreement->strict && named == all;
  }
}

void ThrowUnlessValidPrompt(const Prompt& prompt) {
  std::string error;
  if (!prompt.IsValid(&error)) throw core::Error(error, "prompt");
}

}  // namespace

double CountAgreement(int asked, int there) {
  if (asked <= 0) return asked == there ? 1.0 : 0.0;
  const double difference = std::abs(asked - there);
  return std::max(0.0, 1.0 - std::log1p(difference) / std::log1p(asked));
}

double NamesAgreement(const std::vector<NamedCount>& names, const std::vector<int>& there,
                      bool and_others) {
  double agreed = 0.0, sum = 0.0;
  for (size_t i = 0; i < names.size(); ++i) {
    const double asked = names[i].count;
    if (names[i].count == 0) {
      sum += 1.0;
      agreed += there[i] == 0 ? 1.0 : 0.0;
      continue;
    }
    const double missing = asked - there[i];
    const double difference = and_others ? std::max(0.0, missing) : std::abs(missing);
    sum += asked;
    agreed += asked * std::max(0.0, 1.0 - difference / asked);
  }
  return sum == 0.0 ? 1.0 : agreed / sum;
}

PromptAgreement AgreementWith(const Prompt& prompt, const std::vector<SceneObject>& objects,
                              const CategorySizes& sizes) {
  ThrowUnlessValidPrompt(prompt);
  const BoxesByName by_name = BoxesOf(objects, sizes);
  PromptAgreement agreement;
  CompareCounts(prompt, by_name, &agreement);
  const Shelves shelves = prompt.tiers.empty() ? Shelves() : Shelves(objects, sizes);
  CompareStatements(prompt, by_name, shelves, &agreement);
  return agreement;
}

double ChanceStatementShare(const Prompt& prompt, const std::vector<SceneObject>& objects,
                            const CategorySizes& sizes, int shuffles, core::Rng& rng) {
  if (shuffles < 1) throw core::Error("the chance level needs at least 1 shuffle");
  std::vector<Eigen::Vector3d> positions;
  for (const SceneObject& object : objects) {
    if (!object.welded) positions.push_back(object.world_from_object.translation());
  }
  std::vector<SceneObject> shuffled = objects;
  double sum = 0.0;
  for (int i = 0; i < shuffles; ++i) {
    core::Shuffle(&positions, rng);
    size_t next = 0;
    for (SceneObject& object : shuffled) {
      if (!object.welded) object.world_from_object.translation() = positions[next++];
    }
    sum += AgreementWith(prompt, shuffled, sizes).StatementShare();
  }
  return sum / shuffles;
}

}  // namespace simwright::scene
