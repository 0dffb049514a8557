#include "tasks/language/worked_example.h"

#include "assets/primitive_meshes.h"

namespace simwright::tasks {
namespace {

using assets::Joint;
using assets::JointType;
using assets::SemanticModel;
using assets::UrdfLink;

UrdfLink BoxLink(const std::string& name, const Eigen::Vector3d& size,
                 const Eigen::Vector3d& centre) {
  core::TriangleMesh mesh = assets::BoxMesh(size);
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(centre)), &mesh);
  UrdfLink link;
  link.name = name;
  link.visuals.push_back({mesh, ""});
  link.collisions.push_back({mesh, ""});
  return link;
}

// The frame is on the floor; the front faces +x, the direction in which the drawer slides.
SemanticModel Chest() {
  SemanticModel chest;
  chest.name = chest.model.name = "chest";
  chest.category = "chest of drawers";
  chest.model.links = {BoxLink("body", {0.4, 0.5, 0.4}, {0.0, 0.0, 0.2}),
                       BoxLink("drawer", {0.36, 0.44, 0.14}, {0.0, 0.0, 0.0}),
                       BoxLink("handle", {0.03, 0.12, 0.02}, {0.0, 0.0, 0.0})};
  Joint slide{"drawer_slide", "body", "drawer", JointType::kPrismatic};
  slide.parent_from_joint.translation() = Eigen::Vector3d(0.02, 0.0, 0.28);
  slide.upper = 0.3;
  Joint mount{"handle_mount", "drawer", "handle", JointType::kFixed};
  mount.parent_from_joint.translation() = Eigen::Vector3d(0.2, 0.0, 0.0);
  chest.model.joints = {slide, mount};
  chest.semantics = {{"body", {"static", "body"}},
                     {"drawer", {"slider", "drawer"}},
                     {"handle", {"fixed", "handle"}}};
  return chest;
}

SemanticModel Block() {
  SemanticModel block;
  block.name = block.model.name = "block";
  block.category = "toy block";
  block.model.links = {BoxLink("base", {0.05, 0.05, 0.05}, {0.0, 0.0, 0.025})};
  block.semantics = {{"base", {"free", "block"}}};
  return block;
}

}  // namespace

const std::vector<SemanticModel>& ExampleModels() {
  static const auto* models = new std::vector<SemanticModel>{Chest(), Block()};
  return *models;
}

std::vector<NamedModel> ExampleScene() {
  std::vector<NamedModel> scene;
  for (const SemanticModel& model : ExampleModels()) scene.push_back({model.name, &model});
  return scene;
}

const std::string& ExampleAnswer() {
  static const auto* answer = new std::string(R"(Task: store_block
Task Description: Put the block into the drawer of the chest.

Subtask 1: open_drawer
Subtask Description: Pull the drawer out by its handle.
Success: the drawer is out by more than nine tenths of its way
```python
def compute_reward(env):
    handle = env.get_pose_by_link_name("chest", "handle")
    gripper = env.get_robot_gripper_pose()
    reach = torch.norm(handle - gripper, dim=-1)
    limits = env.get_limits_by_joint_name("chest", "drawer_slide")
    way = limits["upper"] - limits["lower"]
    slide = env.get_state_by_joint_name("chest", "drawer_slide")
    opened = (slide - limits["lower"]) / way
    reward = 2.0 * opened - reach
    success = opened > 0.9
    return reward, success
```

Subtask 2: pick_block
Subtask Description: Grasp the block and lift it off the floor.
Success: the block is held, and its underside is 0.1 m above the floor
```python
def compute_reward(env):
    gripper = env.get_robot_gripper_pose()
    reach = torch.norm(env.get_position("block") - gripper, dim=-1)
    held = env.check_grasped("block")
    low, high = env.get_bounding_box("block")
    height = torch.clamp(low[:, 2], min=0.0, max=0.15)
    reward = -reach + 0.5 * held.float() + 5.0 * height
    success = torch.logical_and(held, low[:, 2] > 0.1)
    return reward, success
```

Subtask 3: place_block_in_drawer
Subtask Description: Lay the block into the open drawer and let go of it.
Success: the block is inside the drawer, and the gripper does not hold it
```python
def compute_reward(env):
    low, high = env.get_bounding_box_link("chest", "drawer")
    block = env.get_position("block")
    away = torch.norm(block - (low + high) / 2.0, dim=-1)
    inside = env.in_bbox(block, low, high)
    released = torch.logical_not(env.check_grasped("block"))
    success = torch.logical_and(inside, released)
    reward = -away + success.float()
    return reward, success
```
)");
  return *answer;
}

}  // namespace simwright::tasks
