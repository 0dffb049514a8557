#include "skills/episode_cameras.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "skills/episode.h"
#include "skills/skill_environment.h"

namespace simwright::skills {
namespace {

constexpr int kMostSamples = 8;           // per side
constexpr float kFloorHeight = -0.0005f;  // m: below what stands on the floor at 0

// Returns the link of the robot that a mount names; -1: the world.
int LinkOfMount(const robot::RobotModel& robot, const render::CameraSpec& camera) {
  if (camera.mount == "world") return -1;
  if (camera.mount == "robot") return 0;
  if (camera.mount == "wrist") return robot.tool_link;
  const int link = robot.kinematics->FindLink(camera.mount);
  if (link >= 0) return link;
  std::string names;
  for (const assets::UrdfLink& known : robot.urdf.links) names += ", " + known.name;
  throw core::Error(
      "camera '" + camera.name + "': '" + robot.name + "' has no link '" + camera.mount + "'", "",
      "mount it on world, robot, wrist" + names);
}

int CamerasOf(const std::vector<const EpisodeView*>& views, std::size_t images) {
  if (views.empty()) return 0;
  const int cameras = views.front()->cameras().size();
  for (const EpisodeView* view : views) {
    if (&view->cameras() != &views.front()->cameras()) {
      throw core::Error("views that are rendered together must have the same cameras");
    }
  }
  if (images != views.size() * static_cast<std::size_t>(cameras)) {
    throw core::Error("got buffers for " + std::to_string(images) + " images, but " +
                      std::to_string(views.size()) + " views with " + std::to_string(cameras) +
                      " cameras");
  }
  return cameras;
}

// Returns `cameras`, checked before any file is read.
std::vector<render::CameraSpec> Checked(std::vector<render::CameraSpec> cameras,
                                        const robot::RobotModel& robot,
                                        const EpisodeCamerasOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "options of cameras");
  if (cameras.empty()) throw core::Error("an episode needs at least one camera");
  render::RequireValid(cameras);
  for (const render::CameraSpec& camera : cameras) LinkOfMount(robot, camera);
  return cameras;
}

render::RigidRenderOptions RenderOptionsOf(const EpisodeCameras& cameras) {
  render::RigidRenderOptions options;
  options.samples_per_side = cameras.options().samples_per_side;
  return options;
}

}  // namespace

bool EpisodeCamerasOptions::IsValid(std::string* error) const {
  if (samples_per_side < 1 || samples_per_side > kMostSamples) {
    if (error != nullptr) {
      *error = "samples_per_side is " + std::to_string(samples_per_side) +
               ", but must be from 1 to " + std::to_string(kMostSamples);
    }
    return false;
  }
  return look.IsValid(error);
}

std::vector<render::CameraSpec> DefaultCameras(int width, int height) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  render::CameraSpec front;
  front.name = "front";
  front.mount = "robot";
  front.mount_from_camera = render::LookAt({-0.05, -1.00, 0.80}, {0.44, 0.0, 0.24});
  front.vertical_fov = 46.0 * kDegree;
  // The hand is along the tool's -z. The camera sits beside it, off the plane of the fingers, on
  // the side that is above the hand when it approaches horizontally.
  render::CameraSpec wrist;
  wrist.name = "wrist";
  wrist.mount = "wrist";
  wrist.mount_from_camera =
      render::LookAt({-0.10, 0.0, -0.06}, {0.0, 0.0, 0.05}, -Eigen::Vector3d::UnitX());
  wrist.vertical_fov = 70.0 * kDegree;
  render::CameraSpec shoulder;
  shoulder.name = "shoulder";
  shoulder.mount = "robot";
  shoulder.mount_from_camera = render::LookAt({-0.30, 0.25, 1.25}, {0.70, 0.15, 0.30});
  shoulder.vertical_fov = 1.0;
  for (render::CameraSpec* camera : {&front, &wrist, &shoulder}) {
    camera->width = width;
    camera->height = height;
  }
  return {front, wrist, shoulder};
}

EpisodeCameras::EpisodeCameras(std::shared_ptr<const Skill> skill,
                               std::vector<render::CameraSpec> cameras,
                               const EpisodeCamerasOptions& options)
    : skill_(std::move(skill)),
      cameras_(Checked(std::move(cameras), *skill_->robot, options)),
      options_(options),
      visuals_(*skill_) {
  for (const render::CameraSpec& camera : cameras_) {
    mounts_.push_back(LinkOfMount(*skill_->robot, camera));
  }
}

int EpisodeCameras::Find(const std::string& name) const {
  std::string names;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (cameras_[i].name == name) return static_cast<int>(i);
    names += (i > 0 ? ", " : "") + cameras_[i].name;
  }
  throw core::Error("there is no camera '" + name + "'", "", "the cameras are " + names);
}

EpisodeView::EpisodeView(std::shared_ptr<const EpisodeCameras> cameras)
    : cameras_(std::move(cameras)) {
  Begin(0, 0);
}

void EpisodeView::Begin(int variant, std::uint64_t seed) {
  const Skill& skill = cameras_->skill();
  if (variant < 0 || variant >= static_cast<int>(skill.variants.size())) {
    throw core::Error("there is no variant " + std::to_string(variant), "",
                      "the skill has " + std::to_string(skill.variants.size()));
  }
  const SkillVariant& known = skill.variants[static_cast<std::size_t>(variant)];
  if (variant != variant_) {
    scene_ = render::RigidScene();
    for (const SkillVisuals::Piece& piece : cameras_->visuals().Pieces(variant)) {
      scene_.Add(piece.mesh, piece.label);
    }
    objects_.resize(known.model.objects.size());
  }
  variant_ = variant;
  seed_ = seed;
  ApplyLook();
  Pose(known.start, skill.robot->home(), skill.robot->gripper.open);
}

