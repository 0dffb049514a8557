# Reach the handle and open the door: two terms and a threshold.
def compute_reward(env):
    # where things are
    handle = env.get_pose_by_link_name("microwave", "handle_0")
    gripper = env.get_robot_gripper_pose()
    reach = torch.norm(handle - gripper, dim=-1)
    door = env.get_state_by_joint_name("microwave", "joint_0")
    upper = env.get_limits_by_joint_name("microwave", "joint_0")["upper"]
    lower = env.get_limits_by_joint_name("microwave", "joint_0")["lower"]
    gap = torch.abs(upper - door)
    cost = reach + gap
    reward = -cost + (+0.5) * lower
    success = gap <= 0.1 * (upper - lower)
    return reward, success
