#include "scene/dataset/vocabulary.h"

#include <algorithm>

#include "core/error.h"

namespace simwright::scene {

int Vocabulary::ClassOf(const std::string& category) const {
  const auto found = std::lower_bound(categories.begin(), categories.end(), category);
  return found == categories.end() || *found != category
             ? -1
             : static_cast<int>(found - categories.begin());
}

bool Vocabulary::IsValid(std::string* error) const {
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  if (entries < 1 || entries > 1 << 16) return fails("a scene has 1 to 65536 entries");
  if (categories.empty() || categories.size() > 1 << 16)
    return fails("a vocabulary has 1 to 65536 categories");
  if (welded.size() != categories.size()) return fails("welded must have one entry per category");
  for (size_t i = 0; i < categories.size(); ++i) {
    if (categories[i].empty()) return fails("a category has no name");
    if (i > 0 && !(categories[i - 1] < categories[i]))
      return fails("categories are not sorted and unique");
  }
  return true;
}

Vocabulary VocabularyOf(const Grammar& grammar) {
  Vocabulary vocabulary;
  vocabulary.type = grammar.name();
  vocabulary.entries = grammar.MaxEntries();
  if (vocabulary.entries == 0) {
    throw core::Error("the grammar does not bound the length of its scenes", grammar.name(),
                      "add the constraint EntriesAtMost");
  }
  vocabulary.categories = grammar.Categories();
  vocabulary.welded.assign(vocabulary.categories.size(), false);
  std::vector<bool> known(vocabulary.categories.size(), false);
  for (const Symbol& symbol : grammar.symbols()) {
    if (!symbol.IsObject()) continue;
    const auto c = static_cast<size_t>(vocabulary.ClassOf(symbol.category));
    if (known[c] && vocabulary.welded[c] != symbol.welded) {
      throw core::Error("a category is both welded and free",
                        grammar.name() + ": " + symbol.category);
    }
    known[c] = true;
    vocabulary.welded[c] = symbol.welded;
  }
  return vocabulary;
}

}  // namespace simwright::scene
