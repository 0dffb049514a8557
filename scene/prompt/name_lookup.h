#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "physics_params/wordnet.h"
#include "scene/prompt/prompt_words.h"

namespace simwright::scene {

// A name that some words of a prompt mean.
struct NameMatch {
  int name = -1;        // index into the known names
  size_t words = 0;     // number of words it takes
  bool plural = false;  // the words are plural
  bool exact = true;    // a spelling of the name itself, not a part of it or a synonym
};

// Finds known names in words: exact spellings, parts of names, and synonyms.
class NameLookup {
 public:
  // `wordnet` may be null; it must outlive this.
  NameLookup(const std::vector<std::string>& names, const physics_params::WordNet* wordnet);

  const std::vector<std::string>& names() const { return names_; }

  // Returns the longest spelling of a name that begins at word `at`.
  std::optional<NameMatch> Exact(const std::vector<PromptWord>& words, size_t at) const;

  // Returns the name whose last or first words begin at `at`, or of which the words are a synonym,
  // kind or genus within two steps; up to three words, the longest first. Of several names the
  // nearest, then the first of the alphabet.
  std::optional<NameMatch> Related(const std::vector<PromptWord>& words, size_t at) const;

  // Returns true if the words name a physical object in WordNet.
  bool IsPhysicalNoun(const std::string& words) const;

  // Returns the `count` known names nearest to the words: by Wu and Palmer's similarity, else by
  // edit distance.
  std::vector<std::string> Nearest(const std::string& words, size_t count) const;

 private:
  struct Spelling {
    int name;
    bool plural;
  };
  using Synset = physics_params::WordNet::Synset;

  std::vector<Synset> SensesOf(const std::string& words) const;
  void AddPart(const std::string& part, int name);
  void AddSenses(int name);
  std::optional<NameMatch> ByWordNet(const std::string& words) const;
  double SimilarityOf(const std::vector<Synset>& senses, int name) const;

  std::vector<std::string> names_;
  const physics_params::WordNet* wordnet_;
  std::unordered_map<std::string, Spelling> spellings_;
  std::unordered_map<std::string, Spelling> parts_;
  size_t longest_ = 1;                       // words of a spelling
  std::vector<std::vector<Synset>> senses_;  // by name
  struct Steps {
    int name;
    int cost;
  };
  std::unordered_map<Synset, Steps> exact_senses_;  // of names
  std::unordered_map<Synset, Steps> above_senses_;  // their hypernyms up to two steps
};

}  // namespace simwright::scene
