// `simwright export --world`: MuJoCo and libsdformat load the worlds of tasks and find our numbers.
#include <algorithm>
#include <filesystem>
#include <map>

#include <gtest/gtest.h>

#include <mujoco/mujoco.h>
#include <nlohmann/json.hpp>
#include <sdf/sdf.hh>

#include "core/files.h"
#include "sim/articulated_world.h"
#include "sim/mujoco_scene.h"
#include "skills/observation.h"
#include "tests/workflows/program.h"
#include "tests/workflows/scripted_run.h"
#include "workflows/skills/skill_suite.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

using nlohmann::json;

// The arguments that export a task's world, and the subtask that the world belongs to.
struct WorldSource {
  std::string arguments;
  std::unique_ptr<RunSkill> skill;
};

class WorldExportCommand : public ScriptedRuns {
 protected:
  static void SetUpTestSuite() {
    ScriptedRuns::SetUpTestSuite();
    core::Progress silent;
    drawers_ = new fs::path(MakeCellTasks(CellOf("open_drawer"), kSeenSeed, 1, "",
                                          shared_->path() / "drawers", &silent));
  }
  static void TearDownTestSuite() {
    delete drawers_;
    ScriptedRuns::TearDownTestSuite();
  }

  // A run with a free block, and a file with a fixed chest that has four joints.
  static std::vector<WorldSource> Sources() {
    std::vector<WorldSource> sources(2);
    sources[0].arguments = Pick();
    sources[0].skill = std::make_unique<RunSkill>(PrepareSkills(ReadRun(Pick())).front());
    SkillRun run;
    run.set = tasks::ReadTaskFile(*drawers_);
    run.set.tasks.resize(1);
    sources[1].arguments = drawers_->string() + " --task " + run.set.tasks.front().name;
    sources[1].skill = std::make_unique<RunSkill>(PrepareSkills(run).front());
    return sources;
  }

  json Export(const WorldSource& source, const std::string& format) const {
    const Outcome outcome =
        RunProgram("export " + source.arguments + " --world --force --json --format " + format +
                       " -o " + Path(format),
                   "/dev/null");
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    return json::parse(outcome.text);
  }

  inline static fs::path* drawers_ = nullptr;
};

// The bodies of the training world.
std::vector<const sim::ArticulatedBody*> BodiesOf(const skills::Skill& skill) {
  std::vector<const sim::ArticulatedBody*> bodies = {&skill.robot_body->body()};
  const skills::SkillVariant& variant = skill.variants.front();
  for (const int object : variant.placed) {
    bodies.push_back(&variant.bodies[static_cast<size_t>(object)]->body());
  }
  return bodies;
}

