def compute_reward(env):
    handle_position = env.get_pose_by_link_name("microwave", "handle_0")
    gripper_position = env.get_robot_gripper_pose()
    reach_distance = torch.norm(gripper_position - handle_position, dim=-1)
    door_angle = env.get_state_by_joint_name("microwave", "joint_0")
    open_angle = env.get_limits_by_joint_name("microwave", "joint_0")["upper"]
    angle_left = torch.abs(open_angle - door_angle)
    cost = reach_distance + angle_left
    reward = -cost
    success = angle_left < 0.1
    return reward, success
