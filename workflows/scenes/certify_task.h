#pragma once

#include <string>
#include <vector>

#include "core/finding.h"
#include "scene/prompt/prompt.h"

namespace simwright::workflows {

enum class CertifyKind { kFront, kBeside, kLift };

// A task of `scene certify`, as it was read.
struct CertifyTask {
  CertifyKind kind = CertifyKind::kFront;
  scene::ObjectReference object;  // ordinal 0: any of its name
  scene::ObjectReference other;   // kBeside

  // Returns the task in a fixed wording: "bring the second apple next to the bowl".
  std::string Text() const;
};

// Reads a task: "bring OBJECT to the front", "bring OBJECT to OTHER" or "lift OBJECT". Verbs have
// synonyms (move, take, get, fetch, put; pick up, raise), objects those of scene::ReadPrompt, and
// ordinals ("the second apple"). Adds notes on words that were chosen or ignored. Throws
// core::Error for a task of another form, and for an object that is not known, naming the nearest.
CertifyTask ReadCertifyTask(const std::string& text, const std::vector<std::string>& known_names,
                            core::Findings* findings);

}  // namespace simwright::workflows