TEST_F(WorldExportCommand, MujocoFindsTheSameWorldAndItRests) {
  for (const WorldSource& source : Sources()) {
    const json report = Export(source, "mjcf");
    const skills::Skill& skill = *source.skill->evaluated;
    const skills::SkillVariant& variant = skill.variants.front();
    sim::MujocoScene scene(Path("mjcf") + "/world.xml", {}, sim::MujocoScene::Ground::kOwn);
    mjModel* const model = scene.model();
    mjData* const data = scene.data();

    int links = 1, joints = 0;  // MuJoCo counts the world
    double mass = 0.0;
    for (const sim::ArticulatedBody* body : BodiesOf(skill)) {
      links += static_cast<int>(body->links.size());
      joints += static_cast<int>(body->kinematics->moving_joints().size());
      for (const sim::RigidBody& link : body->links) mass += link.inertial.mass;
    }
    for (const int object : variant.placed) joints += !variant.fixed[static_cast<size_t>(object)];
    EXPECT_EQ(model->nbody, links);
    EXPECT_EQ(model->njnt, joints);
    EXPECT_NEAR(mj_getTotalmass(model), mass, 1e-9 * mass);
    EXPECT_NEAR(report.at("mass_kg"), mass, 1e-9 * mass);

    ASSERT_EQ(mj_name2id(model, mjOBJ_KEY, "start"), 0);
    mj_resetDataKeyframe(model, data, 0);
    mj_forward(model, data);
    const robot::RobotModel& robot = *skill.robot;
    for (size_t j = 0; j < robot.arm_joints.size(); ++j) {
      const std::string& name = robot.urdf.joints[static_cast<size_t>(robot.arm_joints[j])].name;
      const int id = mj_name2id(model, mjOBJ_JOINT, name.c_str());
      ASSERT_GE(id, 0) << name;
      const double home = robot.home()[static_cast<Eigen::Index>(j)];
      EXPECT_EQ(data->qpos[model->jnt_qposadr[id]], home) << name;
      EXPECT_EQ(data->ctrl[mj_name2id(model, mjOBJ_ACTUATOR, name.c_str())], home) << name;
    }
    // The tool is where our own kinematics put it.
    const Eigen::Isometry3d tool =
        variant.subtask.start.world_from_robot * robot::ForwardKinematics(robot.arm, robot.home());
    const std::string& tool_name = robot.urdf.links[static_cast<size_t>(robot.tool_link)].name;
    const int tool_body = mj_name2id(model, mjOBJ_BODY, tool_name.c_str());
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(data->xpos[3 * tool_body + i], tool.translation()[i], 1e-9);
    }

    const std::vector<double> before(data->xpos, data->xpos + 3 * model->nbody);
    while (data->time < 1.0) scene.Step();
    EXPECT_TRUE(scene.warnings().empty());
    for (int b = 1; b < model->nbody; ++b) {
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(data->xpos[3 * b + i], before[static_cast<size_t>(3 * b + i)], 2e-3)
            << mj_id2name(model, mjOBJ_BODY, b);
      }
    }
  }
}

// task.json names bodies and joints of the world, and its layout fills the observation. A sampled
// start differs from the described one, and only by its seed.
TEST_F(WorldExportCommand, TaskFileDescribesTheObservation) {
  for (const WorldSource& source : Sources()) {
    Export(source, "mjcf");
    const json task = json::parse(core::ReadFile(Path("mjcf") + "/task.json", 1 << 24));
    const skills::Skill& skill = *source.skill->evaluated;
    const int size = skills::Observer(skill, skill.variants.front()).size();
    EXPECT_EQ(task.at("observation_size"), size);
    int next = 0;
    for (const json& entry : task.at("observation")) {
      EXPECT_EQ(entry.at("start"), next);
      next += entry.at("size").get<int>();
    }
    EXPECT_EQ(next, size);
    const sim::MujocoScene scene(Path("mjcf") + "/world.xml", {}, sim::MujocoScene::Ground::kOwn);
    const auto body = [&](const json& name) {
      return mj_name2id(scene.model(), mjOBJ_BODY, name.get<std::string>().c_str());
    };
    EXPECT_GT(body(task.at("robot").at("tool_body")), 0);
    EXPECT_GT(body(task.at("target").at("body")), 0);
    EXPECT_GT(body(task.at("target").at("link")), 0);
    for (const json& joint : task.at("program_joints")) {
      const std::string name = joint.at("joint");
      EXPECT_GE(mj_name2id(scene.model(), mjOBJ_JOINT, name.c_str()), 0) << name;
    }
    const std::string described = core::ReadFile(Path("mjcf") + "/world.xml", 1 << 26);
    WorldSource sampled = {source.arguments + " --sampled-start --seed 3", nullptr};
    Export(sampled, "mjcf");
    const std::string first = core::ReadFile(Path("mjcf") + "/world.xml", 1 << 26);
    EXPECT_NE(first, described);
    Export(sampled, "mjcf");
    EXPECT_EQ(core::ReadFile(Path("mjcf") + "/world.xml", 1 << 26), first);
  }
}

