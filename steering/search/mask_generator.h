#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/prompt/prompt.h"
#include "steering/search/token_scene.h"

namespace simwright::steering {

// Says which entries of a scene a search synthesizes again; independent of its reward.
class MaskGenerator {
 public:
  virtual ~MaskGenerator() = default;

  // Returns one flag per entry. No flag set: nothing is left to do for this scene. Thread-safe.
  virtual std::vector<char> Mask(const TokenScene& scene) const = 0;
  virtual std::string Name() const = 0;
};

// Returns the mask of padding entries.
std::unique_ptr<MaskGenerator> EmptyMask(const scene::Vocabulary& vocabulary);
// Returns the mask of penetrating objects, both of a pair; furniture excluded.
std::unique_ptr<MaskGenerator> PenetratingMask();
// Returns the mask of unstable objects.
std::unique_ptr<MaskGenerator> UnstableMask();
// Returns the mask of objects that a prompt does not ask for, the last of a name first: more than
// it names, or, unless it allows others, of other names. Furniture is never masked.
std::unique_ptr<MaskGenerator> SurplusMask(const scene::Vocabulary& vocabulary,
                                           const scene::Prompt& prompt);
// Returns the mask of entries that any of `parts` masks.
std::unique_ptr<MaskGenerator> UnionMask(std::vector<std::unique_ptr<MaskGenerator>> parts);

// Returns the names of the masks that need no prompt: empty, penetrating, unstable.
const std::vector<std::string>& MaskNames();
// Returns the union of masks by name, "empty,unstable". Throws core::Error for an unknown or empty
// list, naming the known masks.
std::unique_ptr<MaskGenerator> MaskNamed(const std::string& names,
                                         const scene::Vocabulary& vocabulary);

}  // namespace simwright::steering
