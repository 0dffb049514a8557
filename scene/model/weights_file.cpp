#include "scene/model/weights_file.h"

#include "core/error.h"
#include "core/json.h"
#include "nn/checkpoint.h"
#include "scene/model/word_pieces.h"

namespace simwright::scene {
namespace {

constexpr char kKind[] = "scene model";

SceneModelOptions OptionsOf(const core::JsonField& field) {
  SceneModelOptions options;
  options.kind = DenoiserNamed(field["denoiser"].Text());
  options.continuous = field["continuous"].Flag();
  options.width = field["width"].Int();
  options.heads = field["heads"].Int();
  options.double_blocks = field["double_blocks"].Int();
  options.single_blocks = field["single_blocks"].Int();
  options.diffusion_steps = field["diffusion_steps"].Int();
  options.class_weight = field["class_weight"].Number();
  options.blends_clean_poses = field.FlagOr("blends_clean_poses", false);
  options.time_power = field.NumberOr("time_power", 1.0);
  options.shape_points = field.IntOr("shape_points", 0);
  options.text = field.FlagOr("text", false);
  if (options.text) {
    options.text_pieces = field["text_pieces"].Int();
    options.text_features = field["text_features"].Int();
    options.text_layers = field["text_layers"].Int();
    options.text_length = field["text_length"].Int();
  }
  return options;
}

SceneModelMetadata MetadataOf(const core::JsonField& field) {
  Vocabulary vocabulary;
  vocabulary.type = field["type"].Text();
  vocabulary.entries = field["entries"].Int();
  vocabulary.categories = field["slots"].Texts();
  for (const core::JsonField& welded : field["welded"].Elements()) {
    vocabulary.welded.push_back(welded.Flag());
  }
  SceneModelMetadata metadata{vocabulary, OptionsOf(field),
                              PoseRange::FromText(field["range"].Text())};
  metadata.training_scenes = field["training_scenes"].Int();
  metadata.data_seed = field["data_seed"].Unsigned();
  metadata.steps = field["steps"].Int();
  if (field.Has("types")) {
    for (const core::JsonField& one : field["types"].Elements()) {
      metadata.types.push_back(
          {one["name"].Text(), one["entries"].Int(), PoseRange::FromText(one["range"].Text()),
           one["training_scenes"].Int(), one["data_seed"].Unsigned(), one["slots"].Texts()});
    }
  }
  if (metadata.options.text) {
    metadata.text_pieces = field["pieces"].Texts();
    metadata.text_encoder = field["text_encoder"].Text();
    const WordPieces pieces(metadata.text_pieces);  // validates them
    if (metadata.options.text_pieces > 0 && metadata.options.text_pieces != pieces.size()) {
      throw core::Error("the number of word pieces differs from the model's");
    }
  }
  return metadata;
}

}  // namespace

void WriteWeights(const Denoiser& denoiser, const SceneModelMetadata& metadata,
                  const std::filesystem::path& path) {
  core::OrderedJson json;
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
  json["text"] = metadata.options.text;
  if (metadata.options.text) {
    json["text_pieces"] = metadata.options.text_pieces;
    json["text_features"] = metadata.options.text_features;
    json["text_layers"] = metadata.options.text_layers;
    json["text_length"] = metadata.options.text_length;
    json["pieces"] = metadata.text_pieces;
    json["text_encoder"] = metadata.text_encoder;
  }
  if (!metadata.types.empty()) {
    core::OrderedJson types = core::OrderedJson::array();
    for (const SceneModelType& one : metadata.types) {
      types.push_back({{"name", one.name},
                       {"entries", one.entries},
                       {"range", one.range.Text()},
                       {"training_scenes", one.training_scenes},
                       {"data_seed", one.data_seed},
                       {"slots", one.categories}});
    }
    json["types"] = types;
  }
  json["training_scenes"] = metadata.training_scenes;
  json["data_seed"] = metadata.data_seed;
  json["steps"] = metadata.steps;
  nn::SaveCheckpoint(denoiser, {{"kind", kKind}, {"model", core::JsonLine(json)}}, path);
}

ReadModel ReadWeights(const std::filesystem::path& path) {
  const nn::CheckpointMetadata metadata = nn::ReadCheckpointMetadata(path, kKind);
  std::string error;
  try {
    const core::JsonDocument document(metadata.at("model"), path.string(), "train the model again");
    ReadModel model{MetadataOf(document.root()), nullptr};
    if (!model.metadata.vocabulary.IsValid(&error)) throw core::Error(error, path.string());
    model.denoiser = MakeDenoiser(model.metadata.options, model.metadata.vocabulary.ClassCount());
    nn::LoadCheckpoint(path, kKind, model.denoiser.get());
    model.metadata.parameters = ParameterCount(*model.denoiser);
    model.denoiser->eval();
    return model;
  } catch (const std::out_of_range&) {
    throw core::Error("the weights lack the options of their model", path.string());
  }
}

}  // namespace simwright::scene
