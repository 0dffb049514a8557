#include "skills/task_world.h"

#include <cstdio>

#include "assets/mesh_import.h"
#include "assets/model_writer.h"
#include "assets/semantic_model.h"
#include "core/error.h"
#include "sim/articulated_world.h"
#include "sim/driven_robot.h"

namespace simwright::skills {
namespace {

const Eigen::Vector4f kWorldRobotColor(0.90f, 0.91f, 0.93f, 1.0f);
const Eigen::Vector4f kWorldObjectColor(0.75f, 0.72f, 0.66f, 1.0f);
constexpr double kErrorAtFullEffort = 2e-3;  // rad or m

// Collects the bodies of a world and their meshes.
class TaskWorldBuilder {
 public:
  explicit TaskWorldBuilder(TaskWorld* world) : world_(world) {}

  assets::TreeBody& AddBody(const std::string& name, const std::string& prefix,
                            const sim::ArticulatedBody& body, const assets::UrdfModel& model,
                            const Eigen::Vector4f& color) {
    assets::TreeBody& tree = world_->bodies.emplace_back();
    tree.name = name;
    tree.prefix = prefix;
    tree.kinematics = body.kinematics;
    tree.positions.assign(body.joints().size(), 0.0);
    tree.links.resize(body.links.size());
    for (size_t l = 0; l < body.links.size(); ++l) {
      assets::TreeLink& link = tree.links[l];
      link.friction = body.links[l].friction;
      link.restitution = body.links[l].restitution;
      const std::string stem = name + "_" + body.kinematics->links()[l].name;
      AddCollisions(stem, body.links[l], &link);
      for (const assets::UrdfLink& drawn : model.links) {
        if (drawn.name == body.kinematics->links()[l].name) AddVisuals(stem, drawn, color, &link);
      }
    }
    return tree;
  }

 private:
  static std::string Numbered(const std::string& stem, size_t number) {
    char digits[24];
    std::snprintf(digits, sizeof(digits), "_%03zu", number);
    return stem + digits;
  }

  std::string AddMesh(const std::string& name, const core::TriangleMesh& mesh) {
    world_->meshes.push_back({"meshes/" + name + ".obj", mesh});
    return world_->meshes.back().file;
  }

  void AddCollisions(const std::string& stem, const sim::RigidBody& body, assets::TreeLink* link) {
    for (size_t p = 0; p < body.parts.size(); ++p) {
      assets::TreeShape& shape = link->collisions.emplace_back();
      shape.name = Numbered(stem + "_collision", p);
      if (p < body.capsules.size() && body.capsules[p]) {
        const sim::Capsule& capsule = *body.capsules[p];
        shape.capsule = assets::TreeCapsule{capsule.a, capsule.b, capsule.radius};
      } else {
        shape.file = AddMesh(shape.name, body.parts[p]);
      }
    }
  }

  // Visuals that MuJoCo rejects are omitted.
  void AddVisuals(const std::string& stem, const assets::UrdfLink& drawn,
                  const Eigen::Vector4f& color, assets::TreeLink* link) {
    for (const assets::UrdfShape& visual : drawn.visuals) {
      core::TriangleMesh mesh = visual.mesh;
      Eigen::Vector4f seen = visual.color.value_or(color);
      if (!visual.file.empty() && !visual.color) seen = ColorOf(visual.file, color);
      if (mesh.empty() || !assets::VisualSuitsMujoco(mesh)) continue;
      assets::TreeShape& shape = link->visuals.emplace_back();
      shape.name = Numbered(stem + "_visual", link->visuals.size() - 1);
      shape.color = seen;
      shape.file = AddMesh(shape.name, mesh);
    }
  }

  // Returns the colour of the file's first material.
  static Eigen::Vector4f ColorOf(const std::string& file, const Eigen::Vector4f& usual) {
    try {
      const core::TexturedMesh read = assets::ReadMesh(file);
      return read.materials.empty() ? usual : read.materials.front().base_color;
    } catch (const core::Error&) {
      return usual;
    }
  }

