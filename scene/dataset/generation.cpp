#include "scene/dataset/generation.h"

#include <algorithm>

#include "core/error.h"
#include "core/json.h"
#include "core/parallel.h"
#include "scene/dataset/tokens.h"
#include "scene/grammar/scene_sample.h"
#include "scene/prompt/prompt_drawing.h"

namespace simwright::scene {
namespace {

// Separates the random streams of prompts from those of scenes.
constexpr std::uint64_t kPromptSeed = 0x70726f6d7074ull;

struct Made {
  SceneAttempt attempt;
  std::vector<SceneObject> objects;
};

std::uint64_t StreamOf(const ShardOrigin& origin, size_t attempt) {
  return (static_cast<std::uint64_t>(origin.part) << 32) + attempt;
}

Made Attempt(const Generation& generation, const ShardOrigin& origin, size_t index) {
  core::Rng rng = core::StreamRng(origin.seed, StreamOf(origin, index));
  const SceneSample sample = SampleGrammar(generation.grammar, rng);
  if (generation.raw) {
    const auto count = static_cast<int>(sample.objects.size());
    return {{count, count, 0, false, true, 0.0, 0.0, 0.0}, sample.objects};
  }
  FeasibleScene scene = MakeFeasible(sample.objects, *generation.asset_set, generation.feasibility);
  Made made;
  made.attempt = AttemptOf(scene, static_cast<int>(sample.objects.size()));
  made.objects = std::move(scene.objects);
  return made;
}

void Keep(const Made& made, SceneShard* part) {
  part->attempts.push_back(made.attempt);
  if (!made.attempt.valid) return;
  const size_t size = static_cast<size_t>(part->vocabulary.entries) *
                      static_cast<size_t>(part->vocabulary.TokenWidth());
  part->tokens.resize(part->tokens.size() + size);
  EncodeScene(made.objects, part->vocabulary, &part->tokens[part->tokens.size() - size]);
}

// Draws the prompts of all scenes that have none yet. They are drawn from the tokens, so that a
// shard without prompts gets the same ones as a new shard.
void AddPrompts(const Generation& generation, SceneShard* part) {
  if (part->prompts.size() == static_cast<size_t>(part->SceneCount())) return;
  const PromptDrawing drawing(part->vocabulary, generation.asset_set->Sizes());
  const size_t size = static_cast<size_t>(part->vocabulary.entries) *
                      static_cast<size_t>(part->vocabulary.TokenWidth());
  size_t scene = 0;
  for (size_t attempt = 0; attempt < part->attempts.size(); ++attempt) {
    if (!part->attempts[attempt].valid) continue;
    if (scene >= part->prompts.size()) {
      core::Rng rng =
          core::StreamRng(part->origin.seed ^ kPromptSeed, StreamOf(part->origin, attempt));
      part->prompts.push_back(drawing.Draw(&part->tokens[scene * size], rng).Text());
    }
    ++scene;
  }
}

[[noreturn]] void GiveUp(const SceneShard& part) {
  int dropped = 0, jammed = 0;
  for (const SceneAttempt& one : part.attempts) {
    dropped += one.dropped > 0;
    jammed += !one.projected;
  }
  const auto of = [](int count) { return std::to_string(count); };
  throw core::Error("of " + std::to_string(part.attempts.size()) + " scenes " +
                        of(part.SceneCount()) + " are valid; penetrations cannot be resolved in " +
                        of(jammed) + ", objects fell, toppled or did not come to rest in " +
                        of(dropped),
                    part.vocabulary.type, "check the assets: sizes, bases, collision parts");
}

}  // namespace

void ExtendShard(const Generation& generation, int scenes, SceneShard* part,
                 core::Progress* progress) {
  const int most = generation.attempts_per_scene * scenes;
  int have = part->SceneCount();
  AddPrompts(generation, part);
  while (have < scenes) {
    if (static_cast<int>(part->attempts.size()) >= most) GiveUp(*part);
    // Each batch has the number of missing scenes, because some attempts fail; results beyond the
    // last needed one are discarded.
    std::vector<Made> made(static_cast<size_t>(scenes - have));
    std::vector<char> done(made.size(), 0);
    const size_t first = part->attempts.size();
    const auto keep = [&] {
      for (size_t i = 0; i < made.size() && done[i]; ++i) Keep(made[i], part);
      have = part->SceneCount();
      AddPrompts(generation, part);
    };
    try {
      core::ParallelFor(static_cast<int>(made.size()), [&](int i) {
        core::CheckCancelled();
        const auto index = static_cast<size_t>(i);
        made[index] = Attempt(generation, part->origin, first + index);
        done[index] = 1;
        if (made[index].attempt.valid) progress->Advance();
      });
    } catch (const core::Cancelled&) {
      keep();
      throw;
    }
    keep();
  }
}

// The revision of grammars and physics: incremented whenever equal settings give other scenes. 2:
// contacts at all corners of faces; pantries without coincident objects. 3: the stability check
// ends earlier.
constexpr int kRevision = 3;

std::string SettingsText(const Generation& generation) {
  const FeasibilityOptions& feasible = generation.feasibility;
  core::OrderedJson json;
  json["revision"] = kRevision;
  json["grammar"] = generation.grammar.name();
  if (generation.raw) {
    json["raw"] = true;
    return core::JsonLine(json);
  }
  json["projection"] = {{"influence", feasible.projection.contact_margin},
                        {"tolerance", feasible.projection.tolerance},
                        {"rounds", feasible.projection.rounds}};
  json["settling"] = {{"duration", feasible.settling.duration},
                      {"watch", feasible.settling.watch},
                      {"time_step", feasible.settling.time_step},
                      {"solver_iterations", feasible.settling.solver_iterations},
                      {"stable", feasible.settling.stable},
                      {"resting", feasible.settling.rest_tolerance},
                      {"pace", feasible.settling.early_stop_factor},
                      {"sway", feasible.settling.gravity_tilt},
                      {"sway_time", feasible.settling.gravity_tilt_time},
                      {"settling_friction", feasible.settling.settling_friction},
                      {"fallen", feasible.settling.fall_distance}};
  json["lowering"] = feasible.lowering;
  json["tilted"] = feasible.tilted;
  json["may_lie"] = feasible.may_lie;
  json["penetration"] = feasible.penetration;
  json["fewest"] = feasible.min_objects;
  return core::JsonLine(json);
}

}  // namespace simwright::scene
