#include "physics_params/wordnet.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <set>
#include <unordered_set>

#include "core/error.h"
#include "core/files.h"

namespace simwright::physics_params {
namespace {

// Calls `handle` with the blank-separated fields of each line that is not a licence line (those
// start with blanks), up to `max_fields`.
template <typename Handle>
void ForEachRecord(std::string_view text, const Handle& handle) {
  std::vector<std::string_view> fields;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size() - 1);
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    if (line.empty() || line[0] == ' ') continue;
    fields.clear();
    while (!line.empty()) {
      const size_t blank = line.find(' ');
      fields.push_back(line.substr(0, blank));
      if (fields.back() == "|" || blank == std::string_view::npos) break;
      line.remove_prefix(blank + 1);
    }
    handle(fields);
  }
}

int WordnetNumber(std::string_view field, int base = 10) {
  int value = -1;
  std::from_chars(field.data(), field.data() + field.size(), value, base);
  return value;
}

}  // namespace

std::vector<std::string> WordNet::Singulars(std::string_view name) {
  // morphy(7): s, ses, xes, zes, ches, shes, men, ies; its exceptions "knives", "shelves".
  static constexpr std::array<std::array<const char*, 2>, 11> kRules = {{{"s", ""},
                                                                         {"es", ""},
                                                                         {"ses", "s"},
                                                                         {"xes", "x"},
                                                                         {"zes", "z"},
                                                                         {"ches", "ch"},
                                                                         {"shes", "sh"},
                                                                         {"men", "man"},
                                                                         {"ies", "y"},
                                                                         {"ves", "f"},
                                                                         {"ves", "fe"}}};
  std::vector<std::string> result;
  for (const auto& [suffix, replacement] : kRules) {
    const std::string_view ending(suffix);
    if (name.size() > ending.size() + 1 && name.ends_with(ending)) {
      result.push_back(std::string(name.substr(0, name.size() - ending.size())) + replacement);
    }
  }
  return result;
}

WordNet::WordNet(const std::filesystem::path& folder) {
  // wndb(5): offset lex_filenum ss_type w_cnt(hex) {word lex_id} p_cnt {symbol offset pos st}
  ForEachRecord(core::ReadFile(folder / "data.noun"), [&](const auto& fields) {
    if (fields.size() < 6) return;
    const size_t pointers_at =
        4 + 2 * static_cast<size_t>(std::max(0, WordnetNumber(fields[3], 16)));
    if (pointers_at >= fields.size()) return;
    Node node;
    node.lexicographer_file = WordnetNumber(fields[1]);
    node.word = fields[4];
    std::replace(node.word.begin(), node.word.end(), '_', ' ');
    const int count = WordnetNumber(fields[pointers_at]);
    for (int i = 0; i < count; ++i) {
      const size_t at = pointers_at + 1 + 4 * static_cast<size_t>(i);
      if (at + 1 >= fields.size()) break;
      if (fields[at] == "@" || fields[at] == "@i")
        node.hypernyms.push_back(WordnetNumber(fields[at + 1]));
    }
    nodes_.emplace(WordnetNumber(fields[0]), std::move(node));
  });
  // wndb(5): lemma pos synset_cnt p_cnt [symbol...] sense_cnt tagsense_cnt offset [offset...]
  ForEachRecord(core::ReadFile(folder / "index.noun"), [&](const auto& fields) {
    if (fields.size() < 6) return;
    const int pointers = WordnetNumber(fields[3]);
    if (pointers < 0) return;
    std::vector<Synset>& senses = senses_[std::string(fields[0])];
    for (size_t i = 6 + static_cast<size_t>(pointers); i < fields.size(); ++i) {
      if (!fields[i].empty()) senses.push_back(WordnetNumber(fields[i]));
    }
  });
  if (nodes_.empty() || senses_.empty()) {
    throw core::Error("has no WordNet noun data", folder.string(), "install wordnet-base");
  }
}

const WordNet* WordNet::Installed() {
  static const std::unique_ptr<const WordNet> installed = []() -> std::unique_ptr<WordNet> {
    const std::filesystem::path folder = "/usr/share/wordnet";
    if (!std::filesystem::exists(folder / "data.noun")) return nullptr;
    return std::make_unique<WordNet>(folder);
  }();
  return installed.get();
}

const std::vector<WordNet::Synset>* WordNet::Lookup(const std::string& lemma) const {
  const auto found = senses_.find(lemma);
  return found == senses_.end() ? nullptr : &found->second;
}

