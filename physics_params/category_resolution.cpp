#include "physics_params/category_resolution.h"

#include <algorithm>

#include "core/error.h"

namespace simwright::physics_params {
namespace {

// Below this Wu-Palmer similarity a kind is no longer near: "beaker" - "cup" has 0.9, "violin" -
// "hammer" 0.6; container siblings such as "jar" - "box" meet at 0.8.
constexpr double kNearEnough = 0.84;
constexpr size_t kSuggestions = 5;

int EditDistance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j);
  for (size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0]++;
    for (size_t j = 1; j <= b.size(); ++j) {
      const int substituted = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

struct Candidate {
  const Category* category;
  double similarity;
};

// The base's categories by their likeness to any of the first senses of `name`; a rarer sense
// counts a little less.
std::vector<Candidate> ByMeaning(std::string_view name, const KnowledgeBase& base,
                                 const WordNet& wordnet) {
  std::vector<WordNet::Synset> senses = wordnet.PhysicalSenses(name);
  if (senses.size() > 3) senses.resize(3);
  std::vector<Candidate> candidates;
  if (senses.empty()) return candidates;
  for (const Category& category : base.categories()) {
    const std::vector<WordNet::Synset> kinds = wordnet.PhysicalSenses(category.name);
    if (kinds.empty() || category.name == "object") continue;
    double best = 0.0;
    for (size_t rank = 0; rank < senses.size(); ++rank) {
      // A kind of the category itself ("demitasse" is a cup) is near whatever the depths are.
      const bool below = wordnet.IsA(senses[rank], kinds[0]);
      const double likeness = wordnet.Similarity(senses[rank], kinds[0]) + (below ? 0.05 : 0.0);
      best = std::max(best, likeness - 0.02 * static_cast<double>(rank));
    }
    candidates.push_back({&category, best});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.similarity > b.similarity; });
  return candidates;
}

const Category* FindSingular(const std::string& name, const KnowledgeBase& base) {
  if (const Category* exact = base.FindCategory(name)) return exact;
  for (const std::string_view suffix : {"s", "es"}) {
    if (name.size() > suffix.size() + 2 && name.ends_with(suffix)) {
      const Category* found = base.FindCategory(name.substr(0, name.size() - suffix.size()));
      if (found != nullptr) return found;
    }
  }
  return nullptr;
}

std::vector<std::string> Suggestions(const std::string& name, const KnowledgeBase& base,
                                     const std::vector<Candidate>& by_meaning) {
  std::vector<std::string> names;
  for (size_t i = 0; i < by_meaning.size() && names.size() < kSuggestions - 2; ++i) {
    if (by_meaning[i].similarity > 0.6) names.push_back(by_meaning[i].category->name);
  }
  std::vector<std::pair<int, std::string>> by_spelling;
  for (const Category& category : base.categories()) {
    by_spelling.emplace_back(EditDistance(name, category.name), category.name);
  }
  std::stable_sort(by_spelling.begin(), by_spelling.end());
  for (const auto& [distance, spelled] : by_spelling) {
    if (names.size() >= kSuggestions) break;
    if (std::find(names.begin(), names.end(), spelled) == names.end()) names.push_back(spelled);
  }
  return names;
}

}  // namespace

Resolution ResolveCategory(std::string_view name, const KnowledgeBase& base,
                           const WordNet* wordnet) {
  Resolution result;
  const std::string wanted = NormaliseName(name);
  result.category = FindSingular(wanted, base);
  if (result.category != nullptr) {
    result.exact = true;
    result.sentence = "'" + wanted + "' is in the knowledge base";
    return result;
  }
  std::vector<Candidate> by_meaning;
  if (wordnet != nullptr) by_meaning = ByMeaning(wanted, base, *wordnet);
  if (!by_meaning.empty() && by_meaning[0].similarity >= kNearEnough) {
    result.category = by_meaning[0].category;
    result.sentence = "'" + wanted + "' is taken for the nearest known kind by WordNet, '" +
                      result.category->name + "'";
    return result;
  }
  // "red coffee mug" -> "coffee mug" -> "mug": English puts the head last.
  for (size_t blank = wanted.find(' '); blank != std::string::npos;
       blank = wanted.find(' ', blank + 1)) {
    const std::string head = wanted.substr(blank + 1);
    Resolution of_head = ResolveCategory(head, base, wordnet);
    if (of_head.category != nullptr) {
      of_head.exact = false;
      of_head.sentence = "'" + wanted + "' is taken for '" + of_head.category->name + "'";
      return of_head;
    }
  }
  result.closest = Suggestions(wanted, base, by_meaning);
  result.sentence = "no known kind is near '" + wanted + "'";
  return result;
}

Resolution RequireCategory(std::string_view name) {
  Resolution result = ResolveCategory(name, KnowledgeBase::Shipped(), WordNet::Installed());
  if (result.category == nullptr) {
    std::string names;
    for (const std::string& close : result.closest) names += (names.empty() ? "" : ", ") + close;
    throw core::Error("no kind of household thing is known by this name or near it",
                      "category '" + std::string(name) + "'",
                      "the closest known: " + names +
                          (WordNet::Installed() ? "" : "; install wordnet-base for more"));
  }
  return result;
}

}  // namespace simwright::physics_params
