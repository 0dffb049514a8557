#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/progress.h"
#include "scene/dataset/pose_range.h"
#include "scene/dataset/vocabulary.h"
#include "scene/grammar/scene_sample.h"
#include "scene/model/inpainting_mask.h"
#include "scene/model/model_options.h"
#include "scene/prompt/class_limits.h"

namespace simwright::scene {

struct SampleOptions {
  int steps = 0;  // denoising steps, evenly spaced; 0: all of the diffusion's
  // The share of the posterior's noise that poses receive (1: as trained; 0: none, DDIM).
  double eta = 1.0;
  int batch = 64;  // scenes per batch
  // Each scene is sampled alone, by one thread, from a random stream of its own: results are
  // bit-identical for any number of threads, and a few scenes take less time than as a batch.
  bool one_by_one = false;
  std::uint64_t seed = 1;
  // True: noise is drawn on the model's device, which is faster on a GPU. Its numbers are others
  // than those of a CPU, so that a seed gives other scenes.
  bool noise_on_device = false;
  // The prompts of a model that reads them: scene i has prompts[i % prompts.size()], as
  // Prompt::Text() writes them; none: all scenes are unprompted.
  std::vector<std::string> prompts;
  // The weight w of classifier-free guidance, (1 + w) prompted - w unprompted; 0: none.
  double guidance = 0.0;
  // Limits of the numbers of objects: scene i has limits[i % limits.size()]; none: no limits. Kept
  // entries count, too. A continuous model has none.
  std::vector<std::vector<ClassLimit>> limits;
  Clamping clamping = Clamping::kCleanValues;  // of Inpaint; docs/steering.md compares

  bool IsValid(std::string* error) const;
};

// One of the scene types of a model of several.
struct SceneModelType {
  std::string name;
  int entries = 0;  // most objects of a scene
  PoseRange range;
  int training_scenes = 0;
  std::uint64_t data_seed = 0;
  std::vector<std::string> categories;  // that its training scenes may have
};

// The metadata of a weights file. Of a model of several scene types, it is that of one type at a
// time, with the classes of all.
struct SceneModelMetadata {
  Vocabulary vocabulary;
  SceneModelOptions options;
  PoseRange range;
  int training_scenes = 0;  // scenes 0 .. training_scenes - 1 of the dataset; others are held out
  std::uint64_t data_seed = 0;
  std::int64_t parameters = 0;
  int steps = 0;                              // training steps
  std::vector<std::string> text_pieces = {};  // word pieces of a model that reads prompts
  std::string text_encoder = "";              // hash of the external text encoder; empty: its own
  std::vector<SceneModelType> types = {};     // of a model of several scene types; else empty

  // Returns the metadata of one of the types. Throws core::Error, naming the types, for another
  // one; a model of one type has its own only.
  SceneModelMetadata OfType(const std::string& type) const;
  std::vector<std::string> TypeNames() const;
};

// Returns the metadata of a weights file. Throws core::Error if it is missing or not a scene model.
SceneModelMetadata ReadSceneModelMetadata(const std::filesystem::path& weights);

// A trained model of scenes. Thread-safe unless AddAsset is called.
class SceneModel {
 public:
  // Loads a model. `text_encoder`: the external encoder that it was trained with, if any. `type`:
  // the scene type that it is to generate, of a model of several; it then reads the type before
  // each prompt (PromptOfSceneType). Throws core::Error if a file is missing or not a scene model,
  // the encoder is another one, or the model does not have the type.
  static SceneModel Load(const std::filesystem::path& weights,
                         const std::filesystem::path& text_encoder = {},
                         const std::string& type = "");
  ~SceneModel();
  SceneModel(SceneModel&&) noexcept;
  SceneModel& operator=(SceneModel&&) noexcept;

  const SceneModelMetadata& metadata() const;

  // Adds an asset that the model may place, free, identified by its surface only (ShapeOf, of
  // metadata().options.shape_points). Throws core::Error if the model does not embed classes by
  // shape, the category exists already, or points are missing or not finite.
  void AddAsset(const std::string& category, const std::vector<Eigen::Vector3d>& surface);

  // Samples `count` scenes. Returns their tokens (count x entries x TokenWidth), with one-hot
  // classes and matrices as predicted (DecodeScene projects them to rotations). Advances `progress`
  // by one per scene. Throws core::Error for invalid options, and for prompts if the model reads
  // none.
  std::vector<float> Sample(int count, const SampleOptions& options,
                            core::Progress* progress) const;

  // Synthesizes the masked values of scenes, given the others. `tokens`: (count x entries x
  // TokenWidth), in any order of the entries. Returns tokens as Sample does, in which the kept
  // values equal the input's bit by bit; with everything masked, it returns what Sample returns.
  // Advances `progress` by one per scene. Throws core::Error for invalid options, or a mask or
  // tokens that are not valid (InpaintingMask::IsValid).
  std::vector<float> Inpaint(const std::vector<float>& tokens, const InpaintingMask& mask,
                             const SampleOptions& options, core::Progress* progress) const;

 private:
  struct Network;
  explicit SceneModel(std::unique_ptr<Network> network);
  std::unique_ptr<Network> network_;
};

}  // namespace simwright::scene
