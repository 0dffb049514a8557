// Compares scene models as in the paper's Table 1: ours, MiDiffusion and DiffuScene on the same
// data with the same number of updates, with several seeds each. Each call trains and evaluates one
// cell into OUT/METHOD_SEED; without --method it prints the table of the finished cells.
//   bench_scene_table --data out/dimsum -o out/table --method ours --seed 1
//   bench_scene_table --data out/dimsum -o out/table
#include <cmath>
#include <cstdio>
#include <map>

#include <CLI/CLI.hpp>

#include "core/files.h"
#include "core/json.h"
#include "core/parallel.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/model/training.h"
#include "workflows/scenes/scene_evaluation.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

// "ours_paper_loss": ours with the paper's weight of the class loss; "ours_paper_poses": predicts
// the noise itself, and samples times uniformly.
const std::vector<std::string> kMethods = {"ours",       "ours_paper_poses", "ours_paper_loss",
                                           "continuous", "midiffusion",      "diffuscene"};

struct Arguments {
  fs::path data, output, features;
  std::string method, size = "tiny";
  std::uint64_t seed = 1;
  double held_out = 1.0 / 6.0;  // 1000 of 6000, as many as the samples
  int steps = 10000, batch = 32, count = 1000, sample_steps = 0;
};

scene::SceneModelOptions ModelOf(const Arguments& arguments) {
  scene::SceneModelOptions model = scene::SceneModelOptions::OfSize(arguments.size);
  if (arguments.method == "ours_paper_loss") model.class_weight = 1.0;
  if (arguments.method == "ours_paper_poses") {
    model.blends_clean_poses = false;
    model.time_power = 1.0;
  }
  if (arguments.method == "continuous") model.continuous = true;
  if (arguments.method == "midiffusion") return model.AsMiDiffusion();
  if (arguments.method == "diffuscene") return model.AsDiffuScene();
  return model;
}

void MakeCell(const Arguments& arguments) {
  const fs::path cell =
      arguments.output / (arguments.method + "_" + std::to_string(arguments.seed));
  if (fs::exists(cell / "cell.json")) {
    std::printf("%s already exists\n", cell.c_str());
    return;
  }
  core::Progress progress(core::Progress::StyleForStderr());
  const scene::SceneDataset dataset(arguments.data);
  scene::SceneTrainingOptions options;
  options.trainer.steps = arguments.steps;
  options.trainer.resume = true;
  options.trainer.save_every = 250;
  options.batch = arguments.batch;
  options.held_out = arguments.held_out;
  options.seed = arguments.seed;
  const bool resumed = fs::exists(cell / scene::kStateFile);  // its total time is unknown
  const scene::SceneTrainingReport trained =
      scene::TrainSceneModel(dataset, ModelOf(arguments), options, cell, &progress);
  workflows::SceneEvaluationRequest request;
  request.data = arguments.data;
  request.weights = trained.weights;
  request.training_scenes = trained.training_scenes;
  request.count = arguments.count;
  request.assets = {arguments.data / "assets"};
  request.features = arguments.features;
  request.sampling.seed = arguments.seed;
  request.sampling.steps = arguments.sample_steps;
  request.output = cell / "evaluation";
  const workflows::SceneEvaluation evaluation = workflows::EvaluateScenes(request, &progress);
  progress.Finish();
  core::OrderedJson json = core::ParseOrderedJson(EvaluationJson(evaluation), "the evaluation");
  json["run"] = {{"steps", arguments.steps},
                 {"batch", arguments.batch},
                 {"parameters", trained.parameters},
                 {"seconds", resumed ? NAN : trained.seconds},
                 {"held_out_loss", trained.losses.back().held_out}};
  core::WriteFile(cell / "cell.json", core::JsonText(json));
  std::fputs(EvaluationTable(evaluation).c_str(), stdout);
}

// A cell's row of the table.
struct Row {
  double accuracy = NAN, divergence = NAN, frechet = NAN, objects = NAN;
  double penetration = NAN, boxes = NAN, nearest = NAN;  // cm, cm, m
  double seconds = NAN, parameters = NAN;
};

using Column = double Row::*;

std::string MeanAndInterval(const std::vector<Row>& rows, Column column, double scale,
                            const char* format) {
  double mean = 0.0, spread = 0.0;
  for (const Row& row : rows) mean += scale * (row.*column) / static_cast<double>(rows.size());
  for (const Row& row : rows) spread += std::pow(scale * (row.*column) - mean, 2);
  char text[64];
  std::snprintf(text, sizeof text, format, mean);
  std::string cell = text;
  if (rows.size() < 2) return cell;
  // The 95 % quantile of Student's t with n - 1 degrees of freedom.
  static const double kT[] = {12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26};
  const size_t n = rows.size();
  const double t = n - 2 < std::size(kT) ? kT[n - 2] : 1.96;
  std::snprintf(text, sizeof text, format,
                t * std::sqrt(spread / static_cast<double>(n - 1) / static_cast<double>(n)));
  return cell + " +- " + text;
}

