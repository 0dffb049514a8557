#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/random.h"
#include "texture/materials/surface_material.h"

namespace simwright::texture {

// The look that words give to one part of an object.
struct LookClause {
  std::string target;                   // "handle", "inside", "rim"; empty: the object itself
  std::string material;                 // a name of NamedMaterial, or empty
  std::vector<Eigen::Vector3f> colors;  // sRGB; the first is the surface's, the second a pattern's
  std::optional<Pattern> pattern;
  std::optional<float> roughness;
  std::optional<float> wear;
  bool glazed = false, unglazed = false, brushed = false, polished = false, painted = false;
  bool speckled = false, printed = false;
  std::string text;  // in quotes: printed on labels

  bool empty() const;
};

struct LookWords {
  std::vector<LookClause> clauses;
  std::vector<std::string> unused;  // words that say nothing here
};

// Reads a prompt such as "a blue glazed mug with a white inside and a black handle": colours,
// materials, patterns, finishes and texts in quotes belong to the part that is named after them.
// `targets` are the names of parts that can be named beside "inside", "rim" and "foot"; `ignored`
// are words that only say what the object is.
LookWords ReadLookWords(const std::string& prompt, const std::vector<std::string>& targets,
                        const std::vector<std::string>& ignored);

// Returns `base` as a clause changes it; a material that the clause names replaces it. The
// generator draws what the words leave open, and which blue a blue is.
SurfaceMaterial WithWords(const LookClause& clause, const SurfaceMaterial& base, core::Rng* rng);

}  // namespace simwright::texture
