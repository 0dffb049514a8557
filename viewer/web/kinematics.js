// Forward kinematics. A pose is the upper three rows of its matrix, row by row: 12 numbers.

export const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];

// Returns the pose a * b.
export function multiply(a, b) {
  const c = new Array(12);
  for (let row = 0; row < 3; ++row) {
    const i = 4 * row;
    for (let column = 0; column < 4; ++column) {
      c[i + column] = a[i] * b[column] + a[i + 1] * b[4 + column] + a[i + 2] * b[8 + column];
    }
    c[i + 3] += a[i + 3];
  }
  return c;
}

export function apply(pose, point) {
  return [0, 4, 8].map(
    (i) => pose[i] * point[0] + pose[i + 1] * point[1] + pose[i + 2] * point[2] + pose[i + 3]);
}

// Returns the pose of a position (m) and a unit quaternion x, y, z, w.
export function poseOf(x, y, z, qx, qy, qz, qw) {
  return [
    1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy - qz * qw), 2 * (qx * qz + qy * qw), x,
    2 * (qx * qy + qz * qw), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz - qx * qw), y,
    2 * (qx * qz - qy * qw), 2 * (qy * qz + qx * qw), 1 - 2 * (qx * qx + qy * qy), z];
}

// Returns the rotation by `angle` (rad) about a unit axis.
function turn([x, y, z], angle) {
  const c = Math.cos(angle), s = Math.sin(angle), t = 1 - c;
  return [
    t * x * x + c, t * x * y - s * z, t * x * z + s * y, 0,
    t * x * y + s * z, t * y * y + c, t * y * z - s * x, 0,
    t * x * z - s * y, t * y * z + s * x, t * z * z + c, 0];
}

// Returns the motion of a joint at `position` (rad or m).
export function jointMotion(joint, position) {
  if (joint.type === 'revolute' || joint.type === 'continuous') return turn(joint.axis, position);
  if (joint.type === 'prismatic') {
    const [x, y, z] = joint.axis.map((a) => a * position);
    return [1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z];
  }
  return IDENTITY;
}

export function moves(joint) {
  return ['revolute', 'continuous', 'prismatic'].includes(joint.type);
}

// Returns a joint's range, rad or m; that of a continuous joint is a full turn.
export function rangeOf(joint) {
  return joint.type === 'continuous' ? [-Math.PI, Math.PI] : [joint.lower, joint.upper];
}

// Returns the position nearest to zero within a joint's range.
export function restOf(joint) {
  const [lower, upper] = rangeOf(joint);
  return Math.min(Math.max(0, lower), Math.max(upper, lower));
}

// Returns the positions of all joints; mimic joints follow their leaders.
export function followLeaders(joints, positions) {
  const byName = new Map(joints.map((joint, i) => [joint.name, i]));
  const resolve = (i, depth) => {
    const mimic = joints[i].mimic;
    if (!mimic || depth > joints.length) return positions[i];
    const leader = byName.get(mimic.joint);
    return mimic.multiplier * (leader === undefined ? 0 : resolve(leader, depth + 1)) + mimic.offset;
  };
  return joints.map((_, i) => resolve(i, 0));
}

// Returns the pose of each link in the root's frame. joints[i] leads to links[i + 1].
export function linkPoses(model, positions) {
  const all = followLeaders(model.joints, positions);
  const poses = [IDENTITY];
  model.joints.forEach((joint, i) => {
    poses.push(multiply(multiply(poses[joint.parent], joint.parent_from_joint),
      jointMotion(joint, all[i])));
  });
  return poses;
}
