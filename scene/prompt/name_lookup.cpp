#include "scene/prompt/name_lookup.h"

#include <algorithm>
#include <numeric>

#include "scene/prompt/object_names.h"

namespace simwright::scene {
namespace {

using physics_params::WordNet;

constexpr size_t kSensesPerName = 3;  // the most frequent ones
constexpr int kMostSteps = 2;
constexpr size_t kMostRelatedWords = 3;
// The cost of one step in WordNet, against that of a rarer sense or of a name's last word.
constexpr int kStepCost = 4;

size_t WordCount(const std::string& words) {
  return 1 + static_cast<size_t>(std::count(words.begin(), words.end(), ' '));
}

size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

// Returns true for plurals of other words: not for "glass".
bool LooksPlural(const std::string& words) {
  return words.size() > 3 && words.ends_with("s") && !words.ends_with("ss") &&
         !words.ends_with("us");
}

}  // namespace

NameLookup::NameLookup(const std::vector<std::string>& names, const WordNet* wordnet)
    : names_(names), wordnet_(wordnet) {
  std::sort(names_.begin(), names_.end());
  names_.erase(std::unique(names_.begin(), names_.end()), names_.end());
  senses_.resize(names_.size());
  for (size_t n = 0; n < names_.size(); ++n) {
    const std::vector<std::string> spellings = SpellingsOf(names_[n]);
    for (size_t i = 0; i < spellings.size(); ++i) {
      spellings_.emplace(spellings[i], Spelling{static_cast<int>(n), i % 2 == 1});
      longest_ = std::max(longest_, WordCount(spellings[i]));
    }
  }
  // The last words of all names come before the first words of any.
  for (const bool last : {true, false}) {
    for (size_t n = 0; n < names_.size(); ++n) {
      const std::string& name = names_[n];
      if (name.find(" of ") != std::string::npos) continue;
      for (size_t blank = name.find(' '); blank != std::string::npos;
           blank = name.find(' ', blank + 1)) {
        AddPart(last ? name.substr(blank + 1) : name.substr(0, blank), static_cast<int>(n));
      }
    }
  }
  for (size_t n = 0; wordnet_ != nullptr && n < names_.size(); ++n) AddSenses(static_cast<int>(n));
}

void NameLookup::AddPart(const std::string& part, int name) {
  // Size alone names nothing.
  if (part == "small" || part == "large") return;
  parts_.emplace(part, Spelling{name, false});
  parts_.emplace(PluralOf(part), Spelling{name, true});
}

std::vector<NameLookup::Synset> NameLookup::SensesOf(const std::string& words) const {
  if (wordnet_ == nullptr) return {};
  std::vector<Synset> senses = wordnet_->PhysicalSenses(words);
  if (senses.size() > kSensesPerName) senses.resize(kSensesPerName);
  return senses;
}

void NameLookup::AddSenses(int name) {
  const std::string& words = names_[static_cast<size_t>(name)];
  std::vector<Synset> senses = SensesOf(words);
  int cost = 0;
  if (senses.empty() && words.find(" of ") == std::string::npos &&
      words.find(' ') != std::string::npos) {
    senses = SensesOf(words.substr(words.rfind(' ') + 1));
    cost = kStepCost;
  }
  const auto add = [&](Synset synset, int steps, std::unordered_map<Synset, Steps>* map) {
    const auto [entry, is_new] = map->emplace(synset, Steps{name, steps});
    if (!is_new && steps < entry->second.cost) entry->second = {name, steps};
  };
  for (size_t s = 0; s < senses.size(); ++s) {
    const int first = cost + static_cast<int>(s);
    add(senses[s], first, &exact_senses_);
    std::vector<Synset> level{senses[s]};
    for (int step = 1; step <= kMostSteps; ++step) {
      std::vector<Synset> above;
      for (const Synset synset : level) {
        const std::vector<Synset> some = wordnet_->Hypernyms(synset);
        above.insert(above.end(), some.begin(), some.end());
      }
      for (const Synset synset : above) add(synset, first + step * kStepCost, &above_senses_);
      level = std::move(above);
    }
  }
  senses_[static_cast<size_t>(name)] = std::move(senses);
}

std::optional<NameMatch> NameLookup::Exact(const std::vector<PromptWord>& words, size_t at) const {
  for (size_t count = std::min(longest_, words.size() - at); count > 0; --count) {
    const auto found = spellings_.find(JoinWords(words, at, at + count));
    if (found == spellings_.end()) continue;
    return NameMatch{found->second.name, count, found->second.plural, true};
  }
  return std::nullopt;
}

std::optional<NameMatch> NameLookup::ByWordNet(const std::string& words) const {
  const std::vector<Synset> senses = SensesOf(words);
  std::optional<Steps> best;
  const auto consider = [&](const std::unordered_map<Synset, Steps>& map, Synset synset, int cost) {
    const auto found = map.find(synset);
    if (found == map.end()) return;
    const Steps steps{found->second.name, found->second.cost + cost};
    if (steps.cost > kMostSteps * kStepCost + 3) return;
    if (!best || steps.cost < best->cost) best = steps;
  };
  for (size_t s = 0; s < senses.size(); ++s) {
    const int rarity = static_cast<int>(s);
    consider(exact_senses_, senses[s], rarity);
    consider(above_senses_, senses[s], rarity);
    std::vector<Synset> level{senses[s]};
    for (int step = 1; step <= kMostSteps; ++step) {
      std::vector<Synset> above;
      for (const Synset synset : level) {
        const std::vector<Synset> some = wordnet_->Hypernyms(synset);
        above.insert(above.end(), some.begin(), some.end());
      }
      for (const Synset synset : above) consider(exact_senses_, synset, rarity + step * kStepCost);
      level = std::move(above);
    }
  }
  if (!best) return std::nullopt;
  return NameMatch{best->name, WordCount(words), LooksPlural(words), false};
}

std::optional<NameMatch> NameLookup::Related(const std::vector<PromptWord>& words,
                                             size_t at) const {
  const size_t most = std::min(kMostRelatedWords, words.size() - at);
  for (size_t count = most; count > 0; --count) {
    if (std::any_of(words.begin() + static_cast<std::ptrdiff_t>(at),
                    words.begin() + static_cast<std::ptrdiff_t>(at + count),
                    [](const PromptWord& word) { return word.IsMark(); })) {
      continue;
    }
    const std::string phrase = JoinWords(words, at, at + count);
    const auto part = parts_.find(phrase);
    if (part != parts_.end()) {
      return NameMatch{part->second.name, count, part->second.plural, false};
    }
    const std::optional<NameMatch> match = ByWordNet(phrase);
    if (match) return match;
  }
  return std::nullopt;
}

bool NameLookup::IsPhysicalNoun(const std::string& words) const {
  return !SensesOf(words).empty();
}

double NameLookup::SimilarityOf(const std::vector<Synset>& senses, int name) const {
  double best = 0.0;
  for (const Synset a : senses) {
    for (const Synset b : senses_[static_cast<size_t>(name)]) {
      best = std::max(best, wordnet_->Similarity(a, b));
    }
  }
  return best;
}

std::vector<std::string> NameLookup::Nearest(const std::string& words, size_t count) const {
  std::vector<Synset> senses = SensesOf(words);
  if (senses.empty() && words.find(' ') != std::string::npos) {
    senses = SensesOf(words.substr(words.rfind(' ') + 1));
  }
  std::vector<std::pair<double, int>> order;  // smaller is nearer
  for (size_t n = 0; n < names_.size(); ++n) {
    const double distance = senses.empty()
                                ? static_cast<double>(EditDistance(words, names_[n])) /
                                      static_cast<double>(std::max(words.size(), names_[n].size()))
                                : -SimilarityOf(senses, static_cast<int>(n));
    order.emplace_back(distance, static_cast<int>(n));
  }
  std::sort(order.begin(), order.end());
  std::vector<std::string> nearest;
  for (size_t i = 0; i < std::min(count, order.size()); ++i) {
    nearest.push_back(names_[static_cast<size_t>(order[i].second)]);
  }
  return nearest;
}

}  // namespace simwright::scene
