#include "proposals/category_proposals.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "core/error.h"
#include "core/json.h"
#include "llm/json_text.h"
#include "llm/redaction.h"
#include "physics_params/category_resolution.h"
#include "proposals/themes.h"

namespace simwright::proposals {
namespace {

using physics_params::Category;
using physics_params::KnowledgeBase;
using physics_params::WordNet;

constexpr double kHeaviest = 5.0;                   // kg, at the middle of the row's interval
constexpr double kShortest = 0.01, kLongest = 0.6;  // m, of the longest side's middle
constexpr int kMostPerRow = 3;
// A chosen category lowers the scores of others with its last word, and of its noun of the theme.
constexpr double kSameWord = 0.8, kSameNoun = 0.95;
constexpr double kSpecial = 0.85;  // of rows whose last word is a row, too
constexpr int kHyponymSteps = 4;
constexpr int kAskedTimes = 3;
constexpr std::size_t kLongestPrompt = 300;  // bytes
// Lexicographer files of what is handled: artifact, food, natural object, plant.
constexpr int kHandledFiles[] = {6, 13, 17, 20};

double Middle(const physics_params::Interval& interval) {
  return 0.5 * (interval.min + interval.max);
}

// Returns why a robot's gripper cannot handle objects of a row; "" if it can.
std::string WhyNotHandled(const Category& row) {
  if (Middle(row.mass) > kHeaviest) return "it weighs more than 5 kg";
  const double longest = std::max({Middle(row.length), Middle(row.width), Middle(row.height)});
  if (longest > kLongest) return "it is longer than 60 cm";
  if (longest < kShortest) return "it is shorter than 1 cm";
  return "";
}

bool IsHandledKind(const WordNet& wordnet, WordNet::Synset synset) {
  const int file = wordnet.LexicographerFile(synset);
  return std::find(std::begin(kHandledFiles), std::end(kHandledFiles), file) !=
         std::end(kHandledFiles);
}

// A noun of a theme with its senses.
struct Anchor {
  std::vector<WordNet::Synset> senses;
  double weight;
};

// Returns the anchors of a theme, its own name if it has no list.
std::vector<Anchor> AnchorsOf(const std::string& theme, const WordNet& wordnet,
                              core::Findings* findings) {
  std::vector<Anchor> anchors;
  for (const Theme& known : ShippedThemes()) {
    if (known.name != theme) continue;
    for (const ThemeNoun& noun : known.nouns) {
      std::vector<WordNet::Synset> senses = wordnet.PhysicalSenses(noun.noun);
      if (senses.size() > 2) senses.resize(2);  // rarer senses mislead
      if (!senses.empty()) anchors.push_back({std::move(senses), noun.weight});
    }
    return anchors;
  }
  std::vector<WordNet::Synset> senses = wordnet.PhysicalSenses(theme);
  if (senses.empty()) {
    std::string known;
    for (const std::string& name : KnownThemes()) known += (known.empty() ? "" : ", ") + name;
    throw core::Error("is no theme with a list, and WordNet knows no object of that name",
                      "'" + llm::Shortened(theme, 40) + "'",
                      "name one of " + known + ", or ask a language model with --llm");
  }
  if (senses.size() > 2) senses.resize(2);
  findings->push_back({"theme-unknown", core::Severity::kWarning, theme,
                       "the theme has no list of its own; categories are ranked by their "
                       "similarity with its name in WordNet",
                       0.0, "ask a language model with --llm"});
  anchors.push_back({std::move(senses), 1.0});
  return anchors;
}

// The relevance of a category, and the anchor that it comes from.
struct Relevance {
  double score = 0.0;
  std::size_t anchor = 0;
};

// A proposal that may be chosen.
struct Candidate {
  CategoryProposal proposal;
  std::size_t anchor = 0;
};

// Returns the relevance of a synset: an anchor's weight, less by its distance below it; below none,
// half of WordNet's similarity.
Relevance RelevanceOf(const WordNet& wordnet, WordNet::Synset synset,
                      const std::vector<Anchor>& anchors) {
  Relevance best;
  const auto compare = [&](const auto& value_of) {
    for (std::size_t a = 0; a < anchors.size(); ++a) {
      for (std::size_t sense = 0; sense < anchors[a].senses.size(); ++sense) {
        const double weight = anchors[a].weight * (sense == 0 ? 1.0 : 0.8);
        const double value = weight * value_of(anchors[a].senses[sense]);
        if (value > best.score) best = {value, a};
      }
    }
  };
  compare([&](WordNet::Synset anchor) {
    const std::optional<int> steps = wordnet.StepsUp(synset, anchor);
    return steps ? std::max(0.6, 1.0 - 0.04 * *steps) : 0.0;
  });
  if (best.score == 0.0) {
    compare([&](WordNet::Synset anchor) { return 0.5 * wordnet.Similarity(synset, anchor); });
  }
  return best;
}

// Returns the senses of a row's name or, for "plastic mug", of its last word.
std::vector<WordNet::Synset> SensesOfName(const WordNet& wordnet, const std::string& name) {
  std::vector<WordNet::Synset> senses = wordnet.PhysicalSenses(name);
  const std::size_t blank = name.rfind(' ');
  if (senses.empty() && blank != std::string::npos) {
    senses = wordnet.PhysicalSenses(name.substr(blank + 1));
  }
  return senses;
}

// Returns the names of rows that are variants of others by material or size.
std::set<std::string> VariantRows() {
  std::set<std::string> names;
  for (const Category& row : KnowledgeBase::Shipped().categories()) {
    for (const physics_params::Variant& variant : row.variants) names.insert(variant.category);
  }
  return names;
}

std::vector<Candidate> RowCandidates(const WordNet& wordnet, const std::vector<Anchor>& anchors) {
  std::vector<Candidate> candidates;
  const std::set<std::string> variants = VariantRows();
  for (const Category& row : KnowledgeBase::Shipped().categories()) {
    if (row.name == "object" || variants.contains(row.name)) continue;
    if (!WhyNotHandled(row).empty()) continue;
    Relevance best;
    double factor = 1.0;  // a household row means the first senses rather than the later ones
    for (const WordNet::Synset sense : SensesOfName(wordnet, row.name)) {
      Relevance relevance = RelevanceOf(wordnet, sense, anchors);
      relevance.score *= factor;
      if (IsHandledKind(wordnet, sense) && relevance.score > best.score) best = relevance;
      factor = std::max(0.75, factor - 0.05);
    }
    if (best.score <= 0.0) continue;
    // "mug" comes before "coffee mug".
    const std::size_t blank = row.name.rfind(' ');
    const bool is_special =
        blank != std::string::npos &&
        KnowledgeBase::Shipped().FindCategory(row.name.substr(blank + 1)) != nullptr;
    if (is_special) best.score *= kSpecial;
    candidates.push_back({{row.name, "", "knowledge base", row.name, best.score}, best.anchor});
  }
  return candidates;
}

std::vector<Candidate> HyponymCandidates(const WordNet& wordnet,
                                         const std::vector<Anchor>& anchors) {
  std::vector<Candidate> candidates;
  const KnowledgeBase& base = KnowledgeBase::Shipped();
  for (const Anchor& anchor : anchors) {
    for (const WordNet::Synset synset : wordnet.Hyponyms(anchor.senses.front(), kHyponymSteps)) {
      if (!IsHandledKind(wordnet, synset)) continue;
      const std::string word = wordnet.Word(synset);
      const std::string name = SafeCategory(word);
      // Proper names are no categories.
      const bool is_proper = std::any_of(word.begin(), word.end(),
                                         [](unsigned char c) { return std::isupper(c) != 0; });
      if (name.empty() || is_proper || base.FindCategory(name) != nullptr) continue;
      // The word must mean this object first, so that its picture shows it.
      const std::vector<WordNet::Synset> senses = wordnet.PhysicalSenses(name);
      if (senses.empty() || senses.front() != synset) continue;
      const physics_params::Resolution row = physics_params::ResolveCategory(name, base, &wordnet);
      if (row.category == nullptr || !WhyNotHandled(*row.category).empty()) continue;
      // Rows are what homes have; a hyponym follows them.
      const Relevance relevance = RelevanceOf(wordnet, synset, anchors);
      candidates.push_back(
          {{name, "", "WordNet", row.category->name, 0.8 * relevance.score}, relevance.anchor});
    }
  }
  return candidates;
}

// Chooses up to `count` candidates, each time the one of the highest score after the penalties for
// what was chosen before.
std::vector<CategoryProposal> ChooseDiverse(std::vector<Candidate> candidates, int count) {
  std::vector<CategoryProposal> chosen;
  std::set<std::string> names;
  std::map<std::string, int> per_row, per_word;
  std::map<std::size_t, int> per_anchor;
  const auto last_word = [](const std::string& name) { return name.substr(name.rfind(' ') + 1); };
  while (static_cast<int>(chosen.size()) < count) {
    const Candidate* best = nullptr;
    double highest = 0.0;
    for (const Candidate& candidate : candidates) {
      const CategoryProposal& proposal = candidate.proposal;
      if (per_row[proposal.row] >= kMostPerRow || names.contains(proposal.category)) continue;
      const double score = proposal.score *
                           std::pow(kSameWord, per_word[last_word(proposal.category)]) *
                           std::pow(kSameNoun, per_anchor[candidate.anchor]);
      if (score <= highest) continue;
      best = &candidate;
      highest = score;
    }
    if (best == nullptr) break;
    ++per_row[best->proposal.row];
    ++per_word[last_word(best->proposal.category)];
    ++per_anchor[best->anchor];
    names.insert(best->proposal.category);
    chosen.push_back(best->proposal);
    chosen.back().prompt = PromptFor(best->proposal.category);
  }
  return chosen;
}

// Returns one line of text without control characters, at most kLongestPrompt bytes; "" if nothing
// of it stays.
std::string SafePrompt(const std::string& text) {
  std::string line;
  for (const unsigned char c : text) {
    if (c < 0x20 || c == 0x7f) {
      if (!line.empty() && line.back() != ' ') line += ' ';
    } else {
      line += static_cast<char>(c);
    }
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line.size() > kLongestPrompt ? "" : line;
}

llm::ChatRequest QuestionAbout(const std::string& theme, int count,
                               const std::vector<CategoryProposal>& known, int round) {
  core::OrderedJson names = core::OrderedJson::array();
  for (const CategoryProposal& proposal : known) names.push_back(proposal.category);
  llm::ChatRequest request;
  request.task = "categories of " + theme;
  request.seed = static_cast<std::uint64_t>(round);
  request.json = true;
  request.messages.push_back(
      {llm::Role::kSystem,
       "You list categories of household objects that a robot arm with a parallel gripper can pick "
       "up: at most 5 kg and 60 cm. Answer with JSON only.",
       {}});
  request.messages.push_back(
      {llm::Role::kUser,
       "Theme: " + core::JsonLine(core::OrderedJson(theme), core::InvalidUtf8::kReplace) +
           "\nName " + std::to_string(count) +
           " different categories, most typical first, as {\"categories\": [{\"category\": "
           "\"mug\", "
           "\"prompt\": \"a single blue ceramic mug on a plain white background, studio light, "
           "whole object in frame\"}]}. A category is one to four lower-case English words. A "
           "prompt asks for a picture of one object.\nDo not repeat these: " +
           core::JsonLine(names, core::InvalidUtf8::kReplace),
       {}});
  return request;
}

// Reads the categories of an answer; reports how many were left out, by reason.
void TakeCategories(const llm::ChatAnswer& answer, int count, std::set<std::string>* known,
                    std::vector<CategoryProposal>* proposals,
                    std::map<std::string, int>* left_out) {
  for (const core::Json& json : llm::JsonInText(answer.text)) {
    const core::Json* list = json.is_array() ? &json : core::FindMember(json, "categories");
    if (list == nullptr || !list->is_array()) continue;
    for (const core::Json& item : *list) {
      if (static_cast<int>(proposals->size()) >= count) return;
      const std::string name = SafeCategory(item.is_string() ? item.get<std::string>()
                                                             : core::TextMember(item, "category"));
      if (name.empty()) {
        ++(*left_out)["no name of one to four words"];
        continue;
      }
      if (!known->insert(physics_params::NormaliseName(name)).second) {
        ++(*left_out)["named before"];
        continue;
      }
      const physics_params::Resolution row =
          physics_params::ResolveCategory(name, KnowledgeBase::Shipped(), WordNet::Installed());
      const std::string fault = row.category == nullptr ? "" : WhyNotHandled(*row.category);
      if (!fault.empty()) {
        ++(*left_out)[fault];
        continue;
      }
      std::string prompt = SafePrompt(core::TextMember(item, "prompt"));
      if (prompt.empty()) prompt = PromptFor(name);
      proposals->push_back(
          {name, prompt, "language model", row.category == nullptr ? "" : row.category->name, 0.0});
    }
  }
}

void ReportFewer(const std::string& theme, std::size_t found, int count, core::Findings* findings) {
  if (static_cast<int>(found) >= count) return;
  findings->push_back({"proposals-fewer", core::Severity::kWarning, theme,
                       "there are " + std::to_string(found) + " categories, not the " +
                           std::to_string(count) + " that were asked for",
                       static_cast<double>(found)});
}

}  // namespace

std::vector<std::string> KnownThemes() {
  std::vector<std::string> names;
  for (const Theme& theme : ShippedThemes()) names.push_back(theme.name);
  return names;
}

std::string SafeCategory(std::string_view name) {
  std::string safe = physics_params::NormaliseName(name);
  while (!safe.empty() && (safe.front() == '"' || safe.front() == '\'')) safe.erase(0, 1);
  while (!safe.empty() && (safe.back() == '"' || safe.back() == '\'')) safe.pop_back();
  const bool plain = std::all_of(safe.begin(), safe.end(), [](unsigned char c) {
    return (c < 0x80 && std::isalnum(c)) || c == ' ' || c == '-' || c == '\'';
  });
  const bool has_letter =
      std::any_of(safe.begin(), safe.end(), [](unsigned char c) { return std::isalpha(c) != 0; });
  const auto words = 1 + std::count(safe.begin(), safe.end(), ' ');
  if (!plain || !has_letter || safe.size() < 2 || safe.size() > 40 || words > 4) return "";
  return safe;
}

std::string RowOf(const std::string& category) {
  const physics_params::Resolution row =
      physics_params::ResolveCategory(category, KnowledgeBase::Shipped(), WordNet::Installed());
  return row.category == nullptr ? "" : row.category->name;
}

std::string PromptFor(const std::string& category) {
  return "a single " + category +
         " on a plain white background, studio light, whole object in frame";
}

std::vector<CategoryProposal> OfflineCategories(const std::string& theme, int count,
                                                core::Findings* findings) {
  const WordNet* wordnet = WordNet::Installed();
  if (wordnet == nullptr) {
    throw core::Error("is not installed, and categories are ranked by it", "WordNet",
                      "install wordnet-base, or ask a language model with --llm");
  }
  const std::vector<Anchor> anchors =
      AnchorsOf(physics_params::NormaliseName(theme), *wordnet, findings);
  std::vector<Candidate> candidates = RowCandidates(*wordnet, anchors);
  const std::vector<Candidate> hyponyms = HyponymCandidates(*wordnet, anchors);
  candidates.insert(candidates.end(), hyponyms.begin(), hyponyms.end());
  std::vector<CategoryProposal> chosen = ChooseDiverse(std::move(candidates), count);
  ReportFewer(theme, chosen.size(), count, findings);
  return chosen;
}

std::vector<CategoryProposal> LanguageModelCategories(const std::string& theme, int count,
                                                      llm::ChatModel* model,
                                                      core::Findings* findings,
                                                      core::Progress* progress) {
  std::vector<CategoryProposal> proposals;
  std::set<std::string> known;
  std::map<std::string, int> left_out;
  for (int round = 1; round <= kAskedTimes; ++round) {
    const int missing = count - static_cast<int>(proposals.size());
    if (missing <= 0) break;
    const llm::ChatAnswer answer =
        model->Ask(QuestionAbout(theme, missing, proposals, round), progress);
    TakeCategories(answer, count, &known, &proposals, &left_out);
  }
  const core::Findings asked = model->TakeFindings();
  findings->insert(findings->end(), asked.begin(), asked.end());
  for (const auto& [reason, number] : left_out) {
    findings->push_back(
        {"proposals-left-out", core::Severity::kInfo, theme,
         std::to_string(number) + " names of the language model were left out: " + reason,
         static_cast<double>(number)});
  }
  if (proposals.empty()) {
    throw core::Error("the language model named no category that can be used", theme,
                      "try another model, or leave out --llm");
  }
  ReportFewer(theme, proposals.size(), count, findings);
  return proposals;
}

}  // namespace simwright::proposals
