#include "texture/materials/look_words.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "texture/materials/named_materials.h"
#include "texture/materials/noise.h"

namespace simwright::texture {
namespace {

struct Word {
  std::string text;
  bool quoted = false;
};

std::vector<Word> WordsOf(const std::string& prompt) {
  std::vector<Word> words;
  std::string text;
  const auto flush = [&](bool quoted) {
    if (!text.empty()) words.push_back({text, quoted});
    text.clear();
  };
  bool quoted = false;
  for (const char c : prompt) {
    if (c == '"') {
      flush(quoted);
      quoted = !quoted;
    } else if (quoted) {
      text += c;
    } else if (c == ',' || c == ';' || c == '.') {
      flush(false);
      words.push_back({",", false});
    } else if (std::isspace(static_cast<unsigned char>(c)) || c == '-' || c == '_') {
      flush(false);
    } else {
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  flush(quoted);
  return words;
}

// Synonyms of materials; the second names are in the list of NamedMaterial.
constexpr const char* kSynonyms[][2] = {{"wood", "oak"},
                                        {"wooden", "beech"},
                                        {"oaken", "oak"},
                                        {"timber", "pine"},
                                        {"china", "porcelain"},
                                        {"bone china", "porcelain"},
                                        {"pottery", "stoneware"},
                                        {"stoneware", "stoneware"},
                                        {"faience", "ceramic"},
                                        {"inox", "stainless steel"},
                                        {"metal", "steel"},
                                        {"metallic", "steel"},
                                        {"metals", "steel"},
                                        {"aluminum", "aluminium"},
                                        {"golden", "gold"},
                                        {"chromed", "chrome"},
                                        {"wrought iron", "iron"},
                                        {"galvanised", "zinc"},
                                        {"galvanized", "zinc"},
                                        {"enamelled", "enamel"},
                                        {"enameled", "enamel"},
                                        {"cloth", "fabric"},
                                        {"textile", "fabric"},
                                        {"woven", "linen"},
                                        {"woollen", "wool"},
                                        {"knitted", "wool"},
                                        {"carton", "cardboard"},
                                        {"kraft", "cardboard"},
                                        {"rattan", "wicker"},
                                        {"wicker", "wicker"},
                                        {"cement", "concrete"},
                                        {"rubbery", "rubber"},
                                        {"crystal", "glass"},
                                        {"plastics", "plastic"},
                                        {"acrylic", "plastic"},
                                        {"suede", "felt"},
                                        {"chestnut", "walnut"},
                                        {"spruce", "pine"},
                                        {"earthenware", "earthenware"}};

std::string MaterialOf(const std::string& word) {
  for (const auto& [name, listed] : kSynonyms) {
    if (word == name) return listed;
  }
  // A colour and a material are two words.
  if (word == "black plastic") return "";
  return IsNamedMaterial(word) ? word : "";
}

std::optional<Pattern> PatternOf(const std::string& word) {
  static const struct {
    const char* word;
    Pattern pattern;
  } kWords[] = {{"striped", Pattern::kStripes},  {"stripes", Pattern::kStripes},
                {"stripe", Pattern::kStripes},   {"bands", Pattern::kStripes},
                {"banded", Pattern::kStripes},   {"dotted", Pattern::kDots},
                {"dots", Pattern::kDots},        {"polka", Pattern::kDots},
                {"spotted", Pattern::kDots},     {"checked", Pattern::kChecks},
                {"checks", Pattern::kChecks},    {"chequered", Pattern::kChecks},
                {"checkered", Pattern::kChecks}, {"checkerboard", Pattern::kChecks},
                {"plaid", Pattern::kPlaid},      {"tartan", Pattern::kPlaid},
                {"gingham", Pattern::kPlaid}};
  for (const auto& row : kWords) {
    if (word == row.word) return row.pattern;
  }
  return std::nullopt;
}

// Takes a word about the finish into the clause; false if it is none.
bool TakeFinish(const std::string& word, LookClause* clause) {
  static const struct {
    std::set<std::string> words;
    void (*take)(LookClause*);
  } kFinishes[] = {
      {{"glossy", "shiny", "lacquered", "varnished"}, [](LookClause* c) { c->roughness = 0.12f; }},
      {{"satin", "silky"}, [](LookClause* c) { c->roughness = 0.40f; }},
      {{"matte", "matt", "dull", "frosted"}, [](LookClause* c) { c->roughness = 0.80f; }},
      {{"rough", "raw"}, [](LookClause* c) { c->roughness = 0.92f; }},
      {{"glazed"}, [](LookClause* c) { c->glazed = true; }},
      {{"unglazed"}, [](LookClause* c) { c->unglazed = true; }},
      {{"brushed"}, [](LookClause* c) { c->brushed = true; }},
      {{"polished", "mirror"}, [](LookClause* c) { c->polished = true; }},
      {{"painted", "coated"}, [](LookClause* c) { c->painted = true; }},
      {{"speckled", "freckled", "flecked"}, [](LookClause* c) { c->speckled = true; }},
      {{"printed", "labelled", "labeled"}, [](LookClause* c) { c->printed = true; }},
      {{"worn", "old", "used", "scratched", "chipped", "weathered", "aged", "antique", "tarnished"},
       [](LookClause* c) { c->wear = 0.6f; }},
      {{"rusty", "rusted", "corroded"}, [](LookClause* c) { c->wear = 0.95f; }},
      {{"new", "clean", "pristine"}, [](LookClause* c) { c->wear = 0.0f; }}};
  for (const auto& finish : kFinishes) {
    if (!finish.words.contains(word)) continue;
    finish.take(clause);
    return true;
  }
  return false;
}

std::string RegionOf(const std::string& word) {
  static const std::set<std::string> kInside = {"inside", "interior", "inner"};
  static const std::set<std::string> kOutside = {"outside", "exterior", "outer"};
  if (kInside.contains(word)) return "inside";
  if (kOutside.contains(word)) return "outside";
  if (word == "rim" || word == "edge" || word == "lip") return "rim";
  return "";
}

class Reader {
 public:
  Reader(const std::vector<std::string>& targets, const std::vector<std::string>& ignored)
      : targets_(targets.begin(), targets.end()), ignored_(ignored.begin(), ignored.end()) {}

  LookWords Read(const std::vector<Word>& words) {
    for (std::size_t i = 0; i < words.size();) i += Take(words, i);
    Close();
    return std::move(result_);
  }

 private:
  // Takes the word at `at`, or that and the next as one; returns how many were taken.
  std::size_t Take(const std::vector<Word>& words, std::size_t at) {
    const Word& word = words[at];
    if (word.quoted) {
      clause_.text = word.text;
      clause_.printed = true;
      return 1;
    }
    for (const std::size_t count : {3u, 2u}) {
      if (at + count > words.size()) continue;
      std::string phrase = word.text;
      for (std::size_t k = 1; k < count; ++k) phrase += " " + words[at + k].text;
      if (TakeAttribute(phrase)) return count;
      if (targets_.contains(phrase) || ignored_.contains(phrase)) {
        TakeWord(phrase);
        return count;
      }
    }
    TakeWord(word.text);
    return 1;
  }

  bool TakeAttribute(const std::string& phrase) {
    if (const std::string material = MaterialOf(phrase); !material.empty()) {
      // "orange" and "peach" are colours of anything but the fruit itself.
      const bool is_also_color = NamedColor(phrase).has_value();
      if (!is_also_color) {
        clause_.material = material;
        return true;
      }
    }
    if (const auto color = NamedColor(phrase)) {
      clause_.colors.push_back(*color);
      return true;
    }
    if (const auto pattern = PatternOf(phrase)) {
      clause_.pattern = pattern;
      return true;
    }
    return TakeFinish(phrase, &clause_);
  }

  void TakeWord(const std::string& word) {
    static const std::set<std::string> kBreaks = {",", "with", "on", "but", "plus"};
    static const std::set<std::string> kJoints = {"of", "in", "from", "made"};
    static const std::set<std::string> kSilent = {
        "a",    "an",    "the",     "and",     "its",      "is",   "very",
        "some", "color", "colour",  "colored", "coloured", "this", "that",
        "look", "style", "texture", "finish",  "pattern",  "all",  "are"};
    if (kBreaks.contains(word)) {
      Close();
      return;
    }
    if (kJoints.contains(word)) {
      // "a handle of black plastic": what follows belongs to the part that was named.
      if (is_closed_ && !result_.clauses.empty()) {
        clause_ = result_.clauses.back();
        result_.clauses.pop_back();
        is_closed_ = false;
      }
      return;
    }
    if (kSilent.contains(word)) return;
    if (const std::string region = RegionOf(word); !region.empty()) return CloseAt(region);
    const std::string singular = word.ends_with("s") ? word.substr(0, word.size() - 1) : word;
    for (const std::string& name : {word, singular}) {
      if (targets_.contains(name)) return CloseAt(name);
      if (ignored_.contains(name)) return CloseAt("");
    }
    if (!TakeAttribute(word)) result_.unused.push_back(word);
    is_closed_ = false;
  }

  void CloseAt(const std::string& target) {
    clause_.target = target;
    Close();
    is_closed_ = true;
  }

  void Close() {
    is_closed_ = false;
    if (!clause_.empty()) {
      result_.clauses.push_back(clause_);
    } else if (!clause_.target.empty()) {
      result_.clauses.push_back(clause_);  // "a handle of ..." fills it later
    }
    clause_ = {};
  }

  const std::set<std::string> targets_, ignored_;
  LookWords result_;
  LookClause clause_;
  bool is_closed_ = false;  // the last clause ended with the part it is about
};

// Returns a colour that goes by the same name: a little lighter or darker, warmer or cooler.
Eigen::Vector3f SameName(const Eigen::Vector3f& color, core::Rng* rng) {
  const float light = static_cast<float>(core::Uniform(*rng, 0.88, 1.12));
  const float warm = static_cast<float>(core::Uniform(*rng, -0.025, 0.025));
  return (light * color + Eigen::Vector3f(warm, 0.0f, -warm)).cwiseMax(0.0f).cwiseMin(0.97f);
}

void SetMetalFinish(const LookClause& clause, SurfaceMaterial* material) {
  if (!material->IsMetal()) return;
  if (clause.brushed) {
    material->substance = Substance::kBrushedMetal;
    material->roughness = 0.32f;
  }
  if (clause.polished) {
    material->substance = Substance::kPolishedMetal;
    material->roughness = 0.12f;
  }
}

}  // namespace

bool LookClause::empty() const {
  return material.empty() && colors.empty() && !pattern && !roughness && !wear && !glazed &&
         !unglazed && !brushed && !polished && !painted && !speckled && !printed && text.empty();
}

LookWords ReadLookWords(const std::string& prompt, const std::vector<std::string>& targets,
                        const std::vector<std::string>& ignored) {
  return Reader(targets, ignored).Read(WordsOf(prompt));
}

SurfaceMaterial WithWords(const LookClause& clause, const SurfaceMaterial& base, core::Rng* rng) {
  SurfaceMaterial material = base;
  if (!clause.material.empty()) material = NamedMaterial(clause.material, rng);
  if (clause.material.empty() && clause.brushed && !material.IsMetal()) {
    material = NamedMaterial("steel", rng);
  }
  if (clause.glazed && material.substance != Substance::kGlaze) {
    material = NamedMaterial("ceramic", rng);
  }
  if (clause.unglazed && material.substance != Substance::kClay) {
    material = NamedMaterial("terracotta", rng);
  }
  if (clause.painted && material.substance != Substance::kPaint) {
    material = NamedMaterial(material.IsMetal() ? "painted metal" : "paint", rng);
  }
  SetMetalFinish(clause, &material);
  if (!clause.colors.empty()) {
    SetColor(SameName(clause.colors.front(), rng), &material);
    material.pattern_color = Mix(clause.colors.front(), Eigen::Vector3f::Ones(), 0.75f);
  } else if (clause.pattern) {
    material.pattern_color = material.color.mean() > 0.6f ? Eigen::Vector3f(0.16f, 0.30f, 0.52f)
                                                          : Eigen::Vector3f(0.93f, 0.92f, 0.88f);
  }
  if (clause.colors.size() > 1) material.pattern_color = clause.colors[1];
  if (clause.pattern) material.pattern = *clause.pattern;
  if (clause.colors.size() > 1 && !clause.pattern && material.pattern == Pattern::kNone) {
    material.pattern = Pattern::kStripes;
  }
  if (clause.speckled) material.figure = SkinFigure::kSpots;
  if (clause.roughness) material.roughness = *clause.roughness;
  if (clause.wear) material.wear = *clause.wear;
  return material;
}

}  // namespace simwright::texture
