#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "tests/importers/damaged/mesh_damage.h"

namespace simwright::damaged {

constexpr int kCorpusFiles = 130;

// One file of the corpus: a sound object of the library with one to four damages.
struct Recipe {
  std::string name;  // "017-mug-holes-specks"
  std::string kind;  // of library::RigidKinds
  std::vector<std::string> damages;
  std::string format;
  std::uint64_t seed = 1;
};

// Returns the corpus: 30 kinds of objects; each damage occurs at least five times as the first.
std::vector<Recipe> CorpusRecipes();

// Returns an undamaged object of the kind with its true volume and sides.
Specimen SoundSpecimen(const std::string& kind, std::uint64_t seed);

// Returns the recipe's object with its damages.
Specimen DamagedSpecimen(const Recipe& recipe);

enum class Verdict {
  kRight,           // passes its check, sides within 2 %, volume within 5 %
  kRefused,         // with a reason
  kWrongAndSaid,    // a finding warns of the size or the shape
  kWrongInSilence,  // no finding does
};
const char* Name(Verdict verdict);

struct Trial {
  Verdict verdict = Verdict::kRefused;
  double side_error = 0.0;    // largest relative error of a side
  double volume_error = 0.0;  // relative
  std::string reason;         // of a refusal
  core::Findings findings;
  double seconds = 0.0;
};

// Writes the specimen into `folder`, imports it there as its user would, checks it and compares it
// with the truth.
Trial ImportSpecimen(const Specimen& specimen, const std::string& name,
                     const std::filesystem::path& folder);

}  // namespace simwright::damaged