TEST_F(WorldExportCommand, LibsdformatLoadsTheWorldWithoutAWarning) {
  for (const WorldSource& source : Sources()) {
    Export(source, "sdf");
    sdf::Root root;
    const sdf::Errors errors = root.Load(Path("sdf") + "/world.sdf");
    for (const auto& error : errors) ADD_FAILURE() << error.Message();
    ASSERT_EQ(root.WorldCount(), 1u);
    const sdf::World& world = *root.WorldByIndex(0);
    const std::vector<const sim::ArticulatedBody*> bodies = BodiesOf(*source.skill->evaluated);
    ASSERT_EQ(world.ModelCount(), bodies.size() + 1);  // and the ground
    for (size_t b = 0; b < bodies.size(); ++b) {
      const sdf::Model& model = *world.ModelByIndex(b + 1);
      EXPECT_EQ(model.LinkCount(), bodies[b]->links.size());
      for (size_t l = 0; l < bodies[b]->links.size(); ++l) {
        const double mass = bodies[b]->links[l].inertial.mass;
        if (mass == 0.0) continue;
        const std::string& name = bodies[b]->kinematics->links()[l].name;
        ASSERT_NE(model.LinkByName(name), nullptr) << name;
        EXPECT_NEAR(model.LinkByName(name)->Inertial().MassMatrix().Mass(), mass, 1e-12) << name;
      }
      for (const assets::Joint& joint : bodies[b]->joints()) {
        const sdf::Joint* const found = model.JointByName(joint.name);
        ASSERT_NE(found, nullptr) << joint.name;
        if (!joint.Moves()) continue;
        EXPECT_NEAR(found->Axis()->Upper(), joint.upper, 1e-12) << joint.name;
        EXPECT_NEAR(found->Axis()->Damping(), joint.damping, 1e-12) << joint.name;
      }
    }
  }
}

TEST_F(WorldExportCommand, DirectivesWeldTheRobotAndPlaceTheBlock) {
  const json report = Export(Sources().front(), "drake");
  EXPECT_EQ(report.at("file"), "world.dmd.yaml");
  const fs::path folder = Path("drake");
  const std::string text = core::ReadFile(folder / "world.dmd.yaml", 1 << 20);
  EXPECT_NE(text.find("child: \"robot::panda_link0\""), std::string::npos) << text;
  EXPECT_NE(text.find("\"panda_joint2\": [-0.785398"), std::string::npos) << text;
  EXPECT_NE(text.find("default_free_body_pose:\n      \"base\":"), std::string::npos) << text;
  for (const char* file : {"robot.sdf", "block.sdf", "ground.sdf", "package.xml"}) {
    EXPECT_TRUE(fs::exists(folder / file)) << file;
  }
  sdf::Root root;
  EXPECT_TRUE(root.Load((folder / "robot.sdf").string()).empty());
}

TEST_F(WorldExportCommand, WrongRequestsAreRefusedInOneLine) {
  const std::string file = (shared_->path() / "tasks.json").string();
  for (const auto& [arguments, code, says] : std::vector<std::tuple<std::string, int, std::string>>{
           {file + " --world --format mjcf -o w", 1, "name one with --task"},
           {file + " --task fly --world --format mjcf -o w", 1, "there is no task 'fly'"},
           {Pick() + " --subtask fly --world --format sdf -o w", 1, "it has pick_up_block"},
           {Pick() + " --world --format csv -o w", 2, "needs --format mjcf, sdf, drake or usd"},
           {Pick() + " --format mjcf -o w", 2, "needs --world"},
           {Pick() + " --task x --format csv -o w", 2, "--task: needs --world"},
           {"--world --format mjcf -o w", 2, "or a tasks.json with --task NAME"}}) {
    const Outcome outcome = RunProgram("export " + arguments);
    EXPECT_EQ(outcome.code, code) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_NE(outcome.text.find(says), std::string::npos) << outcome.text;
  }
}

}  // namespace
}  // namespace simwright::workflows