std::vector<WordNet::Synset> WordNet::PhysicalSenses(std::string_view normalised_name) const {
  std::string lemma(normalised_name);
  std::replace(lemma.begin(), lemma.end(), ' ', '_');
  const std::vector<Synset>* senses = Lookup(lemma);
  if (senses == nullptr) {
    for (const std::string& singular : Singulars(lemma)) {
      senses = Lookup(singular);
      if (senses != nullptr) break;
    }
  }
  std::vector<Synset> physical;
  if (senses == nullptr) return physical;
  for (const Synset synset : *senses) {
    const auto node = nodes_.find(synset);
    if (node == nodes_.end()) continue;
    constexpr std::array kPhysicalFiles = {5, 6, 13, 17, 18, 20};
    if (std::find(kPhysicalFiles.begin(), kPhysicalFiles.end(), node->second.lexicographer_file) !=
        kPhysicalFiles.end()) {
      physical.push_back(synset);
    }
  }
  return physical;
}

std::vector<WordNet::Synset> WordNet::Ancestors(Synset synset) const {
  std::vector<Synset> found{synset};
  for (size_t i = 0; i < found.size(); ++i) {
    const auto node = nodes_.find(found[i]);
    if (node == nodes_.end()) continue;
    for (const Synset parent : node->second.hypernyms) {
      if (std::find(found.begin(), found.end(), parent) == found.end()) found.push_back(parent);
    }
  }
  return found;
}

int WordNet::Depth(Synset synset) const {
  // The longest of the few paths to the root. The noun graph has no loops; the bound keeps a
  // damaged file from hanging the program.
  std::vector<Synset> level{synset};
  int depth = 0;
  while (!level.empty() && depth < 64) {
    ++depth;
    std::set<Synset> parents;
    for (const Synset s : level) {
      const auto node = nodes_.find(s);
      if (node != nodes_.end()) {
        parents.insert(node->second.hypernyms.begin(), node->second.hypernyms.end());
      }
    }
    level.assign(parents.begin(), parents.end());
  }
  return depth;
}

double WordNet::Similarity(Synset a, Synset b) const {
  const std::vector<Synset> above_a = Ancestors(a), above_b = Ancestors(b);
  int common = 0;
  for (const Synset s : above_a) {
    if (std::find(above_b.begin(), above_b.end(), s) != above_b.end()) {
      common = std::max(common, Depth(s));
    }
  }
  return 2.0 * common / (Depth(a) + Depth(b));
}

int WordNet::LexicographerFile(Synset synset) const {
  const auto node = nodes_.find(synset);
  return node == nodes_.end() ? 0 : node->second.lexicographer_file;
}

std::vector<WordNet::Synset> WordNet::Hyponyms(Synset of, int most_steps) const {
  std::unordered_map<Synset, std::vector<Synset>> below;
  for (const auto& [synset, node] : nodes_) {
    for (const Synset above : node.hypernyms) below[above].push_back(synset);
  }
  std::vector<Synset> found, level = {of};
  std::unordered_set<Synset> known = {of};
  for (int step = 0; step < most_steps && !level.empty(); ++step) {
    std::vector<Synset> next;
    for (const Synset synset : level) {
      for (const Synset child : below[synset]) {
        if (known.insert(child).second) next.push_back(child);
      }
    }
    std::sort(next.begin(), next.end());
    found.insert(found.end(), next.begin(), next.end());
    level = std::move(next);
  }
  return found;
}

std::vector<WordNet::Synset> WordNet::Hypernyms(Synset synset) const {
  const auto node = nodes_.find(synset);
  return node == nodes_.end() ? std::vector<Synset>() : node->second.hypernyms;
}

bool WordNet::HasNoun(std::string_view word) const {
  return Lookup(std::string(word)) != nullptr;
}

std::string WordNet::Word(Synset synset) const {
  const auto node = nodes_.find(synset);
  return node == nodes_.end() ? "" : node->second.word;
}

std::vector<WordNet::Synset> WordNet::Between(Synset kind, Synset of) const {
  std::vector<Synset> way;
  std::optional<int> left = StepsUp(kind, of);
  while (left && *left > 1) {
    const auto node = nodes_.find(kind);
    if (node == nodes_.end()) break;
    for (const Synset parent : node->second.hypernyms) {
      const std::optional<int> from_parent = StepsUp(parent, of);
      if (from_parent && *from_parent < *left) {
        kind = parent;
        left = from_parent;
        break;
      }
    }
    way.push_back(kind);
  }
  return way;
}

std::optional<int> WordNet::StepsUp(Synset kind, Synset of) const {
  constexpr int kHighest = 64;  // a damaged file may contain a loop
  std::set<Synset> level{kind};
  for (int steps = 0; steps < kHighest && !level.empty(); ++steps) {
    if (level.contains(of)) return steps;
    std::set<Synset> parents;
    for (const Synset synset : level) {
      const auto node = nodes_.find(synset);
      if (node == nodes_.end()) continue;
      parents.insert(node->second.hypernyms.begin(), node->second.hypernyms.end());
    }
    level = std::move(parents);
  }
  return std::nullopt;
}

}  // namespace simwright::physics_params
