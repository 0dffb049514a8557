"""Observes and acts in an exported world as Simwright does, with MuJoCo and NumPy alone.

`simwright export TASKS --task NAME --world --format mjcf -o DIR` writes world.xml and task.json;
`simwright export --skill NAME --format onnx -o FILE` writes the policy. The action space must be
`focus`: the pose of the tool relative to the target frame (docs/skills.md).
"""

import json
import pathlib

import mujoco
import numpy as np

GRASP_FORCE = 1.0  # N by each finger
PASSED = 0.05  # rad of any joint: a waypoint has been passed


def rotation(quaternion):
    """Returns the rotation matrix (3 x 3) of a unit quaternion w, x, y, z."""
    matrix = np.zeros(9)
    mujoco.mju_quat2Mat(matrix, np.asarray(quaternion, dtype=float))
    return matrix.reshape(3, 3)


def turn_about(vector):
    """Returns the rotation matrix of a rotation vector (rad)."""
    angle = np.linalg.norm(vector)
    if angle < 1e-9:
        return np.eye(3)
    quaternion = np.zeros(4)
    mujoco.mju_axisAngle2Quat(quaternion, np.asarray(vector) / angle, angle)
    return rotation(quaternion)


def rotation_vector(matrix):
    """Returns the rotation vector (rad) of a rotation matrix."""
    quaternion, vector = np.zeros(4), np.zeros(3)
    mujoco.mju_mat2Quat(quaternion, matrix.flatten())
    mujoco.mju_quat2Vel(vector, quaternion, 1.0)
    return vector


class Pose:
    """A rigid transform: rotation R (3 x 3) and position p (3), m."""

    def __init__(self, R, p):
        self.R, self.p = np.asarray(R, dtype=float), np.asarray(p, dtype=float)

    @staticmethod
    def of(entry):
        return Pose(rotation(entry["quaternion_wxyz"]), entry["position"])

    def __matmul__(self, other):
        return Pose(self.R @ other.R, self.R @ other.p + self.p)

    def inverse(self):
        return Pose(self.R.T, -self.R.T @ self.p)


