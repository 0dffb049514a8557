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
  using Synset = std::int32_t;  // byte offset in data.noun, the identifier WordNet uses itself

  // Reads `index.noun` and `data.noun` of `folder`. Throws core::Error when they are missing or
  // malformed.
  explicit WordNet(const std::filesystem::path& folder);

  // The reader of the installed files, or null where the package is not installed.
  static const WordNet* Installed();

  // The senses of a noun that are things one can touch (artifact, food, plant, animal, object,
  // person: WordNet's lexicographer files 5, 6, 13, 17, 18, 20), most frequent first.
  // Tries the name as given, then its singular.
  std::vector<Synset> PhysicalSenses(std::string_view normalised_name) const;

  // The lexicographer file of a synset: 5 animal, 6 artifact, 13 food, 17 natural object, 18
  // person, 20 plant; 0 for an unknown one.
  int LexicographerFile(Synset synset) const;

  // How many steps `of` lies above `kind`: 0 for the same synset, none where it is not above.
  std::optional<int> StepsUp(Synset kind, Synset of) const;

  // Wu and Palmer's similarity, 2 depth(c) / (depth(a) + depth(b)), c the deepest common
  // hypernym; 1 for a == b. Depths count from `entity`, which has 1.
  double Similarity(Synset a, Synset b) const;

  // Singulars of a normalised name, the likeliest first: regular plurals as WordNet's own
  // morphology undoes them, and "knives".
  static std::vector<std::string> Singulars(std::string_view name);

 private:
  struct Node {
    int lexicographer_file = 0;
    std::vector<Synset> hypernyms;
  };

  const std::vector<Synset>* Lookup(const std::string& lemma) const;
  std::vector<Synset> Ancestors(Synset synset) const;  // itself first
  int Depth(Synset synset) const;

  std::unordered_map<std::string, std::vector<Synset>> senses_;
  std::unordered_map<Synset, Node> nodes_;
};

}  // namespace simwright::physics_params
