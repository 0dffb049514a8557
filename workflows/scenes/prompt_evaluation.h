#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/json.h"
#include "core/progress.h"
#include "scene/grammar/category_size.h"
#include "scene/grammar/scene_sample.h"
#include "scene/prompt/prompt.h"

namespace simwright::workflows {

// The agreement of a set of scenes with their prompts, means over the prompts of a kind.
struct PromptMetrics {
  int counts = 0, names = 0, relations = 0;  // prompts of each kind
  double count_apf = 0.0, names_apf = 0.0;   // of the first two kinds
  // APF as published: over the prompts of the first two kinds.
  double apf = 0.0;
  double strict = 0.0;  // share of all prompts that are followed exactly
  // The mean share of a prompt's relations that holds, over the prompts with relations; the same
  // whatever the ordinals are; by chance, with the positions of a scene's objects permuted; and in
  // the reference scenes, from which the prompts were drawn, if these are known.
  double held = 0.0, held_by_any = 0.0, held_by_chance = 0.0;
  std::optional<double> held_in_reference;
};

// Compares scene i with prompts[i % n]. `reference`: the scenes that the prompts were drawn from,
// in their order, or empty. Requires a prompt. Runs in parallel; deterministic.
PromptMetrics MeasurePrompts(const std::vector<scene::Prompt>& prompts,
                             const std::vector<std::vector<scene::SceneObject>>& scenes,
                             const std::vector<std::vector<scene::SceneObject>>& reference,
                             const scene::CategorySizes& sizes, core::Progress* progress);

// Format the metrics as lines for people and as JSON.
std::string PromptMetricsTable(const PromptMetrics& metrics);
core::OrderedJson PromptMetricsJson(const PromptMetrics& metrics);

}  // namespace simwright::workflows
