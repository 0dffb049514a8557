#pragma once

#include <memory>
#include <vector>

#include "core/random.h"
#include "scene/prompt/prompt.h"

namespace simwright::scene {

struct Vocabulary;

// The probabilities of drawn prompts; the defaults are the published ones.
struct PromptDrawingOptions {
  // Relative weights of the three kinds. A scene that does not allow a kind (no objects, no
  // relations) gets the one before it.
  double count_weight = 1.0, names_weight = 1.0, relations_weight = 1.0;
  // Probability that names are a subset of the scene's names "and some other objects".
  double subset = 0.5;
  int most_relations = 5;  // a prompt has 1 to this many statements, uniformly

  bool IsValid(std::string* error) const;
};

// Draws a prompt that the scene satisfies. Welded objects are furniture and not named.
//   count      the number of free objects
//   names      all names with their counts, in random order, or a random subset of 1 to all but one
//              of the names, each with its full count, "and some other objects"
//   relations  the same, and statements that hold between objects of these names: for each a
//              relation (or "on a shelf's tier") uniform among those that occur, so that rare ones
//              are not lost among the frequent ones, then a pair uniform among those in it. No pair
//              comes twice. Facing is not drawn, and on is not drawn where inside holds.
// Objects of a name that occurs more than once have ordinals. Deterministic in the state of the
// generator. Throws core::Error for invalid options or a free category without a size.
Prompt DrawPrompt(const std::vector<SceneObject>& objects, const CategorySizes& sizes,
                  const PromptDrawingOptions& options, core::Rng& rng);

// Draws prompts from tokens of one vocabulary: as DrawPrompt does, but without looking up the
// categories each time. Thread-safe: Draw changes nothing but the generator.
class PromptDrawing {
 public:
  // Throws core::Error for invalid options, or a category that is free or a shelf and has no size.
  PromptDrawing(const Vocabulary& vocabulary, const CategorySizes& sizes,
                const PromptDrawingOptions& options = {});
  ~PromptDrawing();
  PromptDrawing(PromptDrawing&&) noexcept;
  PromptDrawing& operator=(PromptDrawing&&) noexcept;

  // Returns a prompt for one scene (entries x TokenWidth), whose poses are in metres and whose
  // matrices are rotations.
  Prompt Draw(const float* tokens, core::Rng& rng) const;

 private:
  struct Categories;
  std::unique_ptr<const Categories> categories_;
};

}  // namespace simwright::scene
