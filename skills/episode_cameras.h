#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "render/camera_spec.h"
#include "render/look_ranges.h"
#include "render/rigid_render.h"
#include "skills/skill.h"
#include "skills/skill_visuals.h"

namespace simwright::skills {

class Episode;
class SkillEnvironment;

struct EpisodeCamerasOptions {
  render::LookRanges look;   // off by default
  int samples_per_side = 1;  // N x N rays per pixel for the colours, 1 to 8

  // Returns false, with a line that names the value, if one is outside its range.
  bool IsValid(std::string* error) const;
};

// Returns "front", which stands beside the robot and sees the gripper and the front of the objects
// before it, "wrist", which is fixed to the hand and sees the fingers and what is between them, and
// "shoulder", which is above the robot's base and sees the side of furniture that faces the robot.
std::vector<render::CameraSpec> DefaultCameras(int width = 128, int height = 128);

// The cameras of a skill's episodes, with the visual shapes that they see; made once. Immutable and
// thread-safe; an EpisodeView renders one episode with them.
class EpisodeCameras {
 public:
  // `cameras`: at least one; a mount is "world", "robot" (the base), "wrist" (the tool frame
  // between the fingertips: z along the approach, y from finger to finger) or a link of the robot.
  // Throws core::Error, naming the camera and the value, for an invalid spec or an unknown mount,
  // for invalid options, and if a visual shape cannot be read.
  EpisodeCameras(std::shared_ptr<const Skill> skill, std::vector<render::CameraSpec> cameras,
                 const EpisodeCamerasOptions& options = {});

  const Skill& skill() const { return *skill_; }
  const std::vector<render::CameraSpec>& cameras() const { return cameras_; }
  int size() const { return static_cast<int>(cameras_.size()); }  // number of cameras
  // Returns the index of the camera of this name. Throws core::Error, listing the names, for an
  // unknown one.
  int Find(const std::string& name) const;
  // Returns the segmentation ids of a variant with their names (SkillVisuals::Legend).
  const std::vector<LabelName>& Legend(int variant) const { return visuals_.Legend(variant); }

  const EpisodeCamerasOptions& options() const { return options_; }
  const SkillVisuals& visuals() const { return visuals_; }
  // Returns the link of the robot's URDF that carries a camera; -1: the world.
  int MountLink(int camera) const { return mounts_[static_cast<std::size_t>(camera)]; }

 private:
  std::shared_ptr<const Skill> skill_;
  std::vector<render::CameraSpec> cameras_;
  EpisodeCamerasOptions options_;
  std::vector<int> mounts_;
  SkillVisuals visuals_;
};

// An episode as the cameras see it: its look, and poses. Mutable, one thread at a time;
// rendering is const and thread-safe.
class EpisodeView {
 public:
  // Begins with variant 0, seed 0.
  explicit EpisodeView(std::shared_ptr<const EpisodeCameras> cameras);

  // Begins an episode: its variant, and the look that `seed` gives (a pure function of options,
  // variant and seed). Poses are those that the variant describes, with the arm at home and the
  // gripper open. Throws core::Error for a variant that the skill does not have.
  void Begin(int variant, std::uint64_t seed);
  // Moves the robot and the objects to the episode's current state. Begins another variant, with
  // the current seed, if the episode has another. Throws core::Error if it has not begun.
  void Pose(const Episode& episode);
  // Moves them to a recorded state: arm (J), rad or m, and position of the gripper's first joint.
  void Pose(const tasks::WorldState& state, const Eigen::Ref<const Eigen::VectorXd>& arm,
            double leader);

  int variant() const { return variant_; }
  std::uint64_t seed() const { return seed_; }
  const render::SceneLook& look() const { return look_; }
  const EpisodeCameras& cameras() const { return *cameras_; }
  // Returns a camera at the current poses: intrinsics, and world_from_camera.
  core::Camera Camera(int camera) const;
  // Renders a camera into the buffers that are not null. Throws core::Error for an unknown camera.
  void Render(int camera, const render::ImageBuffers& buffers) const;

  const render::RigidScene& scene() const { return scene_; }

 private:
  void ApplyLook();

  std::shared_ptr<const EpisodeCameras> cameras_;
  int variant_ = -1;
  std::uint64_t seed_ = 0;
  render::SceneLook look_;
  render::RigidScene scene_;
  std::vector<Eigen::Isometry3d> robot_;                 // world_from_link, by link of the robot
  std::vector<std::vector<Eigen::Isometry3d>> objects_;  // root_from_link, by object
};

// Renders N views with M cameras each, distributed over up to core::ThreadCount() threads.
// `images`: (N x M), by view, then camera; images without any buffer are skipped. The bytes are
// those of EpisodeView::Render. Throws core::Error for another number of images, and if the views
// have other cameras.
void RenderViews(const std::vector<const EpisodeView*>& views,
                 const std::vector<render::ImageBuffers>& images);

// Moves N views to the episodes of N environments and renders them, `images` as in RenderViews. A
// view begins another episode with the environment's (SkillEnvironment::episode_seed), `seed` mixed
// in. Throws core::Error for another number of views or images, and before the first Reset.
void RenderEnvironment(const SkillEnvironment& environment, std::uint64_t seed,
                       std::vector<EpisodeView>* views,
                       const std::vector<render::ImageBuffers>& images);

}  // namespace simwright::skills
