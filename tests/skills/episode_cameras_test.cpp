// The cameras of an episode against forward kinematics and projections of the known geometry.
#include "skills/episode_cameras.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "render/forward.h"
#include "skills/scripted_expert.h"
#include "skills/skill_environment.h"
#include "tests/skills/skill_scene.h"

namespace simwright::skills {
namespace {

std::shared_ptr<const Skill> CameraSkill(const std::vector<SkillSubtask>& subtasks) {
  return MakeSkill(robot::Panda(false), subtasks, SkillOptions().ForEvaluation());
}

std::shared_ptr<const EpisodeCameras> CamerasOn(
    const std::shared_ptr<const Skill>& skill,
    const std::vector<render::CameraSpec>& specs = DefaultCameras(96, 96),
    const EpisodeCamerasOptions& options = {}) {
  return std::make_shared<EpisodeCameras>(skill, specs, options);
}

// Memory of one image.
struct EpisodeImage {
  explicit EpisodeImage(const render::CameraSpec& spec)
      : rgb(3 * Count(spec)), depth(Count(spec)), label(Count(spec)), normal(3 * Count(spec)) {}
  static std::size_t Count(const render::CameraSpec& spec) {
    return static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  }
  render::ImageBuffers Buffers() { return {rgb.data(), depth.data(), label.data(), normal.data()}; }
  bool operator==(const EpisodeImage&) const = default;
  std::vector<std::uint8_t> rgb;
  std::vector<float> depth;
  std::vector<std::int32_t> label;
  std::vector<float> normal;
};

EpisodeImage Seen(const EpisodeView& view, int camera) {
  EpisodeImage image(view.cameras().cameras()[static_cast<std::size_t>(camera)]);
  view.Render(camera, image.Buffers());
  return image;
}

int CountOf(const EpisodeImage& image, std::int32_t label) {
  return static_cast<int>(std::count(image.label.begin(), image.label.end(), label));
}

// Returns the pixels that the vertices of pieces with `label` project to, as an enclosing box.
Eigen::AlignedBox2d ProjectedBox(const EpisodeView& view, int camera, std::int32_t label) {
  const core::Camera eye = view.Camera(camera);
  Eigen::AlignedBox2d box;
  for (int p = 0; p < view.scene().size(); ++p) {
    const render::RigidScene::Part& part = view.scene().part(p);
    if (part.label != label) continue;
    for (int k = 0; k < 8; ++k) {
      const Eigen::Vector3d corner = part.mesh->bounds()
                                         .corner(static_cast<Eigen::AlignedBox3f::CornerType>(k))
                                         .cast<double>();
      box.extend(eye.Project(part.world_from_part * corner).head<2>());
    }
  }
  return box;
}

Eigen::AlignedBox2d LabelBox(const EpisodeImage& image, const render::CameraSpec& spec,
                             std::int32_t label) {
  Eigen::AlignedBox2d box;
  for (std::size_t i = 0; i < image.label.size(); ++i) {
    if (image.label[i] != label) continue;
    const auto x = static_cast<double>(i % static_cast<std::size_t>(spec.width)),
               y = static_cast<double>(i / static_cast<std::size_t>(spec.width));
    box.extend(Eigen::Vector2d(x, y)).extend(Eigen::Vector2d(x + 1.0, y + 1.0));
  }
  return box;
}

TEST(EpisodeCameras, TheFrontSeesGripperAndObject) {
  for (const SkillSubtask& subtask : {OpenDoor(), PickUpCup()}) {
    const EpisodeView view(CamerasOn(CameraSkill({subtask})));
    const EpisodeImage front = Seen(view, 0), wrist = Seen(view, 1);
    EXPECT_GT(CountOf(front, kGripperLabel), 40) << subtask.subtask.name;
    EXPECT_GT(CountOf(front, kRobotLabel), 100) << subtask.subtask.name;
    EXPECT_GT(CountOf(front, ObjectLabel(0)), 40) << subtask.subtask.name;
    EXPECT_GT(CountOf(wrist, kGripperLabel), 300) << subtask.subtask.name;
    EXPECT_LT(CountOf(wrist, kGripperLabel), 96 * 96 / 2) << subtask.subtask.name;
  }
}

TEST(EpisodeCameras, TheLegendNamesWhatIsSeen) {
  const auto cameras = CamerasOn(CameraSkill({OpenDoor()}));
  std::set<std::int32_t> known;
  for (const LabelName& entry : cameras->Legend(0)) known.insert(entry.label);
  EXPECT_EQ(known, (std::set<std::int32_t>{-1, 0, 1, 2, 3, 4}));
  const LabelName& door = cameras->Legend(0).back();
  EXPECT_EQ(door.name, "microwave/door");
  EXPECT_TRUE(door.is_target);
  const EpisodeView view(cameras);
  const EpisodeImage front = Seen(view, 0);
  for (const std::int32_t label : front.label) EXPECT_TRUE(known.contains(label)) << label;
  EXPECT_GT(CountOf(front, TargetLinkLabel(0)), 40);
}

// The cup stands free on the floor: its labels fill the projection of its bounds, which enclose an
// octagon of 98 % of their width.
TEST(EpisodeCameras, LabelsLieWhereTheObjectProjects) {
  render::CameraSpec above;
  above.name = "above";
  above.width = 160, above.height = 120;
  above.mount_from_camera = render::LookAt({0.5, 0.0, 1.2}, {0.5, 0.0, 0.0}, {1.0, 0.0, 0.0});
  above.vertical_fov = 0.3;
  EpisodeView view(CamerasOn(CameraSkill({PickUpCup()}), {above}));
  tasks::WorldState state = view.cameras().skill().variants[0].start;
  robot::JointVector aside = view.cameras().skill().robot->home();
  aside[0] = 1.5;
  for (const double shift : {-0.06, 0.0, 0.05}) {
    state.roots[0].translation() = Eigen::Vector3d(0.5 + 0.5 * shift, shift, 0.0);
    view.Pose(state, aside, 0.04);
    const Eigen::AlignedBox2d seen = LabelBox(Seen(view, 0), above, ObjectLabel(0));
    const Eigen::AlignedBox2d projected = ProjectedBox(view, 0, ObjectLabel(0));
    ASSERT_FALSE(seen.isEmpty());
    EXPECT_LT((seen.min() - projected.min()).cwiseAbs().maxCoeff(), 2.5);
    EXPECT_LT((seen.max() - projected.max()).cwiseAbs().maxCoeff(), 2.5);
  }
}

TEST(EpisodeCameras, TheDoorsLabelFollowsItsJoint) {
  EpisodeView view(CamerasOn(CameraSkill({OpenDoor()})));
  const Skill& skill = view.cameras().skill();
  tasks::WorldState state = skill.variants[0].start;
  const SkillVariant& variant = skill.variants[0];
  const auto joint = static_cast<std::size_t>(variant.target->joint);
  const EpisodeImage closed = Seen(view, 0);
  state.joints[0][joint] = 1.5;
  view.Pose(state, skill.robot->home(), 0.04);
  const EpisodeImage open = Seen(view, 0);
  const auto& spec = view.cameras().cameras()[0];
  // Open, the door reaches towards the robot, which is to the left.
  const Eigen::AlignedBox2d before = LabelBox(closed, spec, TargetLinkLabel(0)),
                            after = LabelBox(open, spec, TargetLinkLabel(0));
  EXPECT_LT(after.min().x(), before.min().x() - 5.0);
  const Eigen::AlignedBox2d bounds = ProjectedBox(view, 0, TargetLinkLabel(0));
  EXPECT_GT(after.min().x(), bounds.min().x() - 1.0);
  EXPECT_LT(after.max().x(), bounds.max().x() + 1.0);
}

TEST(EpisodeCameras, TheWristMovesWithForwardKinematics) {
  SkillSubtask subtask = PickUpCup();
  subtask.subtask.start.world_from_robot.translation() = Eigen::Vector3d(-0.1, 0.05, 0.02);
  subtask.subtask.start.world_from_robot.rotate(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()));
  std::vector<render::CameraSpec> specs = DefaultCameras(64, 48);
  specs.push_back(specs[1]);
  specs.back().name = "on link 3";
  specs.back().mount = "panda_link3";
  EpisodeView view(CamerasOn(CameraSkill({subtask}), specs));
  const Skill& skill = view.cameras().skill();
  robot::JointVector arm = skill.robot->home();
  for (int step = 0; step < 4; ++step) {
    arm[step] += 0.3;
    arm[6] -= 0.2;
    view.Pose(skill.variants[0].start, arm, 0.01 * step);
    const Eigen::Isometry3d& base = subtask.subtask.start.world_from_robot;
    const Eigen::Isometry3d tool = base * robot::ForwardKinematics(skill.robot->arm, arm);
    EXPECT_TRUE(view.Camera(1).world_from_camera.isApprox(tool * specs[1].mount_from_camera, 1e-9));
    EXPECT_TRUE(view.Camera(0).world_from_camera.isApprox(base * specs[0].mount_from_camera, 1e-9));
    const int link = skill.robot->kinematics->LinkIndex("panda_link3");
    const Eigen::Isometry3d third =
        base * skill.robot->LinkPoses(arm, 0.0)[static_cast<std::size_t>(link)];
    EXPECT_TRUE(
        view.Camera(3).world_from_camera.isApprox(third * specs[3].mount_from_camera, 1e-9));
    // The fingertips are symmetric about the middle of the image, and move apart with the leader.
    const Eigen::AlignedBox2d fingers = LabelBox(Seen(view, 1), specs[1], kGripperLabel);
    EXPECT_NEAR(fingers.center().x(), 32.0, 1.0);
  }
}

TEST(EpisodeCameras, AnEpisodeIsSeenWhereItsBodiesAre) {
  const auto skill = CameraSkill({OpenDoor()});
  Episode episode(*skill);
  core::Rng rng = core::StreamRng(5, 0);
  episode.Begin(SampleStart(*skill, rng));
  EpisodeView view(CamerasOn(skill));
  std::vector<float> action(static_cast<std::size_t>(ActionSize(*skill)));
  for (int step = 0; step < 25; ++step) {
    ExpertAction(episode, action.data());
    episode.Step(action.data());
  }
  view.Pose(episode);
  // The tool that the physics reports is the one that carries the wrist camera.
  const Eigen::Isometry3d tool =
      view.Camera(1).world_from_camera * view.cameras().cameras()[1].mount_from_camera.inverse();
  EXPECT_LT((tool.translation() - episode.state().gripper.translation()).norm(), 1e-4);
  // A recorded state gives the same image as the running episode.
  const EpisodeImage image = Seen(view, 0);
  EpisodeView recorded(view);
  Eigen::VectorXd arm;
  episode.world().robot().Positions(&arm);
  recorded.Begin(0, 0);
  EXPECT_NE(Seen(recorded, 0), image);
  recorded.Pose(episode.state(), arm, episode.world().robot().Leader());
  EXPECT_EQ(Seen(recorded, 0), image);
}

TEST(EpisodeCameras, BatchesAndThreadsGiveTheSameBytes) {
  const auto skill = CameraSkill({PickUpCup(), PickUpCup("mug", 0.035)});
  EpisodeCamerasOptions options;
  options.look = render::LookRanges::Wide();
  std::vector<render::CameraSpec> specs = DefaultCameras(50, 46);
  specs.resize(2);
  const auto cameras = CamerasOn(skill, specs, options);
  SkillEnvironment environment(skill, 3);
  rl::Rows observations;
  environment.Reset(11, &observations);
  std::vector<EpisodeView> views(3, EpisodeView(cameras));
  const int threads = core::ThreadCount();
  std::vector<std::vector<EpisodeImage>> runs;
  for (const int count : {1, 2}) {
    core::SetThreadCount(count);
    std::vector<EpisodeImage>& images = runs.emplace_back();
    std::vector<render::ImageBuffers> buffers;
    for (int i = 0; i < 6; ++i) {
      images.emplace_back(cameras->cameras()[static_cast<std::size_t>(i % 2)]);
    }
    for (EpisodeImage& image : images) buffers.push_back(image.Buffers());
    RenderEnvironment(environment, 21, &views, buffers);
    for (int i = 0; i < 6; ++i) {
      EXPECT_EQ(images[static_cast<std::size_t>(i)],
                Seen(views[static_cast<std::size_t>(i / 2)], i % 2));
    }
  }
  core::SetThreadCount(threads);
  EXPECT_EQ(runs[0], runs[1]);
  EXPECT_NE(runs[0][0].rgb, runs[0][2].rgb);
  EXPECT_EQ(views[1].variant(), environment.episode(1).start().variant);
  EXPECT_THROW(RenderEnvironment(environment, 21, &views, {}), core::Error);
}

TEST(EpisodeCameras, ALookIsAFunctionOfItsSeed) {
  const auto skill = CameraSkill({OpenDoor()});
  EpisodeCamerasOptions options;
  options.look = render::LookRanges::Wide();
  const auto cameras = CamerasOn(skill, DefaultCameras(48, 48), options);
  EpisodeView one(cameras), other(cameras);
  one.Begin(0, 31);
  other.Begin(0, 32);
  EXPECT_NE(Seen(one, 0).rgb, Seen(other, 0).rgb);
  other.Begin(0, 31);
  EXPECT_EQ(Seen(one, 0), Seen(other, 0));
  // Without ranges, every seed looks alike.
  EpisodeView plain(CamerasOn(skill)), seeded(CamerasOn(skill));
  seeded.Begin(0, 99);
  EXPECT_EQ(Seen(plain, 0), Seen(seeded, 0));
}

TEST(EpisodeCameras, BadInputIsOneClearLine) {
  const auto skill = CameraSkill({PickUpCup()});
  const auto error_of = [&](const std::vector<render::CameraSpec>& specs,
                            const EpisodeCamerasOptions& options = {}) -> std::string {
    try {
      EpisodeCameras(skill, specs, options);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "none";
  };
  std::vector<render::CameraSpec> specs = DefaultCameras();
  specs[1].mount = "elbow";
  EXPECT_NE(error_of(specs).find("camera 'wrist': 'panda' has no link 'elbow'"), std::string::npos)
      << error_of(specs);
  specs = DefaultCameras();
  specs[0].width = -3;
  EXPECT_EQ(error_of(specs), "camera 'front': width is -3 pixels, outside 1 to 8192");
  EXPECT_EQ(error_of({}), "an episode needs at least one camera");
  EpisodeCamerasOptions options;
  options.samples_per_side = 9;
  EXPECT_NE(error_of(DefaultCameras(), options).find("samples_per_side is 9"), std::string::npos);
  options = {};
  options.look.walls = 2.0;
  EXPECT_NE(error_of(DefaultCameras(), options).find("walls is 2"), std::string::npos);
  EpisodeView view(CamerasOn(skill));
  EXPECT_THROW(view.Begin(1, 0), core::Error);
  EXPECT_THROW(view.Render(3, {}), core::Error);
  EXPECT_THROW(view.cameras().Find("side"), core::Error);
  EXPECT_THROW(view.Pose(Episode(*skill)), core::Error);
  std::vector<EpisodeView> views(1, view);
  EXPECT_THROW(RenderEnvironment(SkillEnvironment(skill, 1), 0, &views, {{}, {}}), core::Error);
  EXPECT_EQ(view.cameras().Find("wrist"), 1);
}

}  // namespace
}  // namespace simwright::skills
