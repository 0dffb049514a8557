#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "python/bindings/arrays.h"
#include "python/bindings/episode_images.h"
#include "python/bindings/prepared_task.h"
#include "skills/episode.h"
#include "skills/episode_cameras.h"
#include "skills/skill_environment.h"

namespace simwright::python {

using FloatArray = nb::ndarray<nb::numpy, float>;
using ActionArgument = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

// N episodes of one subtask; each restarts in the step in which it ends.
class VectorEpisodes {
 public:
  VectorEpisodes(const PreparedTask& task, int subtask, int count, bool evaluated);
  VectorEpisodes(const VectorEpisodes&) = delete;
  VectorEpisodes& operator=(const VectorEpisodes&) = delete;

  // Looks at the episodes with these cameras, which are of the same subtask. `names` and `kinds`
  // choose what LastImages returns (ImageChoice).
  void AttachCameras(std::shared_ptr<const skills::EpisodeCameras> cameras,
                     const std::vector<std::string>& names, const std::vector<std::string>& kinds);
  FloatArray Reset(std::uint64_t seed);
  nb::tuple Step(const RowsArgument& actions);
  // Returns the images of all episodes as they are now, and of those that ended in the last step
  // (None if none did; the images of the others are unspecified).
  nb::dict Images(const std::vector<std::string>& names, const std::vector<std::string>& kinds);
  nb::object LastImages();
  nb::object Demonstrate() const;

  int size() const { return environment_.size(); }
  int observation_size() const { return environment_.observation_size(); }
  int action_size() const { return environment_.action_size(); }

 private:
  void RequireStarted() const;
  bool EndedOne() const;
  void LookAtEnd(int index, const skills::Episode& episode);

  skills::SkillEnvironment environment_;
  std::shared_ptr<const skills::EpisodeCameras> cameras_;
  ImageChoice last_choice_;
  std::vector<skills::EpisodeView> views_;
  std::unique_ptr<EpisodeImages> last_images_;
  std::uint64_t seed_ = 0;
  rl::Rows actions_;
  rl::StepBatch batch_;
  bool started_ = false;
  static constexpr const char* kName = "environment";
  mutable std::atomic_flag used_;
};

// One episode at a time of one subtask.
class SingleEpisode {
 public:
  SingleEpisode(const PreparedTask& task, int subtask, bool evaluated);
  SingleEpisode(const SingleEpisode&) = delete;
  SingleEpisode& operator=(const SingleEpisode&) = delete;

  void AttachCameras(std::shared_ptr<const skills::EpisodeCameras> cameras);
  // Starts episode `index` of the seed: the one that EvaluateChain and SampleStarts number so.
  FloatArray Begin(std::uint64_t seed, std::uint64_t index);
  // Starts where `previous`, of the subtask before, ended.
  FloatArray BeginAfter(const SingleEpisode& previous);
  nb::tuple Step(const ActionArgument& action);
  nb::dict Images(const std::vector<std::string>& names, const std::vector<std::string>& kinds);
  nb::object ExpertAction() const;
  // Returns the state in SI units, world frame.
  nb::dict State() const;
  // Returns the pose (4 x 4) of a camera in the world, and its focal lengths and principal point.
  nb::dict Camera(const std::string& name);

 private:
  void RequireStarted() const;
  FloatArray Observe() const;
  skills::EpisodeView& PosedView();

  std::shared_ptr<const skills::Skill> skill_;
  skills::Episode episode_;
  std::shared_ptr<const skills::EpisodeCameras> cameras_;
  std::optional<skills::EpisodeView> view_;
  std::uint64_t look_seed_ = 0;
  core::Rng rng_;
  int observation_size_ = 0;
  bool started_ = false;
  static constexpr const char* kName = "environment";
  mutable std::atomic_flag used_;
};

}  // namespace simwright::python
