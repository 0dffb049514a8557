#include "scene/model/weights_file.h"

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "nn/checkpoint.h"

namespace simwright::scene {
namespace {

constexpr char kKind[] = "scene model";

SceneModelOptions OptionsOf(const nlohmann::json& json) {
  SceneModelOptions options;
  options.kind = DenoiserNamed(json.at("denoiser"));
  options.continuous = json.at("continuous");
  options.width = json.at("width");
  options.heads = json.at("heads");
  options.double_blocks = json.at("double_blocks");
  options.single_blocks = json.at("single_blocks");
  options.diffusion_steps = json.at("diffusion_steps");
  options.class_weight = json.at("class_weight");
  options.blends_clean_poses = json.value("blends_clean_poses", false);
  options.time_power = json.value("time_power", 1.0);
  options.shape_points = json.value("shape_points", 0);
  return options;
}

SceneModelMetadata FactsOf(const nlohmann::json& json) {
  Vocabulary vocabulary;
  vocabulary.type = json.at("type");
  vocabulary.entries = json.at("entries");
  vocabulary.categories = json.at("slots").get<std::vector<std::string>>();
  vocabulary.welded = json.at("welded").get<std::vector<bool>>();
  SceneModelMetadata facts{vocabulary, OptionsOf(json), PoseRange::FromText(json.at("range"))};
  facts.training_scenes = json.at("training_scenes");
  facts.data_seed = json.at("data_seed");
  facts.steps = json.at("steps");
  return facts;
}

}  // namespace

void WriteWeights(const Denoiser& denoiser, const SceneModelMetadata& facts,
                  const std::filesystem::path& path) {
  nlohmann::ordered_json json;
  json["type"] = facts.vocabulary.type;
  json["entries"] = facts.vocabulary.entries;
  json["slots"] = facts.vocabulary.categories;
  json["welded"] = facts.vocabulary.welded;
  json["range"] = facts.range.Text();
  json["denoiser"] = NameOf(facts.options.kind);
  json["continuous"] = facts.options.continuous;
  json["width"] = facts.options.width;
  json["heads"] = facts.options.heads;
  json["double_blocks"] = facts.options.double_blocks;
  json["single_blocks"] = facts.options.single_blocks;
  json["diffusion_steps"] = facts.options.diffusion_steps;
  json["class_weight"] = facts.options.class_weight;
  json["blends_clean_poses"] = facts.options.blends_clean_poses;
  json["time_power"] = facts.options.time_power;
  json["shape_points"] = facts.options.shape_points;
  json["training_scenes"] = facts.training_scenes;
  json["data_seed"] = facts.data_seed;
  json["steps"] = facts.steps;
  nn::SaveCheckpoint(denoiser, {{"kind", kKind}, {"model", json.dump()}}, path);
}

ReadModel ReadWeights(const std::filesystem::path& path) {
  const nn::CheckpointMetadata facts = nn::ReadCheckpointMetadata(path, kKind);
  std::string error;
  try {
    ReadModel model{FactsOf(nlohmann::json::parse(facts.at("model"))), nullptr};
    if (!model.facts.vocabulary.IsValid(&error)) throw core::Error(error, path.string());
    model.denoiser = MakeDenoiser(model.facts.options, model.facts.vocabulary.ClassCount());
    nn::LoadCheckpoint(path, kKind, model.denoiser.get());
    model.facts.parameters = ParameterCount(*model.denoiser);
    model.denoiser->eval();
    return model;
  } catch (const nlohmann::json::exception&) {
    throw core::Error("the metadata of the weights cannot be read", path.string(),
                      "train the model again");
  } catch (const std::out_of_range&) {
    throw core::Error("the weights lack the options of their model", path.string());
  }
}

}  // namespace simwright::scene
