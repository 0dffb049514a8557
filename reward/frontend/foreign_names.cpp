#include "reward/frontend/foreign_names.h"

#include <algorithm>
#include <iterator>

namespace simwright::reward {
namespace {

constexpr std::string_view kHandles[] = {
    "scene",         "sim",           "data",           "agent",           "robot",     "pose",
    "tcp",           "unwrapped",     "model",          "_scene",          "simulator", "gym",
    "articulations", "rigid_objects", "sensors",        "rigid_body_data", "body",      "site",
    "geom",          "_data",         "root_physx_view"};

// `names`: attributes, each surrounded by blanks; {} in `instead` stands for the asset.
struct Foreign {
  std::string_view names;
  std::string_view of;  // the simulators
  std::string_view instead;
};

constexpr Foreign kForeign[] = {
    {" root_pos_w root_link_pos_w root_com_pos_w root_state_w root_link_pose_w root_pose_w ",
     "Isaac Lab", "env.get_position(\"{}\")"},
    {" root_quat_w root_link_quat_w ", "Isaac Lab", "env.get_orientation(\"{}\")"},
    {" root_lin_vel_w root_lin_vel_b root_vel_w root_com_vel_w root_link_lin_vel_w ", "Isaac Lab",
     "env.get_linear_velocity(\"{}\")"},
    {" root_ang_vel_w root_ang_vel_b root_link_ang_vel_w ", "Isaac Lab",
     "env.get_angular_velocity(\"{}\")"},
    {" body_pos_w body_state_w body_link_pos_w body_com_pos_w ", "Isaac Lab",
     "env.get_position_by_link_name(\"{}\", LINK)"},
    {" body_quat_w body_link_quat_w ", "Isaac Lab",
     "env.get_orientation_by_link_name(\"{}\", LINK)"},
    {" target_pos_w target_pos_source target_quat_w ", "Isaac Lab",
     "env.get_robot_gripper_pose() for the frame of the hand"},
    {" joint_pos ", "Isaac Lab", "env.get_state_by_joint_name(\"{}\", JOINT)"},
    {" joint_vel joint_acc ", "Isaac Lab", "env.get_velocity_by_joint_name(\"{}\", JOINT)"},
    {" soft_joint_pos_limits joint_pos_limits default_joint_pos ", "Isaac Lab",
     "env.get_limits_by_joint_name(\"{}\", JOINT)"},
    {" net_forces_w net_forces_w_history contact_forces ", "Isaac Lab and Isaac Gym",
     "env.get_robot_gripper_contact(ASSET)"},
    {" command_manager get_command goal_pos goal_position target_pos goal_site goal_pose ",
     "other simulators", "env.get_goal_pose(ASSET)"},
    {" env_origins ", "Isaac Lab",
     "nothing: positions are of each environment's own world already"},
    {" root_states root_state root_tensor actor_root_state object_pos object_root_positions ",
     "Isaac Gym", "env.get_position(ASSET), get_orientation, get_linear_velocity"},
    {" rigid_body_states rigid_body_pos body_states ", "Isaac Gym",
     "env.get_position_by_link_name(ASSET, LINK)"},
    {" dof_pos dof_state dof_states ", "Isaac Gym",
     "env.get_state_by_joint_name(ASSET, JOINT) of a thing's joint"},
    {" dof_vel ", "Isaac Gym", "env.get_velocity_by_joint_name(ASSET, JOINT) of a thing's joint"},
    {" eef_pos hand_pos gripper_pos lfinger_pos rfinger_pos franka_grasp_pos ee_pos ",
     "other simulators", "env.get_robot_gripper_pose()"},
    {" p ", "ManiSkill", "env.get_position(\"{}\")"},
    {" q ", "ManiSkill", "env.get_orientation(\"{}\")"},
    {" linear_velocity ", "ManiSkill", "env.get_linear_velocity(\"{}\")"},
    {" angular_velocity ", "ManiSkill", "env.get_angular_velocity(\"{}\")"},
    {" is_grasping ", "ManiSkill", "env.check_grasped(ASSET)"},
    {" qpos get_qpos ", "ManiSkill and MuJoCo", "env.get_state_by_joint_name(ASSET, JOINT)"},
    {" qvel get_qvel ", "ManiSkill and MuJoCo", "env.get_velocity_by_joint_name(ASSET, JOINT)"},
    {" body_xpos get_body_xpos xpos xipos geom_xpos body_xipos ", "robosuite and Gymnasium",
     "env.get_position(ASSET) or env.get_position_by_link_name(ASSET, LINK)"},
    {" site_xpos get_site_xpos eef_site_id _eef_xpos ", "robosuite and Gymnasium",
     "env.get_robot_gripper_pose() for the site of the hand"},
    {" body_xquat xquat get_body_xquat ", "robosuite and Gymnasium", "env.get_orientation(ASSET)"},
    {" cvel body_xvelp get_body_xvelp ", "robosuite and Gymnasium",
     "env.get_linear_velocity(ASSET)"},
    {" _check_grasp check_grasp ", "robosuite", "env.check_grasped(ASSET)"},
    {" _gripper_to_target get_body_com ", "robosuite and Gymnasium",
     "env.get_distance(env.get_robot_gripper_pose(), env.get_position(ASSET))"},
    {" _check_success check_success evaluate success ", "other simulators",
     "a second value of the function: return reward, success"},
    {" actions action last_actions prev_actions action_manager previous_actions ",
     "other simulators",
     "nothing: what a policy does is no state of the scene; leave the term out, or penalise "
     "env.get_robot_gripper_velocity()"},
    {" progress_buf reset_buf episode_length_buf max_episode_length termination_manager "
     "reset_time_outs time_step elapsed_steps ",
     "other simulators", "nothing: an episode ends by itself; leave the term out"},
    {" obs_buf obs_dict observations _get_obs obs extras ", "other simulators",
     "the functions of the scene: env.get_position(ASSET), env.get_robot_gripper_pose()"},
};

std::string_view LastPart(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

// Returns the asset: "cube" of scene["cube"].data.root_pos_w and of cube.pose.p; ASSET if it is not
// named.
std::string AssetOf(std::string_view path) {
  const std::size_t quote = path.find('"');
  if (quote != std::string_view::npos) {
    return std::string(path.substr(quote + 1, path.find('"', quote + 1) - quote - 1));
  }
  const std::string_view first = path.substr(0, path.find_first_of(".["));
  return IsForeignHandle(first) ? "ASSET" : std::string(first);
}

bool OfHand(std::string_view path) {
  return path.find("tcp") != std::string_view::npos || path.starts_with("agent") ||
         path.find("ee_frame") != std::string_view::npos;
}

std::string FilledRemedy(std::string_view pattern, const std::string& asset) {
  std::string text(pattern);
  const std::size_t at = text.find("{}");
  return at == std::string::npos ? text : text.replace(at, 2, asset);
}

}  // namespace

bool IsForeignHandle(std::string_view attribute) {
  return std::find(std::begin(kHandles), std::end(kHandles), attribute) != std::end(kHandles);
}

std::string ForeignRemedy(std::string_view path) {
  const std::string last = " " + std::string(LastPart(path)) + " ";
  for (const Foreign& row : kForeign) {
    if (row.names.find(last) == std::string_view::npos) continue;
    const bool pose = last == " p " || last == " q ";
    if (pose && OfHand(path)) {
      return last == " p " ? "that is of ManiSkill; here it is env.get_robot_gripper_pose()"
                           : "that is of ManiSkill; here it is env.get_robot_gripper_orientation()";
    }
    if (pose && path.starts_with("goal")) {
      return "that is of ManiSkill; here it is env.get_goal_pose(ASSET)";
    }
    return "that is of " + std::string(row.of) + "; here it is " +
           FilledRemedy(row.instead, AssetOf(path));
  }
  return "";
}

}  // namespace simwright::reward