class ExportedTask:
    """The world of a task in MuJoCo, with the policy's observation and action."""

    def __init__(self, folder):
        folder = pathlib.Path(folder)
        self.task = json.loads((folder / "task.json").read_text())
        self.options, self.robot = self.task["options"], self.task["robot"]
        self.target = self.task["target"]
        if self.options["action_space"] != "focus":
            raise ValueError("the action space is not 'focus'")
        self.model = mujoco.MjModel.from_xml_path(str(folder / "world.xml"))
        self.data = mujoco.MjData(self.model)
        self.scratch = mujoco.MjData(self.model)  # for kinematics
        joint = lambda name: self.model.joint(name)
        self.arm = [joint(a["joint"]) for a in self.robot["arm"]]
        self.q_index = np.array([a.qposadr[0] for a in self.arm])
        self.v_index = np.array([a.dofadr[0] for a in self.arm])
        self.u_index = [self.model.actuator(a["joint"]).id for a in self.robot["arm"]]
        self.finger_index = [joint(f["joint"]).qposadr[0] for f in self.robot["fingers"]]
        self.finger_motor = [self.model.actuator(f["joint"]).id for f in self.robot["fingers"]]
        limit = lambda key: np.array([a[key] for a in self.robot["arm"]])
        self.lower, self.upper = limit("lower"), limit("upper")
        self.velocity, self.acceleration = limit("velocity"), limit("acceleration")
        self.base = Pose.of(self.robot["world_from_base"])
        self.dt = 1.0 / self.options["control_rate_hz"]
        self.reset()

    def reset(self):
        mujoco.mj_resetDataKeyframe(self.model, self.data, 0)
        mujoco.mj_forward(self.model, self.data)
        self.sent = self.data.qpos[self.q_index].copy()
        self.rest = np.array(self.target["grasp_configuration"])
        self.goal = self.rest.copy()
        self.waypoints = [np.array(w) for w in self.target["waypoints"]]
        self.rate, self.leader_rate = np.zeros_like(self.sent), 0.0
        self.leader = self.data.qpos[self.finger_index[0]]
        self.last_action = np.zeros(7)
        self.held, self.at_destination, self.succeeded = 0, False, 0
        link = Pose.of(self.target["link_from_target"])
        self.frame_turn = (self.body(self.target["link"]) @ link).R
        self.grasp_point, self.decisions_at_rest = link.p, 0  # in the link's frame
        self.previous = self._moving()

    # The state.

    def body(self, name, data=None):
        found = (data or self.data).body(name)
        return Pose(found.xmat.reshape(3, 3).copy(), found.xpos.copy())

    def tool(self):
        return self.body(self.robot["tool_body"])

    def joint_positions(self):
        return [self.data.joint(j["joint"]).qpos[0] for j in self.task["program_joints"]]

    def object_center(self, entry):
        pose = self.body(entry["body"])
        return pose.R @ np.array(entry["center"]) + pose.p

    def _moving(self):
        return np.array(self.joint_positions()), self.object_center(self.target)

    def finger_forces(self):
        """Returns the force (N) of each finger on the target object."""
        root = self.model.body(self.target["body"]).rootid[0]
        fingers = [self.model.body(f["body"]).id for f in self.robot["fingers"]]
        forces, wrench = [0.0, 0.0], np.zeros(6)
        touched = False
        for i in range(self.data.ncon):
            contact = self.data.contact[i]
            bodies = [self.model.geom_bodyid[g] for g in (contact.geom1, contact.geom2)]
            for a, b in (bodies, bodies[::-1]):
                if a in fingers and self.model.body_rootid[b] == root:
                    mujoco.mj_contactForce(self.model, self.data, i, wrench)
                    forces[fingers.index(a)] += wrench[0]
                    touched = True
        return touched, min(forces) > GRASP_FORCE

    def to_goal(self):
        return np.array(self.task["goal"]) - self.object_center(self.target)

    def target_pose(self):
        """Returns the target frame in the world."""
        link = self.body(self.target["link"])
        if not self.target["grasps_object"]:
            return link @ Pose.of(self.target["link_from_target"])
        point = link.R @ self.grasp_point + link.p
        return Pose(self.frame_turn, point + self.to_goal() if self.at_destination else point)

    # The observation.

    def observe(self):
        """Returns the observation (O), in the order of task.json's `observation`."""
        frame, tool, target = self.target_pose(), self.tool(), self.target
        q, v = self.data.qpos[self.q_index], self.data.qvel[self.v_index]
        tool_in_frame, frame_in_base = frame.inverse() @ tool, self.base.inverse() @ frame
        axes = lambda R: [*R[:, 1], *R[:, 2]]
        widest = self.robot["open"]
        opening = lambda leader: 2.0 * leader / widest - 1.0
        touched, grasped = self.finger_forces()
        row = [*(2.0 * (q - 0.5 * (self.lower + self.upper)) / (self.upper - self.lower))]
        row += [*(v / 2.0), *(tool_in_frame.p / 0.1), *axes(tool_in_frame.R)]
        row += [opening(self.data.qpos[self.finger_index[0]]), opening(self.leader)]
        row += [float(touched), float(grasped)]
        row += [*(frame_in_base.p / 0.5), *axes(frame_in_base.R), float(self.at_destination)]
        joints, center = self._moving()
        decision = self.options["control_steps"] * self.dt
        for j, now, before in zip(self.task["program_joints"], joints, self.previous[0]):
            span = j["upper"] - j["lower"]
            row += [2.0 * (now - j["lower"]) / span - 1.0, (now - before) / (span * decision)]
        row += [*(frame.R.T @ (center - tool.p) / 0.1), *(frame.R.T @ self.body(target["body"]).R[:, 2])]
        row += [*(frame.R.T @ (center - self.previous[1]) / (0.5 * decision))]
        row += [*(np.array(target["size"]) / 0.1), *self._part(frame)]
        for other in self.task["other_objects"]:
            row += [*(frame.R.T @ (self.object_center(other) - tool.p) / 0.5)]
            row += [*(frame.R.T @ self.body(other["body"]).R[:, 2]), *(np.array(other["size"]) / 0.1)]
        if self.task["goal"] is not None:
            row += [*(frame.R.T @ self.to_goal() / 0.1)]
        return np.array([*row, *self.last_action], dtype=np.float32)

    def _part(self, frame):
        """Returns size, centre, motion and hinge of the part in the target frame."""
        into = frame.inverse()
        points = []
        for entry in self.target["points"]:
            pose = into @ self.body(entry["body"])
            points += [pose.R @ np.array(p) + pose.p for p in entry["points"]]
        low, high = np.min(points, axis=0), np.max(points, axis=0)
        row = [*((high - low) / 0.1)]
        joint = self.target["joint"]
        if joint is None:
            return row
        moved = into @ self.body(joint["body"])
        axis = moved.R @ np.array(joint["axis"])
        motion, hinge = axis, np.zeros(3)
        if not joint["prismatic"]:
            hinge = moved.p - axis.dot(moved.p) * axis
            motion = np.cross(axis, -hinge)
            motion = motion / np.linalg.norm(motion) if np.linalg.norm(hinge) > 1e-3 else np.zeros(3)
        return row + [*(0.5 * (low + high) / 0.1), *motion, *(hinge / 0.5)]

    # The action.

    def act(self, action):
        """Executes an action (7) for one decision; returns True once success has held."""
        self.last_action = np.clip(np.asarray(action, dtype=float), -1.0, 1.0)
        self.previous = self._moving()
        wanted, fingers = self._tool_target(self.last_action)
        for _ in range(self.options["control_steps"]):
            self._step_command(wanted, fingers)
            self.data.ctrl[self.u_index] = self.sent
            self.data.ctrl[self.finger_motor] = self.leader
            for _ in range(round(self.dt / self.model.opt.timestep)):
                mujoco.mj_step(self.model, self.data)
        _, grasped = self.finger_forces()
        self._follow(grasped)
        self.succeeded = self.succeeded + 1 if self._success(grasped) else 0
        return self.succeeded * self.options["control_steps"] * self.dt >= self.options["hold_seconds"]

    def _success(self, grasped):
        """Returns whether the joint is at its target, or the grasped object at its goal."""
        joint = self.target["joint"]
        if joint is None:
            return grasped and np.linalg.norm(self.to_goal()) <= 0.03
        q, start = self.data.joint(joint["joint"]).qpos[0], self.model.key_qpos[0][
            self.model.joint(joint["joint"]).qposadr[0]]
        return (q - start) * np.sign(joint["target"] - start) >= abs(joint["target"] - start)

    def _follow(self, grasped):
        """Moves the frame to the destination after three decisions in the grasp."""
        if not self.target["grasps_object"] or self.task["goal"] is None:
            return
        self.held = self.held + 1 if grasped else 0
        if self.held >= 3:
            self.at_destination = True
        link, tool = self.body(self.target["link"]), self.tool().p
        if np.linalg.norm(link.R @ self.grasp_point + link.p - tool) > 0.06:
            self.at_destination = False
        if not self.at_destination:
            return
        # An object that has slid in the fingers is grasped elsewhere now.
        rests = grasped and np.linalg.norm(tool - self.target_pose().p) < 0.005
        self.decisions_at_rest = self.decisions_at_rest + 1 if rests else 0
        if self.decisions_at_rest >= 4 and np.linalg.norm(self.to_goal()) >= 0.025:
            self.grasp_point, self.decisions_at_rest = link.R.T @ (tool - link.p), 0

    def _tool_target(self, action):
        """Returns the tool's target in the world, and that of the fingers."""
        target, frame = self.target, self.target_pose()
        lean = turn_about(np.array([0.0, target["lean"], 0.0]))
        offset = Pose(turn_about(self.options["turn"] * action[3:6]) @ lean,
                      self.options["reach"] * action[:3])
        now = frame.inverse() @ self._tool_at(self.sent)
        back = np.array(target["back"])
        if target["pushes"] and now.p[2] < -0.015:
            offset.p[0] = min(offset.p[0], 0.0)
        offset.p = offset.p + self._standoff(now, back) * back
        fingers = self.leader
        if action[6] > 0.15:
            fingers = self.robot["open"]
        elif action[6] < -0.15:
            fingers = self.robot["closed"]
        return frame @ offset, fingers

    def _standoff(self, now, back):
        """Returns the distance (m) that the tool stays back while it is off to a side."""
        lateral = now.p - now.p.dot(back) * back
        direction = np.array(self.target["motion_direction"])
        direction = direction - direction.dot(back) * back
        if self.target["pushes"]:
            lateral[0] = max(0.0, lateral[0] - 0.05)
            direction = np.zeros(3)
        counted = np.linalg.norm(lateral - max(0.0, lateral.dot(direction)) * direction)
        turned = np.linalg.norm(rotation_vector(
            now.R @ turn_about(np.array([0.0, -self.target["lean"], 0.0]))))
        return min(max(self.options["standoff"], self.target["retreat_distance"]),
                   2.0 * max(0.0, counted - 0.025) + 0.15 * max(0.0, turned - 0.4))

    def _tool_at(self, q, jacobian=None):
        """Returns the tool pose at arm positions q, and fills `jacobian` (6 x J)."""
        self.scratch.qpos[:] = self.data.qpos
        self.scratch.qpos[self.q_index] = q
        mujoco.mj_kinematics(self.model, self.scratch)
        if jacobian is not None:
            mujoco.mj_comPos(self.model, self.scratch)
            full = np.zeros((6, self.model.nv))
            tool = self.model.body(self.robot["tool_body"]).id
            mujoco.mj_jacBody(self.model, self.scratch, full[:3], full[3:], tool)
            jacobian[:] = full[:, self.v_index]
        return self.body(self.robot["tool_body"], self.scratch)

    def _track(self, wanted):
        """Moves the goal configuration towards the wanted tool pose: damped least squares."""
        J = np.zeros((6, len(self.goal)))
        weight = np.array([1.0, 1.0, 1.0, 0.3, 0.3, 0.3])
        start = self.goal.copy()
        for _ in range(2):
            tool = self._tool_at(self.goal, J)
            error = np.concatenate([wanted.p - tool.p, rotation_vector(wanted.R @ tool.R.T)]) * weight
            A = J * weight[:, None]
            damping = 0.5 * error.dot(error) + 1e-5
            inverse = A.T @ np.linalg.inv(A @ A.T + damping * np.eye(6))
            step = inverse @ error
            null = np.eye(len(step)) - inverse @ A
            step = step + 0.02 * null @ (self.rest - self.goal)
            step *= min(1.0, 0.1 / max(1e-9, np.abs(step).max()))
            self.goal = np.clip(self.goal + step, self.lower, self.upper)
        self.goal = start + np.clip(self.goal - start, -0.1, 0.1)

    def _step_command(self, wanted, fingers):
        if self.waypoints and np.abs(self.waypoints[0] - self.sent).max() < PASSED:
            self.waypoints.pop(0)
        if not self.waypoints:
            self._track(wanted)
        goal = self.waypoints[0] if self.waypoints else self.goal
        way, lead = goal - self.sent, self.options["longest_lead"]
        rate = min(1.0 / self.dt, self._fastest(way))
        ahead = self.sent - self.data.qpos[self.q_index]
        most = 0.7 * self.acceleration * self.dt
        wanted_rate = rate * way
        if self.at_destination:  # all joints accelerate in proportion: the tool stays on its line
            missing = wanted_rate - self.rate
            share = np.min(most / np.maximum(np.abs(missing), most))
            wanted_rate = self.rate + share * missing
        held = np.clip(wanted_rate, np.minimum(0.0, (-lead - ahead) / self.dt),
                       np.maximum(0.0, (lead - ahead) / self.dt))
        self.rate = self.rate + np.clip(held - self.rate, -most, most)
        moved = np.clip(self.sent + self.dt * self.rate, self.lower, self.upper)
        self.rate, self.sent = (moved - self.sent) / self.dt, moved
        self._step_fingers(fingers)

    def _fastest(self, way):
        """Returns the rate (1/s) along `way` within the limits of joints and tool."""
        J = np.zeros((6, len(way)))
        self._tool_at(self.sent, J)
        length = np.abs(way) + 1e-12
        most = np.minimum(0.9 * self.velocity,
                          self._stopping(length, 0.7 * self.acceleration))
        tool = J @ way
        shift, turn = np.linalg.norm(tool[:3]) + 1e-12, np.linalg.norm(tool[3:]) + 1e-12
        return min((most / length).min(), self.options["tool_speed"] / shift,
                   self.options["turn_speed"] / turn)

    def _stopping(self, distance, acceleration):
        step = acceleration * self.dt
        return 0.5 * (np.sqrt(step * step + 8.0 * acceleration * distance) - step)

    def _step_fingers(self, target):
        way = target - self.leader
        most = min(self.robot["finger_velocity"], abs(way) / self.dt,
                   self._stopping(abs(way), 0.7 * self.robot["finger_acceleration"]))
        change = 0.7 * self.robot["finger_acceleration"] * self.dt
        self.leader_rate += np.clip(np.copysign(most, way) - self.leader_rate, -change, change)
        self.leader += self.dt * self.leader_rate
