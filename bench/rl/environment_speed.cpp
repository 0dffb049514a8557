// Measures the speed of training worlds: the Panda, a microwave with its door and knobs, a cup.
//   bench_environment_speed [--repeats N] [--part memory|physics|environments|learning]
//   bench_environment_speed --mjcf FILE         writes the bodies for bench/peers/training_world.py
// Control steps (60 Hz, 4 substeps) per second of 64 environments on one and two threads, with
// random actions as an untrained policy samples them, and with the gripper closed on the door's
// handle; with PPO and the default networks; the effect of each setting; resident memory; and
// physics steps (240 Hz) per second of a core of the same scene in Bullet as in training, in Bullet
// without each of the optimizations, and in MuJoCo. Each figure is the best of the repeats, with
// the variants interleaved.
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/rl/training_scene.h"
#include "core/files.h"
#include "core/parallel.h"
#include "core/random.h"
#include "geometry/convex_hull.h"
#include "rl/ppo.h"
#include "robot/panda_model.h"
#include "sim/driven_robot.h"
#include "sim/mujoco_bodies.h"
#include "skills/skill_environment.h"

namespace simwright {
namespace {

constexpr int kEnvironments = 64, kDecisions = 20;  // decisions per repeat
constexpr int kSettle = 120, kPhysicsSteps = 1200;

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Returns the processor time (s) of all threads: the cost of a step while other processes share the
// cores.
double ProcessorSeconds() {
  timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double ResidentMiB() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

enum class Acting { kRandom, kAtHandle };

// The environments of one variant, kept between repeats.
class Variant {
 public:
  Variant(std::string name, const skills::SkillSubtask& scene, const skills::SkillOptions& options,
          Acting acting, int threads)
      : name_(std::move(name)),
        environment_(skills::MakeSkill(robot::Panda(false), {scene}, options), kEnvironments),
        acting_(acting),
        threads_(threads),
        rng_(3) {
    environment_.Reset(1, &observations_);
  }

  void Repeat() {
    core::SetThreadCount(threads_);
    const double start = Now(), processor_start = ProcessorSeconds();
    rl::Rows actions(kEnvironments, environment_.action_size());
    rl::StepBatch batch;
    for (int step = 0; step < kDecisions; ++step) {
      if (acting_ == Acting::kRandom) {
        for (Eigen::Index i = 0; i < actions.size(); ++i) {
          actions.data()[i] = 0.6f * static_cast<float>(core::Normal(rng_));
        }
      } else {
        actions.setZero();
        actions.rightCols(1).setConstant(-1.0f);
      }
      environment_.Step(actions, &batch);
    }
    const int control = environment_.skill().options.control_steps * kDecisions * kEnvironments;
    best_ = std::max(best_, control / (Now() - start));
    cheapest_ = std::min(cheapest_, 1e6 * (ProcessorSeconds() - processor_start) / control);
  }
  void Print() const {
    std::printf("| %s | %d | %.0f | %.0f |\n", name_.c_str(), threads_, best_, cheapest_);
  }

 private:
  std::string name_;
  skills::SkillEnvironment environment_;
  rl::Rows observations_;
  Acting acting_;
  int threads_;
  core::Rng rng_;
  double best_ = 0.0;      // control steps/s
  double cheapest_ = 1e9;  // us of processor time per control step
};

void MeasureEnvironments(const skills::SkillSubtask& scene, int repeats) {
  skills::SkillOptions plain, all_iterations;
  all_iterations.free_iterations = all_iterations.contact_iterations;
  std::vector<std::unique_ptr<Variant>> variants;
  const auto add = [&](const char* name, const skills::SkillOptions& options, Acting acting,
                       int threads) {
    variants.push_back(std::make_unique<Variant>(name, scene, options, acting, threads));
  };
  add("random actions", plain, Acting::kRandom, 1);
  add("random actions", plain, Acting::kRandom, 2);
  add("gripper closed on the handle", plain, Acting::kAtHandle, 1);
  add("gripper closed on the handle", plain, Acting::kAtHandle, 2);
  add("random, 20 iterations always", all_iterations, Acting::kRandom, 2);
  for (int i = 0; i < repeats; ++i) {
    for (const auto& variant : variants) variant->Repeat();
  }
  std::printf("\n| environment alone | threads | control steps/s | us of a core per step |\n");
  std::printf("|---|---|---|---|\n");
  for (const auto& variant : variants) variant->Print();
}

void MeasureMemory(const skills::SkillSubtask& scene) {
  const auto skill = skills::MakeSkill(robot::Panda(false), {scene});
  malloc_trim(0);  // returns the memory freed after making the assets
  const double before = ResidentMiB();
  skills::SkillEnvironment environment(skill, kEnvironments);
  rl::Rows observations;
  environment.Reset(1, &observations);
  const rl::Rows actions = rl::Rows::Zero(kEnvironments, environment.action_size());
  rl::StepBatch batch;
  for (int step = 0; step < kDecisions; ++step) environment.Step(actions, &batch);
  std::printf("\n%d environments: %.1f MiB, the whole process %.0f MiB\n", kEnvironments,
              ResidentMiB() - before, ResidentMiB());
}

void MeasurePpo(const skills::SkillSubtask& scene, int repeats) {
  core::SetThreadCount(2);
  skills::SkillEnvironment environment(skills::MakeSkill(robot::Panda(false), {scene}),
                                       kEnvironments);
  const rl::PpoOptions options;
  rl::Ppo ppo(&environment, options);
  std::vector<rl::Outcome> outcomes;
  double collect = 1e9, update = 1e9, processor = 1e9;
  for (int i = 0; i < repeats; ++i) {
    const double start = Now(), processor_start = ProcessorSeconds();
    ppo.Collect(&outcomes);
    const double middle = Now();
    ppo.Update();
    collect = std::min(collect, middle - start);
    update = std::min(update, Now() - middle);
    processor = std::min(processor, ProcessorSeconds() - processor_start);
  }
  const int control = environment.skill().options.control_steps * options.horizon * kEnvironments;
  std::printf(
      "\nwith PPO (256-128-64, %d epochs, %d observations), 2 threads: %.0f control steps/s, of "
      "which "
      "the learner takes %.0f %%; %.0f us of a core per step\n",
      options.epochs, environment.observation_size(), control / (collect + update),
      100.0 * update / (collect + update), 1e6 * processor / control);
}

// The scene's bodies as in training.
struct Bodies {
  sim::ArticulatedBody robot, microwave, cup;
  Eigen::Isometry3d world_from_microwave, world_from_cup;
};

Bodies BodiesOf(const skills::SkillSubtask& scene, bool capsules, bool hull) {
  Bodies bodies;
  bodies.robot = sim::ArticulatedBodyFrom(robot::Panda(false).urdf);
  bodies.microwave = sim::ArticulatedBodyFrom(scene.assets[0].model);
  bodies.cup = sim::ArticulatedBodyFrom(scene.assets[1].model);
  if (!capsules) {
    for (sim::RigidBody& link : bodies.robot.links) link.capsules.clear();
  }
  if (hull) {
    std::vector<Eigen::Vector3d> points;
    for (const core::TriangleMesh& part : bodies.cup.links[0].parts) {
      points.insert(points.end(), part.vertices.begin(), part.vertices.end());
    }
    bodies.cup.links[0].parts = {geometry::ConvexHull(points, 64)};
    bodies.cup.links[0].capsules.clear();
  }
  bodies.world_from_microwave = scene.subtask.start.placements[0].world_from_asset;
  bodies.world_from_cup = scene.subtask.start.placements[1].world_from_asset;
  return bodies;
}

// Returns a swinging arm configuration; the same in both engines.
Eigen::VectorXd SwingingArm(double time) {
  Eigen::VectorXd goal = robot::Panda(false).home();
  for (Eigen::Index j = 0; j < goal.size(); ++j) {
    goal[j] += 0.2 * std::sin((2.0 + 0.3 * static_cast<double>(j)) * time);
  }
  return goal;
}

struct PhysicsVariant {
  std::string name;
  std::function<void(double)> step;  // to this time, s
  double time = 0.0, best = 0.0;     // steps/s
};

PhysicsVariant InBullet(const std::string& name, const Bodies& bodies, int iterations, bool compact,
                        bool sleeping = false) {
  sim::WorldOptions options;
  options.sleeping = sleeping;
  options.solver_iterations = iterations;
  options.compact_solver = compact;
  auto world = std::make_shared<sim::ArticulatedWorld>(options);
  sim::Placement standing, loose;
  standing.world_from_root = bodies.world_from_microwave;
  loose.world_from_root = bodies.world_from_cup;
  loose.fixed = false;
  world->Add(bodies.microwave, standing);
  world->Add(bodies.cup, loose);
  auto robot = std::make_shared<sim::DrivenRobot>(robot::Panda(false),
                                                  std::make_shared<sim::PreparedBody>(bodies.robot),
                                                  Eigen::Isometry3d::Identity(), world.get());
  return {name, [world, robot](double time) {
            robot->Command(SwingingArm(time), robot::Panda(false).gripper.open);
            robot->Drive();
            world->Step();
          }};
}

// The bodies for MuJoCo, in the order robot, microwave, cup.
std::vector<sim::MujocoPlacement> MujocoPlacements(const Bodies& bodies) {
  sim::MujocoPlacement robot{&bodies.robot}, microwave{&bodies.microwave}, cup{&bodies.cup};
  for (const auto& limits : robot::Panda(false).limits) {
    robot.motor_forces.push_back(limits.effort);
  }
  microwave.world_from_root = bodies.world_from_microwave;
  cup.world_from_root = bodies.world_from_cup;
  cup.fixed = false;
  return {robot, microwave, cup};
}

PhysicsVariant InMujoco(const Bodies& bodies, double time_step) {
  const robot::RobotModel& panda = robot::Panda(false);
  auto world = std::make_shared<sim::MujocoBodies>(MujocoPlacements(bodies), time_step);
  for (size_t j = 0; j < panda.arm_joints.size(); ++j) {
    world->SetPosition(0, panda.arm_joints[j], panda.home()[static_cast<Eigen::Index>(j)]);
  }
  return {"MuJoCo 2.2.2", [world, &panda](double time) {
            const Eigen::VectorXd goal = SwingingArm(time);
            for (size_t j = 0; j < panda.arm_joints.size(); ++j) {
              world->Hold(0, panda.arm_joints[j], goal[static_cast<Eigen::Index>(j)]);
            }
            for (const int joint : panda.gripper.joints) world->Hold(0, joint, panda.gripper.open);
            world->Step();
          }};
}

// Writes the bodies as MJCF, with the home position of each motor's joint as the numeric "home".
void WriteMjcf(const skills::SkillSubtask& scene, const std::string& path) {
  const robot::RobotModel& panda = robot::Panda(false);
  const Bodies bodies = BodiesOf(scene, true, true);
  std::string text = sim::BodiesMjcf(MujocoPlacements(bodies),
                                     {.time_step = sim::WorldOptions().time_step, .floor = true});
  std::string home;
  for (size_t j = 0; j < panda.limits.size(); ++j) {
    if (!(panda.limits[j].effort > 0.0)) continue;
    const auto& arm = panda.arm_joints;
    const auto found = std::find(arm.begin(), arm.end(), static_cast<int>(j)) - arm.begin();
    const bool in_arm = found < static_cast<std::ptrdiff_t>(arm.size());
    home += std::to_string(in_arm ? panda.home()[found] : panda.gripper.open) + " ";
  }
  text.insert(text.rfind("</mujoco>"),
              "<custom><numeric name=\"home\" data=\"" + home + "\"/></custom>");
  core::WriteFile(path, text);
}

void MeasurePhysics(const skills::SkillSubtask& scene, int repeats) {
  const Bodies bodies = BodiesOf(scene, true, true);
  const Bodies without_capsules = BodiesOf(scene, false, true);
  const Bodies in_parts = BodiesOf(scene, true, false);
  const double time_step = sim::WorldOptions().time_step;
  std::vector<PhysicsVariant> variants = {
      InBullet("Bullet, 4 iterations (no contacts)", bodies, 4, true),
      InBullet("Bullet, 20 iterations", bodies, 20, true),
      InBullet("20, bodies at rest asleep as in training", bodies, 20, true, true),
      InBullet("20, Bullet's own solver", bodies, 20, false),
      InBullet("20, arm of convex hulls instead of capsules", without_capsules, 20, true),
      InBullet("20, cup of parts instead of its convex hull", in_parts, 20, true),
      InBullet("50 iterations, Bullet's own solver, convex hulls, parts",
               BodiesOf(scene, false, false), 50, false),
      InMujoco(bodies, time_step)};
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (PhysicsVariant& variant : variants) {
      const int settle = repeat == 0 ? kSettle : 0;
      for (int i = 0; i < settle; ++i) variant.step(variant.time += time_step);
      const double start = ProcessorSeconds();
      for (int i = 0; i < kPhysicsSteps; ++i) variant.step(variant.time += time_step);
      variant.best = std::max(variant.best, kPhysicsSteps / (ProcessorSeconds() - start));
    }
  }
  std::printf(
      "\n| physics alone, one thread | steps/s of 240 Hz per second of the core |\n|---|---|\n");
  for (const PhysicsVariant& variant : variants) {
    std::printf("| %s | %.0f |\n", variant.name.c_str(), variant.best);
  }
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  int repeats = 5;
  std::string part, mjcf;  // empty: all; none
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::string(argv[i]) == "--repeats") repeats = std::atoi(argv[i + 1]);
    if (std::string(argv[i]) == "--part") part = argv[i + 1];
    if (std::string(argv[i]) == "--mjcf") mjcf = argv[i + 1];
  }
  const auto chosen = [&](const char* name) { return part.empty() || part == name; };
  const simwright::skills::SkillSubtask scene = simwright::MicrowaveAndCup();
  if (!mjcf.empty()) {
    simwright::WriteMjcf(scene, mjcf);
    return 0;
  }
  if (chosen("memory")) simwright::MeasureMemory(scene);
  if (chosen("physics")) simwright::MeasurePhysics(scene, repeats);
  if (chosen("environments")) simwright::MeasureEnvironments(scene, repeats);
  if (chosen("learning")) simwright::MeasurePpo(scene, repeats);
}
