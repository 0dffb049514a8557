#include <cstdio>

#include "core/finding_json.h"
#include "core/json.h"
#include "workflows/scenes/scene_evaluation.h"

namespace simwright::workflows {
namespace {

constexpr double kOneInTenThousand = 1e4, kCentimetres = 100.0;

// Formats one line with the values of samples and of training scenes.
std::string EvaluationLine(const char* name, const std::string& samples,
                           const std::string& training) {
  char line[160];
  std::snprintf(line, sizeof line, "%-34s %14s %14s\n", name, samples.c_str(), training.c_str());
  return line;
}

std::string TableFigure(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string Accuracy(const SceneSetMetrics& set, size_t i) {
  return TableFigure("%.1f", set.accuracy[i].percent) + " +- " +
         TableFigure("%.1f", set.accuracy[i].deviation);
}

std::string SetLines(const SceneSetMetrics& samples, const std::optional<SceneSetMetrics>& other) {
  const auto line = [&](const char* name, const auto& cell) {
    return EvaluationLine(name, cell(samples), other ? cell(*other) : "");
  };
  std::string text =
      line("scenes", [](const SceneSetMetrics& set) { return std::to_string(set.scenes); });
  text += line("objects, mean",
               [](const SceneSetMetrics& set) { return TableFigure("%.2f", set.mean_objects); });
  text += line("KL of asset frequencies x 1e4", [](const SceneSetMetrics& set) {
    return TableFigure("%.2f", kOneInTenThousand * set.divergence);
  });
  text += line("MTP, convex parts, cm", [](const SceneSetMetrics& set) {
    return TableFigure("%.3f", kCentimetres * set.penetration.median);
  });
  text += line("the same of bounding boxes, cm", [](const SceneSetMetrics& set) {
    return TableFigure("%.3f", kCentimetres * set.penetration.box_median);
  });
  if (!samples.frechet) return text;
  text += line("Frechet distance", [](const SceneSetMetrics& set) {
    return TableFigure("%.4f", set.frechet.value_or(0));
  });
  for (size_t i = 0; i < samples.accuracy.size(); ++i) {
    const std::string name =
        "classifier, " + std::to_string(samples.accuracy[i].passes) + " passes, %";
    text += line(name.c_str(), [&](const SceneSetMetrics& set) { return Accuracy(set, i); });
  }
  return text;
}

std::string DistanceLine(const char* name, const DistanceSummary& summary) {
  char line[160];
  std::snprintf(line, sizeof line, "  %-20s %8.3f %8.3f %8.3f %8.3f %8.3f\n", name, summary.mean,
                summary.least, summary.tenth, summary.median, summary.ninetieth);
  return line;
}

core::OrderedJson PenetrationJson(const PenetrationSummary& summary) {
  return {{"parts_median_cm", kCentimetres * summary.median},
          {"parts_mean_cm", kCentimetres * summary.mean},
          {"boxes_median_cm", kCentimetres * summary.box_median},
          {"boxes_mean_cm", kCentimetres * summary.box_mean}};
}

core::OrderedJson SetJson(const SceneSetMetrics& set) {
  core::OrderedJson json;
  json["scenes"] = set.scenes;
  json["objects_mean"] = set.mean_objects;
  json["kl_1e4"] = kOneInTenThousand * set.divergence;
  json["penetration"] = PenetrationJson(set.penetration);
  if (set.frechet) json["frechet"] = *set.frechet;
  for (const scene::AccuracyScore& one : set.accuracy) {
    json["classifier_accuracy"].push_back(
        {{"passes", one.passes}, {"percent", one.percent}, {"deviation", one.deviation}});
  }
  return json;
}

core::OrderedJson DistanceJson(const DistanceSummary& summary) {
  return {{"mean", summary.mean},
          {"least", summary.least},
          {"tenth", summary.tenth},
          {"median", summary.median},
          {"ninetieth", summary.ninetieth}};
}

}  // namespace

std::string EvaluationTable(const SceneEvaluation& evaluation) {
  std::string text =
      evaluation.type + ", against " + std::to_string(evaluation.reference_scenes) +
      (evaluation.reference_is_held_out ? " held-out" : " training") +
      " scenes; features: " + (evaluation.features.empty() ? "none" : evaluation.features) + "\n";
  text += EvaluationLine("", "samples", evaluation.training ? "training" : "");
  text += SetLines(evaluation.samples, evaluation.training);
  char line[160];
  std::snprintf(line, sizeof line, "MTP of the %s scenes: %.3f cm, of bounding boxes %.3f cm\n",
                evaluation.reference_is_held_out ? "held-out" : "training",
                kCentimetres * evaluation.reference_penetration.median,
                kCentimetres * evaluation.reference_penetration.box_median);
  text += line;
  if (evaluation.prompts) text += PromptMetricsTable(*evaluation.prompts);
  if (evaluation.sample_distance) {
    std::snprintf(line, sizeof line,
                  "distance to the nearest of %d training scenes, m\n  %-20s %8s %8s %8s %8s %8s\n",
                  evaluation.training_scenes, "", "mean", "least", "10%", "50%", "90%");
    text += line;
    text += DistanceLine("samples", *evaluation.sample_distance);
    if (evaluation.held_out_distance) {
      text += DistanceLine("held-out scenes", *evaluation.held_out_distance);
    }
  }
  return text;
}

std::string EvaluationJson(const SceneEvaluation& evaluation) {
  core::OrderedJson json;
  json["type"] = evaluation.type;
  json["features"] = evaluation.features;
  json["classifier_rate"] = evaluation.learning_rate;
  json["reference"] = {{"scenes", evaluation.reference_scenes},
                       {"held_out", evaluation.reference_is_held_out},
                       {"penetration", PenetrationJson(evaluation.reference_penetration)}};
  json["samples"] = SetJson(evaluation.samples);
  if (evaluation.training) json["training"] = SetJson(*evaluation.training);
  if (evaluation.prompts) json["prompts"] = PromptMetricsJson(*evaluation.prompts);
  json["training_scenes"] = evaluation.training_scenes;
  if (evaluation.sample_distance) {
    core::OrderedJson& nearest = json["nearest_training_scene_m"];
    nearest["lever"] = evaluation.distance.lever;
    nearest["cut_off"] = evaluation.distance.cut_off;
    nearest["samples"] = DistanceJson(*evaluation.sample_distance);
    if (evaluation.held_out_distance) {
      nearest["held_out"] = DistanceJson(*evaluation.held_out_distance);
    }
  }
  json["findings"] = core::FindingsJson(evaluation.findings);
  json["seconds"] = evaluation.seconds;
  return core::JsonText(json);
}

}  // namespace simwright::workflows
