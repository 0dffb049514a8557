#include "physics_params/category_resolution.h"

#include <algorithm>

#include "core/error.h"
#include "physics_params/category_meaning.h"
#include "physics_params/material_words.h"
#include "physics_params/word_forms.h"

namespace simwright::physics_params {
namespace {

constexpr size_t kSuggestions = 3;

// Names that WordNet lacks or knows by a rarer sense.
constexpr struct {
  std::string_view name, category;
} kAliases[] = {{"torch", "flashlight"},
                {"lorry", "truck"},
                {"cafetiere", "french press"},
                {"mobile", "phone"},
                {"cellphone", "phone"},
                {"tin", "tin can"},
                {"trashbin", "trash can"},
                {"garbage bin", "trash can"},
                {"bin", "trash can"},
                {"hob", "cooktop"},
                {"cooker", "stove"},
                {"clock", "wall clock"},
                {"timepiece", "wall clock"},
                {"sideboard", "cabinet"},
                {"tankard", "beer mug"},
                {"percolator", "coffee pot"},
                {"chalice", "goblet"},
                {"cushion", "pillow"},
                {"notepad", "notebook"},
                {"atlas", "book"},
                {"cookbook", "book"},
                {"highlighter", "marker"},
                {"mallet", "hammer"},
                {"clog", "shoe"},
                {"plantain", "banana"},
                {"computer monitor", "monitor"},
                {"paper towel", "paper towel roll"}};

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

class Resolver {
 public:
  Resolver(const KnowledgeBase& base, const WordNet* wordnet, int most_steps)
      : base_(base), wordnet_(wordnet), most_steps_(most_steps) {}

  Resolution Resolve(std::string_view name) const;

 private:
  const Category* FindSpelled(const std::string& name) const;
  const Category* Known(const std::string& name) const;
  Resolution Meant(const std::string& name) const;
  Resolution OfHead(const std::string& name) const;
  bool IsNoun(const std::string& word) const;
  Resolution OfPackage(const std::string& name) const;
  bool IsWordOfItsOwn(const std::string& name) const;
  std::vector<std::string> Suggestions(const std::string& name) const;

