#include "physics_params/category_meaning.h"

#include <algorithm>
#include <iterator>
#include <string>

namespace simwright::physics_params {
namespace {

constexpr int kAnimal = 5, kArtifact = 6, kFood = 13;

// The artifact or food sense that a row means if it is not the first: WordNet's first plate lies on
// a baseball field. -1: none of them.
constexpr struct {
  std::string_view category;
  int sense;
} kSenses[] = {{"plate", 3},   {"canister", 1}, {"salad bowl", 1}, {"casserole", 1},
               {"ramekin", 1}, {"steamer", 1},  {"tin can", 1},    {"wooden spoon", 1},
               {"cake", 2},    {"iron", 2},     {"toilet", 1},     {"binder", 1},
               {"marker", 1},  {"keyboard", 1}, {"monitor", 2},    {"television", 1},
               {"mixer", 2},   {"shutter", 1},  {"column", 1},     {"barrel", 1},
               {"scooter", 1}, {"hut", 1},      {"hammer", 1},     {"screw", 2},
               {"helmet", 1},  {"tablet", -1},  {"plant", -1},     {"horse", -1},
               {"sponge", -1}, {"tape", -1},    {"object", -1},    {"person", -1}};

bool IsGoods(WordNet::Synset synset, const WordNet& wordnet) {
  const int file = wordnet.LexicographerFile(synset);
  return file == kArtifact || file == kFood;
}

std::optional<WordNet::Synset> SenseOf(const Category& category, const WordNet& wordnet) {
  int wanted = 0;
  for (const auto& row : kSenses) {
    if (row.category == category.name) wanted = row.sense;
  }
  const std::vector<WordNet::Synset> senses = wordnet.PhysicalSenses(category.name);
  if (wanted < 0 || senses.empty()) return std::nullopt;
  int goods = 0;
  for (const WordNet::Synset sense : senses) {
    if (IsGoods(sense, wordnet) && goods++ == wanted) return sense;
  }
  return goods == 0 ? std::optional(senses[0]) : std::nullopt;
}

// Returns the senses that a user may mean by a name.
std::vector<WordNet::Synset> SensesOf(std::string_view name, const WordNet& wordnet) {
  const std::vector<WordNet::Synset> all = wordnet.PhysicalSenses(name);
  if (all.empty()) return {};
  std::vector<WordNet::Synset> meant{all[0]};
  if (wordnet.LexicographerFile(all[0]) == kAnimal) return meant;
  for (const int file : {kArtifact, kFood}) {
    const auto first = std::find_if(all.begin(), all.end(), [&](WordNet::Synset sense) {
      return wordnet.LexicographerFile(sense) == file;
    });
    if (first != all.end() && *first != all[0]) meant.push_back(*first);
  }
  return meant;
}

}  // namespace

std::optional<MeaningMatch> MatchByMeaning(std::string_view name, const KnowledgeBase& base,
                                           const WordNet& wordnet, int most_steps) {
  std::optional<MeaningMatch> best;
  WordNet::Synset from = 0, to = 0;
  const std::vector<WordNet::Synset> senses = SensesOf(name, wordnet);
  if (senses.empty()) return best;
  for (const Category& category : base.categories()) {
    const std::optional<WordNet::Synset> kind = SenseOf(category, wordnet);
    if (!kind) continue;
    for (const WordNet::Synset sense : senses) {
      const std::optional<int> steps = wordnet.StepsUp(sense, *kind);
      if (steps && *steps <= most_steps && (!best || *steps < best->steps)) {
        best = MeaningMatch{&category, *steps, ""};
        from = sense;
        to = *kind;
      }
    }
  }
  if (!best) return best;
  for (const WordNet::Synset between : wordnet.Between(from, to)) {
    best->via += (best->via.empty() ? "'" : ", '") + wordnet.Word(between) + "'";
  }
  return best;
}

bool IsRareSense(const Category& category) {
  return std::any_of(std::begin(kSenses), std::end(kSenses), [&](const auto& row) {
    return row.category == category.name && row.sense > 1;
  });
}

bool IsFood(std::string_view name, const WordNet& wordnet) {
  const std::vector<WordNet::Synset> senses = wordnet.PhysicalSenses(name);
  return std::any_of(senses.begin(), senses.end(), [&](WordNet::Synset sense) {
    return wordnet.LexicographerFile(sense) == kFood;
  });
}

std::vector<const Category*> NearestByMeaning(std::string_view name, const KnowledgeBase& base,
                                              const WordNet& wordnet) {
  constexpr double kNear = 0.6;
  std::vector<std::pair<double, const Category*>> candidates;
  const std::vector<WordNet::Synset> senses = wordnet.PhysicalSenses(name);
  for (const Category& category : base.categories()) {
    const std::optional<WordNet::Synset> kind = SenseOf(category, wordnet);
    if (!kind) continue;
    double best = 0.0;
    for (const WordNet::Synset sense : senses) {
      best = std::max(best, wordnet.Similarity(sense, *kind));
    }
    if (best >= kNear) candidates.emplace_back(best, &category);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<const Category*> nearest;
  for (const auto& [similarity, category] : candidates) nearest.push_back(category);
  return nearest;
}

}  // namespace simwright::physics_params
