# Every function of the environment.
def compute_reward(env):
    total = torch.zeros(env.num_envs, device=env.device)
    for link in ["link_0", "handle_0"]:
        total += env.get_link_position("microwave", link).sum(dim=-1)
    for index in range(1):
        total += env.get_pose_by_link_name("microwave", f"handle_{index}")[:, 1]
    q = env.get_orientation_by_link_name("microwave", "handle_0")
    v = env.get_linear_velocity_by_link_name("microwave", "handle_0")
    w = env.get_angular_velocity_by_link_name("microwave", "handle_0")
    total += quat_rotate(q, v).sum(-1) + quat_apply(q, w)[:, 0] + quat_axis(q, 2)[:, 2]
    roll, pitch, yaw = get_euler_xyz(q)
    total += (torch.cos(roll) + torch.cos(yaw)) * torch.cos(pitch) + torch.sin(pitch)
    total += env.get_position(asset_name="cup")[:, 2] + quat_unit(env.get_orientation("cup"))[:, 3]
    total += env.get_linear_velocity("cup").norm(dim=-1) + env.get_angular_velocity("cup")[:, 0]
    g = env.get_robot_gripper_orientation()
    total += torch.cos(quat_diff_rad(g, q)) + normalize(v)[:, 0] + normalize_angle(total * 3)
    total += quat_from_angle_axis(total, v)[:, 3]
    total += env.get_robot_gripper_velocity()[:, 0] + env.get_robot_gripper_angular_velocity()[:, 1]
    total += env.get_robot_gripper_opening() + env.get_robot_gripper_contact("cup").float()
    total += env.check_grasped("cup") * 1.5 + (env.get_robot_gripper_contact() & env.is_grasped("cup"))
    total += env.get_velocity_by_joint_name("microwave", "joint_0")
    low, high = env.get_bounding_box("cup")
    inside = env.in_bbox(env.get_goal_position(), low, high)
    total += env.get_distance(env.get_goal_position(), low) + inside.float()
    total += env.get_joint_lower_limit("microwave", "joint_1") + env.get_joint_limits("microwave", "joint_1")["upper"]
    success = (0.2 < total) & (total < 4.0)
    return total, success