Row RowOf(const core::Json& json) {
  const auto number = [](const core::Json& at, const char* name) {
    return at.contains(name) && at[name].is_number() ? at[name].get<double>() : NAN;
  };
  Row row;
  const core::Json& samples = json.at("samples");
  row.divergence = number(samples, "kl_1e4");
  row.frechet = number(samples, "frechet");
  row.penetration = number(samples.at("penetration"), "parts_median_cm");
  row.boxes = number(samples.at("penetration"), "boxes_median_cm");
  if (json.contains("nearest_training_scene_m")) {
    row.nearest = number(json["nearest_training_scene_m"].at("samples"), "mean");
  }
  row.objects = number(samples, "objects_mean");
  if (samples.contains("classifier_accuracy") && !samples["classifier_accuracy"].empty()) {
    row.accuracy = number(samples["classifier_accuracy"].back(), "percent");
  }
  row.seconds = number(json.at("run"), "seconds");
  row.parameters = number(json.at("run"), "parameters");
  return row;
}

void PrintTable(const fs::path& output) {
  std::map<std::string, std::vector<Row>> rows;
  for (const fs::directory_entry& entry : fs::directory_iterator(output)) {
    const fs::path file = entry.path() / "cell.json";
    if (!fs::exists(file)) continue;
    const std::string name = entry.path().filename().string();
    rows[name.substr(0, name.rfind('_'))].push_back(
        RowOf(core::ParseJson(core::ReadFile(file), file.string())));
  }
  std::printf("%-16s %5s %9s %13s %13s %15s %15s %13s %13s %13s %6s\n", "method", "seeds",
              "weights", "CA %", "KL x1e4", "Frechet", "MTP cm", "of AABBs", "nearest m", "objects",
              "s");
  for (const std::string& method : kMethods) {
    const auto found = rows.find(method);
    if (found == rows.end()) continue;
    const std::vector<Row>& cells = found->second;
    std::printf("%-16s %5zu %9s %13s %13s %15s %15s %13s %13s %13s %6s\n", method.c_str(),
                cells.size(), MeanAndInterval({cells[0]}, &Row::parameters, 1.0, "%.0f").c_str(),
                MeanAndInterval(cells, &Row::accuracy, 1.0, "%.1f").c_str(),
                MeanAndInterval(cells, &Row::divergence, 1.0, "%.2f").c_str(),
                MeanAndInterval(cells, &Row::frechet, 1.0, "%.3f").c_str(),
                MeanAndInterval(cells, &Row::penetration, 1.0, "%.2f").c_str(),
                MeanAndInterval(cells, &Row::boxes, 1.0, "%.1f").c_str(),
                MeanAndInterval(cells, &Row::nearest, 1.0, "%.2f").c_str(),
                MeanAndInterval(cells, &Row::objects, 1.0, "%.1f").c_str(),
                MeanAndInterval({cells[0]}, &Row::seconds, 1.0, "%.0f").c_str());
  }
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  CLI::App app("Comparison of scene models");
  simwright::Arguments arguments;
  app.add_option("--data", arguments.data, "Dataset of scenes")->required();
  app.add_option("-o,--output", arguments.output, "Output folder of the cells")->required();
  app.add_option("--method", arguments.method, "Cell to train and evaluate; none: print the table")
      ->check(CLI::IsMember(simwright::kMethods));
  app.add_option("--seed", arguments.seed, "Seed of the cell")->capture_default_str();
  app.add_option("--size", arguments.size, "tiny, base or full")->capture_default_str();
  app.add_option("--steps", arguments.steps, "Updates")->capture_default_str();
  app.add_option("--held-out", arguments.held_out, "Share of held-out scenes, at most 1000")
      ->capture_default_str();
  app.add_option("--batch", arguments.batch, "Scenes per update")->capture_default_str();
  app.add_option("--count", arguments.count, "Samples to evaluate")->capture_default_str();
  app.add_option("--sample-steps", arguments.sample_steps, "Diffusion steps of sampling, 0: all")
      ->capture_default_str();
  app.add_option("--features", arguments.features, "TorchScript module instead of ours");
  CLI11_PARSE(app, argc, argv);
  try {
    simwright::core::InstallCancelHandler();
    simwright::core::SetThreadCount(0);
    if (!arguments.method.empty()) simwright::MakeCell(arguments);
    simwright::PrintTable(arguments.output);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
