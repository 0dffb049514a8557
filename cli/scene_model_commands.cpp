#include "cli/scene_model_commands.h"

#include <cstdio>
#include <memory>
#include <optional>

#include "cli/category_folders.h"
#include "cli/findings_output.h"
#include "cli/scene_sampling_options.h"
#include "core/error.h"
#include "core/folder_lock.h"
#include "core/json.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/model/training.h"
#include "workflows/scenes/scene_sampling.h"
#include "workflows/scenes/scene_shapes.h"

namespace simwright::cli {
namespace {

constexpr int kShapePoints = 256;  // for --by-shape

struct TrainFlags {
  std::vector<std::filesystem::path> datasets;
  std::filesystem::path output, assets;
  bool by_shape = false, text = false;
  std::string size = "tiny", method = "ours";
  scene::SceneTrainingOptions options;
};

scene::SceneModelOptions ModelOf(const TrainFlags& flags) {
  scene::SceneModelOptions model = scene::SceneModelOptions::OfSize(flags.size);
  if (flags.method == "continuous") model.continuous = true;
  if (flags.by_shape) model.shape_points = kShapePoints;
  model.text = flags.text || !flags.options.text_encoder.empty();
  if (flags.method == "midiffusion") return model.AsMiDiffusion();
  if (flags.method == "diffuscene") return model.AsDiffuScene();
  return model;
}

core::OrderedJson ReportJson(const scene::SceneTrainingReport& report) {
  core::OrderedJson json;
  json["weights"] = report.weights.string();
  json["parameters"] = report.parameters;
  json["training_scenes"] = report.training_scenes;
  json["held_out_scenes"] = report.held_out_scenes;
  json["seconds"] = report.seconds;
  if (!report.losses.empty()) {
    json["loss"] = report.losses.back().total;
    json["held_out_loss"] = report.losses.back().held_out;
  }
  return json;
}

// Reads the shapes and sizes of the datasets' assets that the model needs.
void ReadAssets(const std::vector<scene::SceneDataset>& datasets,
                const scene::SceneModelOptions& model, TrainFlags* flags) {
  for (size_t i = 0; i < datasets.size(); ++i) {
    const scene::Vocabulary& vocabulary = datasets[i].vocabulary();
    if (model.shape_points > 0) {
      flags->options.shapes = workflows::ShapesOfDataset(flags->datasets[i], flags->assets,
                                                         vocabulary, model.shape_points);
    }
    if (!model.text) continue;
    for (const auto& [category, size] :
         workflows::SizesOfDataset(flags->datasets[i], flags->assets, vocabulary)) {
      if (i == 0 || vocabulary.ClassOf(category) >= 0) flags->options.sizes[category] = size;
    }
  }
}

int TrainSceneModel(TrainFlags flags, const CommonOptions& common) {
  flags.options.seed = common.seed;
  const std::filesystem::path weights = flags.output / scene::kWeightsFile;
  if (std::filesystem::exists(weights) && !flags.options.trainer.resume && !common.force) {
    throw core::Error("a model already exists", weights.string(),
                      "continue with --resume, choose another folder, or replace it with --force");
  }
  const std::vector<scene::SceneDataset> datasets(flags.datasets.begin(), flags.datasets.end());
  const scene::SceneModelOptions model = ModelOf(flags);
  ReadAssets(datasets, model, &flags);
  std::vector<const scene::SceneDataset*> pointers;
  for (const scene::SceneDataset& one : datasets) pointers.push_back(&one);
  std::optional<core::FolderLock> lock;
  if (std::filesystem::exists(flags.output)) lock.emplace(flags.output, "a training");
  core::Progress progress(common.ProgressStyle());
  scene::SceneTrainingReport report;
  try {
    report = scene::TrainSceneModel(pointers, model, flags.options, flags.output, &progress);
  } catch (const core::Cancelled&) {
    if (!std::filesystem::exists(flags.output / scene::kStateFile)) throw;
    progress.Finish();
    return ReportStopped(flags.output);
  }
  if (common.json) {
    PrintJson(ReportJson(report), {});
    return 0;
  }
  std::printf("%s: %lld parameters, %d scenes, %d held out, %.0f s\n", report.weights.c_str(),
              static_cast<long long>(report.parameters), report.training_scenes,
              report.held_out_scenes, report.seconds);
  if (!report.losses.empty()) {
    std::printf("loss %.4f, on held-out scenes %.4f\n", report.losses.back().total,
                report.losses.back().held_out);
  }
  return 0;
}

int Sample(workflows::SceneSamplingRequest request, const CommonOptions& common) {
  request.sampling.seed = common.seed;
  request.force = common.force;
  core::Progress progress(common.ProgressStyle());
  const workflows::SceneSamplingReport report = workflows::SampleScenes(request, &progress);
  if (common.json) {
    PrintJson(workflows::SamplingJson(report), report.statistics.findings);
    return 0;
  }
  PrintFindings(report.statistics.findings, common);
  std::fputs(workflows::SamplingTable(report).c_str(), stdout);
  return 0;
}

}  // namespace

void AddSceneTrain(CLI::App* scene, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<TrainFlags>();
  scene::SceneTrainingOptions& options = flags->options;
  CLI::App* command =
      scene->add_subcommand("train", "Train a diffusion model on the scenes of a dataset");
  command->footer(
      "Examples:\n  simwright scene train out/dimsum -o out/dimsum_model\n"
      "  simwright scene train out/pantry out/shelves --text -o out/both\n"
      "--resume continues an interrupted run in the folder.");
  command
      ->add_option("datasets", flags->datasets,
                   "Datasets written by `simwright scene generate`; several scene types, one "
                   "dataset each, make one model, which reads the type in its prompts")
      ->required();
  command->add_option("-o,--output", flags->output, "The folder for weights and losses")
      ->required();
  command->add_option("--size", flags->size, "The network's size")
      ->capture_default_str()
      ->check(CLI::IsMember({"tiny", "base", "full"}));
  command->add_option("--method", flags->method, "ours, continuous, midiffusion or diffuscene")
      ->capture_default_str()
      ->check(CLI::IsMember({"ours", "continuous", "midiffusion", "diffuscene"}));
  command->add_flag(
      "--by-shape", flags->by_shape,
      "Embed categories by their assets' shapes, so that `sample --add` can add new ones");
  command
      ->add_option("--assets", flags->assets,
                   "With --by-shape or --text: the folder of the categories' assets")
      ->default_str("the dataset's");
  command->add_flag("--text", flags->text,
                    "Read prompts, drawn from the scenes, by a text encoder trained along");
  command->add_option("--text-encoder", options.text_encoder,
                      "Read prompts by this TorchScript module instead, which stays as it is; its "
                      "word pieces are in FILE.vocab.txt or vocab.txt beside it");
  command
      ->add_option("--prompt-dropout", options.prompt_dropout,
                   "With --text: fraction of scenes that train without a prompt")
      ->capture_default_str();
  command->add_option("--steps", options.trainer.steps, "Number of updates")->capture_default_str();
  command->add_option("--batch", options.batch, "Scenes per update")->capture_default_str();
  command->add_option("--rate", options.trainer.learning_rate, "Learning rate")
      ->capture_default_str();
  command->add_option("--held-out", options.held_out, "Fraction of scenes held out from training")
      ->capture_default_str();
  command->add_option("--save-every", options.trainer.save_every, "Updates between checkpoints")
      ->capture_default_str();
  command->add_flag("--cuda-graph", options.cuda_graph,
                    "Launch the kernels of an update on a GPU together, which makes small batches "
                    "faster; for models without prompts");
  command->add_flag("--device-noise", options.noise_on_device,
                    "Draw noise on the GPU, which is faster: other weights for the same seed");
  command->add_flag("--resume", options.trainer.resume, "Resume from the folder's checkpoint");
  AddCommon(command, common);
  AddDevice(command);
  AddForce(command, common);
  command->callback(
      [flags, common, run] { *run = [=] { return TrainSceneModel(*flags, *common); }; });
}

void AddSceneSample(CLI::App* scene, CommonOptions* common, Run* run) {
  auto request = std::make_shared<workflows::SceneSamplingRequest>();
  auto added = std::make_shared<std::vector<std::string>>();
  CLI::App* command =
      scene->add_subcommand("sample", "Sample new, physically valid scenes from a trained model");
  command->footer(
      "Examples:\n  simwright scene sample --type dimsum --steps 100 -o out/sampled\n"
      "  simwright scene sample out/dimsum_model/model.pt --count 20 -o out/sampled \\\n"
      "    --assets out/dimsum/assets\n"
      "  simwright scene sample --type pantry_shelf --prompt \"five apples next to a bowl\" -o "
      "out/apples\n"
      "  simwright scene sample --prompt \"a pantry shelf with two apples and a lamp\" -o "
      "out/mixed\n"
      "A prompt without weights and without --type is for the shipped model of all types.\n"
      "Without --raw, interpenetrations are resolved, objects are lowered onto their support and "
      "settled;\n"
      "objects that fall are dropped.");
  command->add_option("weights", request->weights, "A model written by `simwright scene train`");
  command->add_option("--type", request->type,
                      "The scene type: with its shipped weights, or of a model of several types");
  command->add_option("--count", request->count, "Number of scenes")->capture_default_str();
  command->add_option("-o,--output", request->output, "The folder for the scenes")->required();
  command->add_option("--assets", request->assets,
                      "Asset folders, matched by name or category; the library provides the rest");
  command->add_option("--add", *added, "SLOT=FOLDER: a new asset for a model trained --by-shape");
  command->add_option("--prompt", request->prompts,
                      "The wanted scene in words; several are taken in turn");
  command->add_option("--prompts", request->prompt_file, "A text file with a prompt per line");
  command->add_flag("--free-counts", request->free_counts,
                    "Let the network alone decide how many objects of each name there are, instead "
                    "of holding the samples to the counts of the prompt");
  command
      ->add_option("--guidance", request->sampling.guidance,
                   "Weight of classifier-free guidance: how far to follow the prompt; 0: none")
      ->capture_default_str();
  AddSceneSamplingOptions(command, &request->text_encoder, &request->sampling);
  command->add_option("--batch", request->sampling.batch, "Scenes per batch")
      ->capture_default_str();
  command->add_flag("--raw", request->raw,
                    "Keep the model's samples, with interpenetrations and unsupported objects");
  AddCommon(command, common);
  AddDevice(command);
  AddForce(command, common);
  command->callback([request, added, common, run] {
    *run = [=] {
      request->added = ParseCategoryFolders(*added, "--add");
      return Sample(*request, *common);
    };
  });
}

}  // namespace simwright::cli
