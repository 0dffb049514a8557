#pragma once

#include <vector>

#include "core/random.h"
#include "scene/prompt/prompt.h"

namespace simwright::scene {

// Returns the published agreement of a number of objects, max(0, 1 - ln(1 + |asked - there|) /
// ln(1 + asked)) (Pfaff et al., Steerable Scene Generation, prompt following: APF). For asked = 0,
// where it is undefined, 1 for an empty scene and 0 for others.
double CountAgreement(int asked, int there);

// Returns the published agreement of names, sum n_i max(0, 1 - D_i / n_i) / sum n_i, where n_i
// objects of name i are asked for and D_i = |n_i - there_i|. With `and_others` a surplus is free:
// D_i = max(0, n_i - there_i). A name with n_i = 0, which the formula ignores, has weight 1 and
// agrees if there are none. Returns 1 without names. `there` is parallel to `names`.
double NamesAgreement(const std::vector<NamedCount>& names, const std::vector<int>& there,
                      bool and_others);

// The agreement of a scene with a prompt.
struct PromptAgreement {
  // APF: CountAgreement for a prompt with a count, NamesAgreement for one with names, their mean
  // for both; 1 for the empty prompt. Relations have no part in it, as published.
  double apf = 1.0;
  int statements = 0;  // relations and tiers asked for
  int held = 0;        // those that hold
  // 1 for each statement that holds: the prompt's relations, then its tiers.
  std::vector<char> holds = {};
  // Those that hold for any pair of objects of these names, whatever their ordinals.
  int held_by_any = 0;
  // True if every count is exact (with others: at least reached; without: no object of another
  // name) and every statement holds.
  bool strict = true;

  // Returns held / statements; 1 without statements.
  double StatementShare() const { return statements == 0 ? 1.0 : double(held) / statements; }
};

// Compares a scene with a valid prompt. A statement holds if Holds is true for the objects that its
// ordinals select in the scene, in OrdinalOrder; a reference without ordinal may be any object of
// its name, in each statement separately. Objects that the scene lacks make a statement false.
// Furniture is ignored, but for the shelves of tiers. Throws core::Error for an invalid prompt or a
// free category without a size.
PromptAgreement AgreementWith(const Prompt& prompt, const std::vector<SceneObject>& objects,
                              const CategorySizes& sizes);

// Returns the chance level of StatementShare: the mean over `shuffles` of its value after the
// positions of the scene's free objects are permuted at random, each object keeping its rotation.
// The gain of a model over it comes from relations, not from the objects and places of the scene
// type. Throws core::Error as AgreementWith does, and for shuffles < 1.
double ChanceStatementShare(const Prompt& prompt, const std::vector<SceneObject>& objects,
                            const CategorySizes& sizes, int shuffles, core::Rng& rng);

}  // namespace simwright::scene
