#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace simwright::physics_params {

// The noun taxonomy of WordNet 3.0 (Debian package wordnet-base), read from its data files.
class WordNet {
 public:
  using Synset = std::int32_t;  // byte offset in data.noun, WordNet's own identifier

  // Reads `index.noun` and `data.noun` from `folder`. Throws core::Error if they are missing or
  // malformed.
  explicit WordNet(const std::filesystem::path& folder);

  // Returns the reader of the installed files, or null if the package is not installed.
  static const WordNet* Installed();

  // Returns the senses of a noun that are physical objects (artifact, food, plant, animal, object,
  // person: WordNet's lexicographer files 5, 6, 13, 17, 18, 20), most frequent first. Tries the
  // name as given, then its singular.
  std::vector<Synset> PhysicalSenses(std::string_view normalised_name) const;

  // Returns true if WordNet lists the word as a noun of any kind.
  bool HasNoun(std::string_view word) const;

  // Returns the lexicographer file of a synset: 5 animal, 6 artifact, 13 food, 17 natural object,
  // 18 person, 20 plant; 0 for an unknown one.
  int LexicographerFile(Synset synset) const;

  // Returns the synsets directly above one; empty for an unknown one.
  std::vector<Synset> Hypernyms(Synset synset) const;

  // Returns the synsets up to `most_steps` below one, itself left out, nearest first and then by
  // offset.
  std::vector<Synset> Hyponyms(Synset of, int most_steps) const;

  // Returns how many steps `of` lies above `kind`: 0 for the same synset, unset if it is not above.
  std::optional<int> StepsUp(Synset kind, Synset of) const;

  // Returns the first word of a synset, "frying pan"; empty for an unknown one.
  std::string Word(Synset synset) const;

  // Returns the synsets strictly between `kind` and `of` on a shortest way up; empty if there is
  // none between or no way.
  std::vector<Synset> Between(Synset kind, Synset of) const;

  // Returns Wu and Palmer's similarity, 2 depth(c) / (depth(a) + depth(b)), c the deepest common
  // hypernym; 1 for a == b. Depths count from `entity`, which has 1.
  double Similarity(Synset a, Synset b) const;

  // Returns the singulars of a normalised name, most likely first: regular plurals as WordNet's own
  // morphology undoes them, and "knives".
  static std::vector<std::string> Singulars(std::string_view name);

 private:
  struct Node {
    int lexicographer_file = 0;
    std::string word;
    std::vector<Synset> hypernyms;
  };

  const std::vector<Synset>* Lookup(const std::string& lemma) const;
  std::vector<Synset> Ancestors(Synset synset) const;  // itself first
  int Depth(Synset synset) const;

  std::unordered_map<std::string, std::vector<Synset>> senses_;
  std::unordered_map<Synset, Node> nodes_;
};

}  // namespace simwright::physics_params
