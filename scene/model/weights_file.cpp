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

SceneModelMetadata MetadataOf(const nlohmann::json& json) {
  Vocabulary vocabulary;
  vocabulary.type = json.at("type");
  vocabulary.entries = json.at("entries");
  vocabulary.categories = json.at("slots").get<std::vector<std::string>>();
  vocabulary.welded = json.at("welded").get<std::vector<bool>>();
  SceneModelMetadata metadata{vocabulary, OptionsOf(json), PoseRange::FromText(json.at("range"))};
  metadata.training_scenes = json.at("training_scenes");
  metadata.data_seed = json.at("data_seed");
  metadata.steps = json.at("steps");
  return metadata;
}

}  // namespace

void WriteWeights(const Denoiser& denoiser, const SceneModelMetadata& metadata,
                  const std::filesystem::path& path) {
  nlohmann::ordered_json json;
  json["type"] = metadata.vocabulary.type;
  json["entries"] = metadata.vocabulary.entries;
  json["slots"] = metadata.vocabulary.categories;
  json["welded"] = metadata.vocabulary.welded;
  json["range"] = metadata.range.Text();
  json["denoiser"] = NameOf(metadata.options.kind);
  json["continuous"] = metadata.options.continuous;
  json["width"] = metadata.options.width;
  json["heads"] = metadata.options.heads;
  json["double_blocks"] = metadata.options.double_blocks;
  json["single_blocks"] = metadata.options.single_blocks;
  json["diffusion_steps"] = metadata.options.diffusion_steps;
  json["class_weight"] = metadata.options.class_weight;
  json["blends_clean_poses"] = metadata.options.blends_clean_poses;
  json["time_power"] = metadata.options.time_power;
  json["shape_points"] = metadata.options.shape_points;
  json["training_scenes"] = metadata.training_scenes;
  json["data_seed"] = metadata.data_seed;
  json["steps"] = metadata.steps;
  nn::SaveCheckpoint(denoiser, {{"kind", kKind}, {"model", json.dump()}}, path);
}

ReadModel ReadWeights(const std::filesystem::path& path) {
  const nn::CheckpointMetadata metadata = nn::ReadCheckpointMetadata(path, kKind);
  std::string error;
  try {
    ReadModel model{MetadataOf(nlohmann::json::parse(metadata.at("model"))), nullptr};
    if (!model.metadata.vocabulary.IsValid(&error)) throw core::Error(error, path.string());
    model.denoiser = MakeDenoiser(model.metadata.options, model.metadata.vocabulary.ClassCount());
    nn::LoadCheckpoint(path, kKind, model.denoiser.get());
    model.metadata.parameters = ParameterCount(*model.denoiser);
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
