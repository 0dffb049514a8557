// Rewards of other simulators: each unknown name is reported at its position with its equivalent
// here.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "reward/environment_api.h"
#include "reward/frontend/foreign_names.h"
#include "reward/reward_program.h"

namespace simwright::reward {
namespace {

struct Foreign {
  const char* name;
  const char* source;
  const char* place;
  const char* says;
};

std::ostream& operator<<(std::ostream& out, const Foreign& one) {
  return out << one.name;
}

class RewardForeign : public testing::TestWithParam<Foreign> {};

TEST_P(RewardForeign, IsNamedWithWhatReadsItHere) {
  const Foreign& one = GetParam();
  const CompileOutcome outcome = CompileReward(one.source, nullptr);
  EXPECT_FALSE(outcome.program.has_value());
  ASSERT_FALSE(outcome.findings.empty());
  const core::Finding& finding = outcome.findings[0];
  EXPECT_EQ(finding.place, one.place) << RenderFinding(finding, one.source);
  EXPECT_NE(finding.sentence.find(one.says), std::string::npos) << finding.sentence;
}

#define ENV "def compute_reward(env):\n    return "
#define SELF "def compute_dense_reward(self, obs, action, info):\n    return "

constexpr Foreign kForeign[] = {
    {"IsaacLabPosition",
     "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from isaaclab.envs import X\n"
     "def lift(env: X, cfg: SceneEntityCfg = SceneEntityCfg(\"cube\")):\n"
     "    thing = env.scene[cfg.name]\n    return thing.data.root_pos_w[:, 2]\n",
     "6:23", "env.get_position(\"cube\")"},
    {"IsaacLabJoints", ENV "env.scene[\"robot\"].data.joint_vel[:, 0]\n", "2:36",
     "env.get_velocity_by_joint_name(\"robot\", JOINT)"},
    {"IsaacLabHand", ENV "env.scene[\"ee_frame\"].data.target_pos_w[..., 0, 2]\n", "2:39",
     "env.get_robot_gripper_pose()"},
    {"IsaacLabCommand", ENV "env.command_manager.get_command(\"pose\")\n", "2:32",
     "env.get_goal_pose(ASSET)"},
    {"IsaacLabAction", ENV "env.action_manager.action\n", "2:31", "leave the term out"},
    {"IsaacGymStates", "def compute_reward(self):\n    return self.root_states[:, 2]\n", "2:17",
     "env.get_position(ASSET)"},
    {"IsaacGymJoints", "def compute_reward(self):\n    return self.dof_pos[:, 0]\n", "2:17",
     "env.get_state_by_joint_name(ASSET, JOINT)"},
    {"IsaacGymProgress", "def compute_reward(self):\n    return self.progress_buf\n", "2:17",
     "leave the term out"},
    {"ManiSkillPose", SELF "self.cube.pose.p[:, 2]\n", "2:27", "env.get_position(\"cube\")"},
    {"ManiSkillHand", SELF "self.agent.tcp.pose.p[:, 2]\n", "2:32", "env.get_robot_gripper_pose()"},
    {"ManiSkillTurn", SELF "self.peg.pose.q[:, 2]\n", "2:26", "env.get_orientation(\"peg\")"},
    {"ManiSkillGrasp", SELF "self.agent.is_grasping(self.cube)\n", "2:23",
     "env.check_grasped(ASSET)"},
    {"ManiSkillSpeed", SELF "self.cube.linear_velocity[:, 2]\n", "2:22",
     "env.get_linear_velocity(\"cube\")"},
    {"RobosuiteBody", "def reward(self):\n    return self.sim.data.body_xpos[self.cube_id][2]\n",
     "2:26", "env.get_position(ASSET)"},
    {"RobosuiteGrasp", "def reward(self):\n    return self._check_grasp(self.gripper, self.cube)\n",
     "2:17", "env.check_grasped(ASSET)"},
    {"GymnasiumData", "def reward(self):\n    return self.data.qpos[2]\n", "2:22",
     "env.get_state_by_joint_name(ASSET, JOINT)"},
    {"GymnasiumUnwrapped", ENV "env.unwrapped.data.xpos[1]\n", "2:31", "env.get_position(ASSET)"},
    {"Unknown", ENV "env.scene.thing\n", "2:22", "env.get_position(ASSET)"},
};
INSTANTIATE_TEST_SUITE_P(Simulators, RewardForeign, testing::ValuesIn(kForeign),
                         [](const auto& one) { return std::string(one.param.name); });

// Every remedy names an existing function.
TEST(RewardForeignNames, RemediesNameFunctionsOfTheEnvironment) {
  for (const char* path :
       {"scene[\"a\"].data.root_pos_w", "scene[\"a\"].data.root_quat_w", "a.pose.p", "a.pose.q",
        "scene[\"a\"].data.root_lin_vel_w", "scene[\"a\"].data.root_ang_vel_w",
        "scene[\"a\"].data.body_pos_w", "scene[\"a\"].data.joint_pos", "root_states", "dof_vel",
        "sim.data.site_xpos", "sim.data.body_xquat", "data.cvel", "_check_grasp", "goal_pos"}) {
    const std::string remedy = ForeignRemedy(path);
    const size_t at = remedy.find("env.get_"), check = remedy.find("env.check_");
    const size_t begin = std::min(at, check);
    ASSERT_NE(begin, std::string::npos) << path << ": " << remedy;
    const std::string name = remedy.substr(begin + 4, remedy.find('(', begin) - begin - 4);
    EXPECT_NE(FindApiFunction(name), nullptr) << remedy;
  }
  EXPECT_EQ(ForeignRemedy("zorbel"), "");
}

}  // namespace
}  // namespace simwright::reward
