#include "workflows/scenes/prompt_evaluation.h"

#include <cstdio>

#include "core/parallel.h"
#include "scene/prompt/prompt_agreement.h"

namespace simwright::workflows {
namespace {

constexpr int kShuffles = 10;  // per scene, for the chance level
constexpr std::uint64_t kShuffleSeed = 0x73687566;

struct Agreement {
  scene::PromptAgreement with;
  double chance = 0.0;
};

double MeanOf(double sum, int count) {
  return count > 0 ? sum / count : 0.0;
}

std::string PercentLine(const char* name, double share) {
  char line[96];
  std::snprintf(line, sizeof line, "  %-44s %6.1f %%\n", name, 100.0 * share);
  return line;
}

}  // namespace

PromptMetrics MeasurePrompts(const std::vector<scene::Prompt>& prompts,
                             const std::vector<std::vector<scene::SceneObject>>& scenes,
                             const std::vector<std::vector<scene::SceneObject>>& reference,
                             const scene::CategorySizes& sizes, core::Progress* progress) {
  std::vector<Agreement> agreements(scenes.size());
  progress->Stage("prompts", static_cast<int>(scenes.size()));
  core::ParallelFor(static_cast<int>(scenes.size()), [&](int i) {
    const auto at = static_cast<size_t>(i);
    const scene::Prompt& prompt = prompts[at % prompts.size()];
    agreements[at].with = AgreementWith(prompt, scenes[at], sizes);
    if (agreements[at].with.statements > 0) {
      core::Rng rng = core::StreamRng(kShuffleSeed, static_cast<std::uint64_t>(i));
      agreements[at].chance = ChanceStatementShare(prompt, scenes[at], sizes, kShuffles, rng);
    }
    progress->Advance();
  });
  PromptMetrics metrics;
  for (size_t i = 0; i < scenes.size(); ++i) {
    const Agreement& one = agreements[i];
    metrics.strict += one.with.strict;
    switch (prompts[i % prompts.size()].kind) {
      case scene::PromptKind::kCount:
        ++metrics.counts;
        metrics.count_apf += one.with.apf;
        break;
      case scene::PromptKind::kNames:
        ++metrics.names;
        metrics.names_apf += one.with.apf;
        break;
      case scene::PromptKind::kRelations:
        ++metrics.relations;
        metrics.held += one.with.StatementShare();
        metrics.held_by_any += static_cast<double>(one.with.held_by_any) / one.with.statements;
        metrics.held_by_chance += one.chance;
        break;
      case scene::PromptKind::kEmpty:
        break;
    }
  }
  metrics.apf = MeanOf(metrics.count_apf + metrics.names_apf, metrics.counts + metrics.names);
  metrics.count_apf = MeanOf(metrics.count_apf, metrics.counts);
  metrics.names_apf = MeanOf(metrics.names_apf, metrics.names);
  metrics.strict = MeanOf(metrics.strict, static_cast<int>(scenes.size()));
  for (double* const sum : {&metrics.held, &metrics.held_by_any, &metrics.held_by_chance}) {
    *sum = MeanOf(*sum, metrics.relations);
  }
  double held = 0.0;
  int with_relations = 0;
  for (size_t i = 0; i < std::min(reference.size(), prompts.size()); ++i) {
    if (prompts[i].kind != scene::PromptKind::kRelations) continue;
    held += AgreementWith(prompts[i], reference[i], sizes).StatementShare();
    ++with_relations;
  }
  if (with_relations > 0) metrics.held_in_reference = held / with_relations;
  return metrics;
}

std::string PromptMetricsTable(const PromptMetrics& metrics) {
  char line[160];
  std::snprintf(line, sizeof line,
                "agreement with the prompts (APF): %.3f; of %d counts %.3f, of %d lists of names "
                "%.3f\n",
                metrics.apf, metrics.counts, metrics.count_apf, metrics.names, metrics.names_apf);
  std::string text = line;
  text += PercentLine("prompts followed exactly", metrics.strict);
  if (metrics.relations == 0) return text;
  std::snprintf(line, sizeof line, "relations of %d prompts\n", metrics.relations);
  text += line + PercentLine("hold", metrics.held) +
          PercentLine("hold whatever the ordinals", metrics.held_by_any) +
          PercentLine("hold by chance, positions permuted", metrics.held_by_chance);
  if (metrics.held_in_reference) {
    text += PercentLine("hold in the scenes they were drawn from", *metrics.held_in_reference);
  }
  return text;
}

core::OrderedJson PromptMetricsJson(const PromptMetrics& metrics) {
  core::OrderedJson json = {{"counts", metrics.counts},       {"names", metrics.names},
                            {"relations", metrics.relations}, {"apf", metrics.apf},
                            {"count_apf", metrics.count_apf}, {"names_apf", metrics.names_apf},
                            {"strict_share", metrics.strict}};
  if (metrics.relations == 0) return json;
  json["relations_held_share"] = metrics.held;
  json["relations_held_by_any_share"] = metrics.held_by_any;
  json["relations_by_chance_share"] = metrics.held_by_chance;
  if (metrics.held_in_reference) {
    json["relations_in_reference_share"] = *metrics.held_in_reference;
  }
  return json;
}

}  // namespace simwright::workflows
