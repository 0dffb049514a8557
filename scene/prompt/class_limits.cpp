#include "scene/prompt/class_limits.h"

#include <algorithm>
#include <map>
#include <set>

#include "scene/prompt/object_names.h"
#include "scene/scene_types/scene_types.h"

namespace simwright::scene {

namespace {

// Adds the limits of furniture, if the scene type is known.
void LimitFurniture(const Vocabulary& vocabulary, std::vector<ClassLimit>* limits) {
  const std::vector<SceneType>& types = SceneTypes();
  const auto type = std::find_if(types.begin(), types.end(),
                                 [&](const auto& one) { return one.name == vocabulary.type; });
  if (type == types.end()) return;
  ClassLimit foreign;
  for (size_t i = 0; i < vocabulary.categories.size(); ++i) {
    const std::string& category = vocabulary.categories[i];
    const auto index = static_cast<int>(i);
    if (!vocabulary.welded[i]) continue;
    if (category == type->main_furniture) {
      limits->push_back({{index}, 1, 1});
    } else if (!std::binary_search(type->categories.begin(), type->categories.end(), category)) {
      foreign.classes.push_back(index);
    }
  }
  if (!foreign.classes.empty()) limits->push_back(foreign);
}

}  // namespace

std::vector<ClassLimit> ClassLimitsOf(const Prompt& prompt, const Vocabulary& vocabulary) {
  if (prompt.kind == PromptKind::kEmpty) return {};
  std::map<std::string, std::vector<int>> classes_of_name;
  for (size_t i = 0; i < vocabulary.categories.size(); ++i) {
    if (vocabulary.welded[i]) continue;
    classes_of_name[NameOfCategory(vocabulary.categories[i])].push_back(static_cast<int>(i));
  }
  std::vector<ClassLimit> limits;
  int named = 0;
  for (const NamedCount& one : prompt.names) {
    named += one.count;
    const auto found = classes_of_name.find(one.name);
    if (found == classes_of_name.end()) continue;
    limits.push_back({found->second, one.count, one.count});
    classes_of_name.erase(found);
  }
  ClassLimit others;
  for (const auto& [name, classes] : classes_of_name) {
    others.classes.insert(others.classes.end(), classes.begin(), classes.end());
  }
  std::sort(others.classes.begin(), others.classes.end());
  if (prompt.count) {
    others.least = others.most = std::max(0, *prompt.count - named);
  } else if (prompt.and_others) {
    others.most = std::max(1, vocabulary.entries - named);
    others.least = 1;
  }
  if (!others.classes.empty()) limits.push_back(others);
  // A piece of furniture has an entry, too.
  const bool furnished = std::find(vocabulary.welded.begin(), vocabulary.welded.end(), true) !=
                         vocabulary.welded.end();
  int room = vocabulary.entries - (furnished ? 1 : 0);
  for (ClassLimit& one : limits) {
    one.least = std::min(one.least, room);
    room -= one.least;
    one.most = std::max(one.least, std::min(one.most, one.least + room));
  }
  LimitFurniture(vocabulary, &limits);
  return limits;
}

bool AreValid(const std::vector<ClassLimit>& limits, int class_count, std::string* error) {
  std::set<int> limited;
  for (const ClassLimit& one : limits) {
    if (one.least < 0 || one.least > one.most) {
      *error = "limits of classes must be 0 <= least <= most";
      return false;
    }
    for (const int index : one.classes) {
      if (index >= 0 && index < class_count - 1 && limited.insert(index).second) continue;
      *error = "class " + std::to_string(index) + " cannot be limited, or is limited twice";
      return false;
    }
  }
  return true;
}

}  // namespace simwright::scene
