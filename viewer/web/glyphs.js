// Drawn symbols: frames, boxes, axes of joints, grippers and contacts. Lengths in m.
import * as THREE from './three.module.min.js';
import { apply, poseOf } from './kinematics.js';

function lines(points, colors, opacity = 1) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(points.flat(), 3));
  geometry.setAttribute('color', new THREE.Float32BufferAttribute(colors.flat(), 3));
  const material = new THREE.LineBasicMaterial({
    vertexColors: true, depthTest: false, transparent: true, opacity,
  });
  const object = new THREE.LineSegments(geometry, material);
  object.renderOrder = 5;
  return object;
}

// Returns the axes of a frame at `origin`: x red, y green, z blue.
export function frameGlyph(origin, size) {
  const points = [], colors = [];
  [[1, 0.15, 0.15], [0.1, 0.65, 0.1], [0.2, 0.4, 1]].forEach((color, axis) => {
    const end = [...origin];
    end[axis] += size;
    points.push(origin, end);
    colors.push(color, color);
  });
  return lines(points, colors);
}

// Returns the centre of mass: a ball and a frame.
export function massGlyph(center, size) {
  const group = frameGlyph(center, size);
  const ball = new THREE.Mesh(
    new THREE.SphereGeometry(0.12 * size, 20, 14),
    new THREE.MeshBasicMaterial({ color: 0xe0a11b, depthTest: false, transparent: true }));
  ball.position.set(...center);
  ball.renderOrder = 6;
  group.add(ball);
  return group;
}

// Returns the edges of a box with this pose and size.
export function boxGlyph(pose, size, color = [0.88, 0.5, 0.1]) {
  const corner = (i) => apply(pose, [0, 1, 2].map((k) => ((i >> k) & 1 ? 0.5 : -0.5) * size[k]));
  const points = [];
  for (let i = 0; i < 8; ++i) {
    for (let k = 0; k < 3; ++k) {
      if (!((i >> k) & 1)) points.push(corner(i), corner(i | (1 << k)));
    }
  }
  return lines(points, points.map(() => color));
}

// Returns the axis of a joint in its frame: an arrow, with a ring about a hinge.
export function jointGlyph(joint, size) {
  const axis = new THREE.Vector3(...joint.axis);
  const sliding = joint.type === 'prismatic';
  const color = sliding ? 0x1b8f8f : 0xa63fb5;
  const arrow = new THREE.ArrowHelper(axis, axis.clone().multiplyScalar(-0.5 * size), size, color,
    0.2 * size, 0.1 * size);
  const flat = (object) => {
    object.material.depthTest = false;
    object.material.transparent = true;
    object.renderOrder = 5;
  };
  flat(arrow.line);
  flat(arrow.cone);
  if (!sliding) {
    const ring = new THREE.Mesh(new THREE.TorusGeometry(0.22 * size, 0.015 * size, 6, 32),
      new THREE.MeshBasicMaterial({ color }));
    ring.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), axis);
    flat(ring);
    const group = new THREE.Group();
    group.add(arrow, ring);
    return group;
  }
  return arrow;
}

// Returns the colour of a quality in [0, 1], from red through yellow to green.
export function qualityColor(quality) {
  const color = new THREE.Color().setHSL(0.33 * Math.min(1, Math.max(0, quality)), 0.8, 0.45);
  return [color.r, color.g, color.b];
}

// Returns the grasps at a link, in its frame; those of a rigid body are at its root.
export function graspsAt(grasps, link, isRoot) {
  if (!grasps.links) return isRoot ? grasps : { poses: [], openings: [], qualities: [] };
  const here = (_, i) => grasps.links[i] === link;
  return {
    poses: grasps.poses.filter(here),
    openings: grasps.openings.filter(here),
    qualities: grasps.qualities.filter(here),
  };
}

// Returns a fork for each grasp: two fingers along the approach (z), apart along y, and a stem.
export function graspGlyph(grasps, depth = 0.045) {
  const points = [], colors = [];
  const best = Math.max(1e-9, ...grasps.qualities);
  grasps.poses.forEach((pose, i) => {
    const side = 0.5 * grasps.openings[i];
    const fork = [
      [0, -side, 0], [0, -side, -depth], [0, side, 0], [0, side, -depth],
      [0, -side, -depth], [0, side, -depth], [0, 0, -depth], [0, 0, -2 * depth]];
    const color = qualityColor(grasps.qualities[i] / best);
    for (const point of fork) {
      points.push(apply(pose, point));
      colors.push(color);
    }
  });
  return lines(points, colors, 0.85);
}

// Balls at contact points.
export class ContactGlyphs {
  constructor(count, size) {
    this.object = new THREE.Group();
    this.balls = Array.from({ length: count }, () => {
      const ball = new THREE.Mesh(new THREE.SphereGeometry(size, 16, 12),
        new THREE.MeshBasicMaterial({ color: 0xd8312b, depthTest: false, transparent: true, opacity: 0.85 }));
      ball.renderOrder = 7;
      ball.visible = false;
      this.object.add(ball);
      return ball;
    });
  }

  // `numbers`: x, y, z and strength of each contact.
  set(numbers) {
    this.balls.forEach((ball, i) => {
      const [x, y, z, strength] = numbers.subarray(4 * i, 4 * i + 4);
      ball.visible = strength > 0;
      ball.position.set(x, y, z);
      ball.material.color.setHex(strength > 1 ? 0x2f9a4a : 0xd8312b);
    });
  }
}

export function poseFromRow(row, at) {
  return poseOf(row[at], row[at + 1], row[at + 2], row[at + 3], row[at + 4], row[at + 5], row[at + 6]);
}