  TaskWorld* world_;
};

void AddMotor(int joint, double force, double target, assets::TreeBody* body) {
  assets::TreeMotor motor;
  motor.joint = joint;
  motor.force = force;
  motor.target = target;
  motor.stiffness = force / kErrorAtFullEffort;
  // DrivenRobot's motors correct this share of an error per step of the physics.
  const SkillOptions options;
  const double rate = sim::MotorOptions().stiffness * options.control_rate * options.substeps;
  motor.damping = motor.stiffness / rate;
  body->motors.push_back(motor);
}

void AddRobot(const Skill& skill, const SkillVariant& variant, const StartState& start,
              TaskWorldBuilder* builder) {
  const robot::RobotModel& robot = *skill.robot;
  assets::TreeBody& tree =
      builder->AddBody("robot", "", skill.robot_body->body(), robot.urdf, kWorldRobotColor);
  tree.world_from_root = variant.subtask.start.world_from_robot;
  for (const int link : robot.gripper.links) {
    tree.links[static_cast<size_t>(link)].friction_prevails = true;
  }
  for (size_t j = 0; j < robot.arm_joints.size(); ++j) {
    const int joint = robot.arm_joints[j];
    const double home = start.arm[static_cast<Eigen::Index>(j)];
    tree.positions[static_cast<size_t>(joint)] = home;
    AddMotor(joint, robot.limits[static_cast<size_t>(joint)].effort, home, &tree);
  }
  for (const int joint : robot.gripper.joints) {
    tree.positions[static_cast<size_t>(joint)] = robot.gripper.open;
    AddMotor(joint, robot.gripper.grip_force, robot.gripper.open, &tree);
  }
  for (const int link : sim::LinksInFloor(skill.robot_body->body(), robot, tree.world_from_root)) {
    tree.links[static_cast<size_t>(link)].meets_floor = false;
  }
}

void AddObject(const SkillVariant& variant, int object, const tasks::TaskAsset& asset,
               const tasks::WorldState& state, TaskWorldBuilder* builder) {
  const auto t = static_cast<size_t>(object);
  const assets::UrdfModel model = assets::ReadSemanticModel(asset.path).model;
  assets::TreeBody& tree =
      builder->AddBody(asset.name, asset.name, variant.bodies[t]->body(), model, kWorldObjectColor);
  tree.world_from_root = state.roots[t];
  tree.fixed = variant.fixed[t];
  if (tree.fixed) tree.links.front().meets_floor = false;
  for (size_t j = 0; j < variant.body_joints[t].size(); ++j) {
    const int joint = variant.body_joints[t][j];
    if (joint >= 0) tree.positions[static_cast<size_t>(joint)] = state.joints[t][j];
  }
}

// Bullet multiplies two frictions.
void SetFingerFriction(std::vector<assets::TreeBody>* bodies) {
  double sum = 0.0;
  int count = 0;
  for (size_t b = 1; b < bodies->size(); ++b) {
    for (const assets::TreeLink& link : (*bodies)[b].links) {
      if (link.collisions.empty()) continue;
      sum += link.friction;
      ++count;
    }
  }
  if (count == 0) return;
  for (assets::TreeLink& link : bodies->front().links) {
    if (link.friction_prevails) link.friction *= sum / count;
  }
}

}  // namespace

TaskWorld MakeTaskWorld(const std::string& name, const Skill& skill,
                        const std::vector<tasks::TaskAsset>& assets, const StartState& start) {
  const SkillVariant& variant = skill.variants.front();
  TaskWorld world;
  world.task = name;
  world.bodies.reserve(variant.placed.size() + 1);
  TaskWorldBuilder builder(&world);
  AddRobot(skill, variant, start, &builder);
  for (const int object : variant.placed) {
    const std::string& placed = variant.model.objects[static_cast<size_t>(object)].name;
    for (const tasks::TaskAsset& asset : assets) {
      if (asset.name == placed) AddObject(variant, object, asset, start.state, &builder);
    }
  }
  SetFingerFriction(&world.bodies);
  return world;
}

}  // namespace simwright::skills