  const KnowledgeBase& base_;
  const WordNet* wordnet_;
  int most_steps_;
};

// Returns a resolution whose sentence is only the reason; Resolve prepends the names.
Resolution Taken(const Category* category, const std::string& why) {
  return {category, false, why, {}};
}

// Finds the name or its singular.
const Category* Resolver::FindSpelled(const std::string& name) const {
  if (const Category* exact = base_.FindCategory(name)) return exact;
  for (const std::string& singular : WordNet::Singulars(name)) {
    if (const Category* found = base_.FindCategory(singular)) return found;
  }
  return nullptr;
}

// Also finds the name joined ("screw driver") or split ("coffeetable"), or by an alias.
const Category* Resolver::Known(const std::string& name) const {
  if (const Category* spelled = FindSpelled(name)) return spelled;
  const std::vector<std::string> words = WordsOf(name);
  if (words.size() > 1) {
    if (const Category* joined = FindSpelled(Joined(words, 0, words.size(), ""))) return joined;
  }
  for (size_t i = 2; i + 2 < name.size(); ++i) {
    if (const Category* apart = FindSpelled(name.substr(0, i) + " " + name.substr(i))) return apart;
  }
  for (const auto& alias : kAliases) {
    if (name == alias.name) return base_.FindCategory(alias.category);
  }
  return nullptr;
}

Resolution Resolver::Meant(const std::string& name) const {
  if (const Category* known = Known(name)) return Taken(known, "");
  if (wordnet_ == nullptr) return {};
  const std::optional<MeaningMatch> match = MatchByMeaning(name, base_, *wordnet_, most_steps_);
  if (!match) {
    const std::vector<std::string> words = WordsOf(name);
    return words.size() > 1 ? Meant(Joined(words, 0, words.size(), "")) : Resolution{};
  }
  if (match->steps == 0) return Taken(match->category, ", a synonym by WordNet");
  Resolution found = Taken(
      match->category, ", of which it is a kind by WordNet, " + std::to_string(match->steps) +
                           (match->steps == 1 ? " step up" : " steps up by way of " + match->via));
  found.steps = match->steps;
  return found;
}

// A compound that WordNet lists as one word differs in meaning from its last word.
bool Resolver::IsWordOfItsOwn(const std::string& name) const {
  if (wordnet_ == nullptr) return false;
  const std::vector<std::string> words = WordsOf(name);
  return words.size() > 1 &&
         (!wordnet_->PhysicalSenses(name).empty() ||
          !wordnet_->PhysicalSenses(Joined(words, 0, words.size(), "")).empty());
}

// Resolves by the head: "red coffee mug" -> "coffee mug" -> "mug", since English puts it last.
Resolution Resolver::OfHead(const std::string& name) const {
  const std::vector<std::string> words = WordsOf(name);
  for (size_t first = 1; first < words.size(); ++first) {
    const std::string head = Joined(words, first, words.size(), " ");
    const Resolution of_head = Meant(head);
    // A "screw driver" would resolve to a person, but no asset is a person by its last word.
    if (of_head.category != nullptr && of_head.category->name != "person") {
      if (wordnet_ != nullptr && IsRareSense(*of_head.category) && IsNoun(words[first - 1])) {
        return {};
      }
      Resolution found = Taken(of_head.category, " by its last word" + of_head.sentence);
      found.steps = of_head.steps;
      return WithNamedMaterial(words, first, base_, std::move(found));
    }
    if (IsWordOfItsOwn(head)) return {};
  }
  return {};
}

// Materials and foods before a last word describe it; other nouns may change its sense.
bool Resolver::IsNoun(const std::string& word) const {
  return wordnet_->HasNoun(word) && base_.FindMaterial(word) == nullptr && !IsFood(word, *wordnet_);
}

// Resolves "gelatin box" and "soup can": the bare words box and can also mean large ones.
Resolution Resolver::OfPackage(const std::string& name) const {
  const std::vector<std::string> words = WordsOf(name);
  if (wordnet_ == nullptr || words.size() < 2) return {};
  const std::string& last = words.back();
  const char* package = last == "box"                    ? "food box"
                        : last == "can" || last == "tin" ? "tin can"
                                                         : nullptr;
  if (package == nullptr || !IsFood(words[words.size() - 2], *wordnet_)) return {};
  return Taken(base_.FindCategory(package), ", a package of food");
}

Resolution Resolver::Resolve(std::string_view name) const {
  const std::string wanted = NormaliseName(name);
  if (const Category* spelled = FindSpelled(wanted)) {
    return {spelled, true, "'" + wanted + "' is in the knowledge base", {}};
  }
  const std::string plain = PlainName(name);
  const std::string head = PhraseHead(plain);
  Resolution found = Meant(head);
  if (found.category == nullptr) found = OfPackage(head);
  if (found.category == nullptr && IsSmallCopy(head)) {
    found = Taken(base_.FindCategory("toy"), ", a small copy");
  } else if (found.category == nullptr && !IsWordOfItsOwn(head)) {
    found = OfHead(head);
  }
  if (found.category != nullptr) {
    found.sentence =
        "'" + wanted + "' is taken for '" + found.category->name + "'" + found.sentence;
    return found;
  }
  found.closest = Suggestions(plain);
  found.sentence = "no known category is near '" + wanted + "'";
  return found;
}

// Suggests by spelling for up to two wrong letters, then by meaning, of the whole or its head.
std::vector<std::string> Resolver::Suggestions(const std::string& name) const {
  std::vector<std::pair<int, std::string>> by_spelling;
  for (const Category& category : base_.categories()) {
    by_spelling.emplace_back(EditDistance(name, category.name), category.name);
  }
  std::stable_sort(by_spelling.begin(), by_spelling.end());
  std::vector<std::string> names;
  const auto add = [&](const std::string& one) {
    if (one != "object" && names.size() < kSuggestions &&
        std::find(names.begin(), names.end(), one) == names.end()) {
      names.push_back(one);
    }
  };
  constexpr int kSlip = 2;
  for (const auto& [distance, spelled] : by_spelling) {
    if (distance <= kSlip && distance * 3 <= static_cast<int>(name.size())) add(spelled);
  }
  const std::vector<std::string> words = WordsOf(name);
  for (size_t first = 0; wordnet_ != nullptr && first < words.size(); ++first) {
    const std::string head = Joined(words, first, words.size(), " ");
    for (const Category* category : NearestByMeaning(head, base_, *wordnet_)) add(category->name);
  }
  for (const auto& [distance, spelled] : by_spelling) add(spelled);
  return names;
}

std::string Listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

}  // namespace

Resolution ResolveCategory(std::string_view name, const KnowledgeBase& base, const WordNet* wordnet,
                           int most_steps) {
  return Resolver(base, wordnet, most_steps).Resolve(name);
}

Resolution RequireCategory(std::string_view name) {
  Resolution result = ResolveCategory(name, KnowledgeBase::Shipped(), WordNet::Installed());
  if (result.category == nullptr) {
    throw core::Error("no known category is near this name", "category '" + std::string(name) + "'",
                      "--category one of: " + Listed(result.closest) +
                          "; 'object' accepts any object of stated size" +
                          (WordNet::Installed() ? "" : "; install wordnet-base for more names"));
  }
  return result;
}

Category ChosenRow(const Resolution& resolution, const VariantChoice& choice,
                   const KnowledgeBase& base) {
  VariantChoice all = choice;
  if (!all.material && !resolution.material.empty()) all.material = resolution.material;
  return ChosenVariant(*resolution.category, base, all);
}

core::Findings ResolutionFindings(const Resolution& resolution, const std::string& place) {
  if (resolution.exact) return {};
  if (resolution.closest.empty()) {
    return {{"category", core::Severity::kInfo, place, resolution.sentence, 0.0,
             "--category sets another"}};
  }
  return {
      {"category-unknown", core::Severity::kWarning, place, resolution.sentence, 0.0,
       "--category one of: " + Listed(resolution.closest) + "; --mass or --density sets its mass"}};
}

}  // namespace simwright::physics_params