// Walls stand around the robot, wherever its task has put it.
void EpisodeView::ApplyLook() {
  const SkillVariant& variant = cameras_->skill().variants[static_cast<std::size_t>(variant_)];
  render::SceneLook base;
  base.backdrop.floor_height = kFloorHeight;
  base.backdrop.label = kBackdropLabel;
  base.cameras = cameras_->cameras();
  look_ = render::SampleLook(cameras_->options().look, base,
                             static_cast<int>(variant.model.objects.size()), seed_);
  const Eigen::Vector3f robot = variant.subtask.start.world_from_robot.translation().cast<float>();
  look_.backdrop.wall_range.translate(robot.head<2>());
  scene_.backdrop = look_.backdrop;
  scene_.light = look_.light;
  const std::vector<SkillVisuals::Piece>& pieces = cameras_->visuals().Pieces(variant_);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const SkillVisuals::Piece& piece = pieces[i];
    scene_.SetLook(static_cast<int>(i), piece.object >= 0
                                            ? look_.objects[static_cast<std::size_t>(piece.object)]
                                        : piece.label == kGripperLabel ? look_.gripper
                                                                       : look_.robot);
  }
}

void EpisodeView::Pose(const Episode& episode) {
  if (!episode.begun()) {
    throw core::Error("an episode that has not begun cannot be rendered", "", "reset it first");
  }
  if (episode.start().variant != variant_) Begin(episode.start().variant, seed_);
  Eigen::VectorXd arm;
  episode.world().robot().Positions(&arm);
  Pose(episode.state(), arm, episode.world().robot().Leader());
}

void EpisodeView::Pose(const tasks::WorldState& state, const Eigen::Ref<const Eigen::VectorXd>& arm,
                       double leader) {
  const Skill& skill = cameras_->skill();
  const SkillVariant& variant = skill.variants[static_cast<std::size_t>(variant_)];
  robot_ = skill.robot->LinkPoses(arm, leader);
  for (Eigen::Isometry3d& pose : robot_) pose = variant.subtask.start.world_from_robot * pose;
  for (const int object : variant.placed) {
    const auto t = static_cast<std::size_t>(object);
    tasks::LinkPosesOf(variant.model.objects[t], state.joints.at(t), &objects_[t]);
  }
  const std::vector<SkillVisuals::Piece>& pieces = cameras_->visuals().Pieces(variant_);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const SkillVisuals::Piece& piece = pieces[i];
    const auto t = static_cast<std::size_t>(piece.object), l = static_cast<std::size_t>(piece.link);
    scene_.SetPose(static_cast<int>(i),
                   piece.object < 0 ? robot_[l] : state.roots.at(t) * objects_[t][l]);
  }
}

core::Camera EpisodeView::Camera(int camera) const {
  const render::CameraSpec& spec = look_.cameras.at(static_cast<std::size_t>(camera));
  const int link = cameras_->MountLink(camera);
  return render::CameraAt(
      spec, link < 0 ? Eigen::Isometry3d::Identity() : robot_[static_cast<std::size_t>(link)]);
}

void EpisodeView::Render(int camera, const render::ImageBuffers& buffers) const {
  if (camera < 0 || camera >= cameras_->size()) {
    throw core::Error("there is no camera " + std::to_string(camera), "",
                      "there are " + std::to_string(cameras_->size()));
  }
  render::RenderRigid(scene_, Camera(camera), buffers, RenderOptionsOf(*cameras_));
}

void RenderViews(const std::vector<const EpisodeView*>& views,
                 const std::vector<render::ImageBuffers>& images) {
  const int cameras = CamerasOf(views, images.size());
  if (cameras == 0) return;
  std::vector<render::RigidView> seen;
  seen.reserve(images.size());
  for (const EpisodeView* view : views) {
    for (int c = 0; c < cameras; ++c) {
      seen.push_back({&view->scene(), view->Camera(c), images[seen.size()]});
    }
  }
  render::RenderRigidBatch(seen, RenderOptionsOf(views.front()->cameras()));
}

void RenderEnvironment(const SkillEnvironment& environment, std::uint64_t seed,
                       std::vector<EpisodeView>* views,
                       const std::vector<render::ImageBuffers>& images) {
  if (static_cast<int>(views->size()) != environment.size()) {
    throw core::Error("got " + std::to_string(views->size()) + " views of " +
                      std::to_string(environment.size()) + " environments");
  }
  std::vector<const EpisodeView*> seen;
  for (std::size_t i = 0; i < views->size(); ++i) {
    EpisodeView& view = (*views)[i];
    const Episode& episode = environment.episode(static_cast<int>(i));
    if (!episode.begun()) {
      throw core::Error("environments that were not reset cannot be rendered", "", "reset them");
    }
    core::Rng rng = core::StreamRng(seed, environment.episode_seed(static_cast<int>(i)));
    const std::uint64_t look = rng();
    if (view.seed() != look || view.variant() != episode.start().variant) {
      view.Begin(episode.start().variant, look);
    }
    view.Pose(episode);
    seen.push_back(&view);
  }
  RenderViews(seen, images);
}

}  // namespace simwright::skills
