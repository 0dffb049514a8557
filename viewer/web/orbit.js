// A camera that orbits a target by pointer, wheel and keys. z is up.
import * as THREE from './three.module.min.js';

const STEEPEST = 1.55;  // rad

export class Orbit {
  constructor(camera, element, changed) {
    Object.assign(this, { camera, element, changed });
    this.target = new THREE.Vector3();
    this.distance = 1;
    this.azimuth = -2.2;  // rad from +x
    this.elevation = 0.45;  // rad above the horizontal plane
    this.pointers = new Map();
    this.enabled = true;
    element.addEventListener('pointerdown', (event) => this.down(event));
    element.addEventListener('pointermove', (event) => this.move(event));
    for (const name of ['pointerup', 'pointercancel']) {
      element.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
    }
    element.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.zoom(Math.exp(0.0012 * event.deltaY * (event.deltaMode === 1 ? 16 : 1)));
    }, { passive: false });
    element.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  down(event) {
    this.element.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  }

  move(event) {
    const last = this.pointers.get(event.pointerId);
    if (!last || !this.enabled) return;
    const dx = event.clientX - last.x, dy = event.clientY - last.y;
    if (this.pointers.size === 2) {
      const other = [...this.pointers.entries()].find(([id]) => id !== event.pointerId)[1];
      const before = Math.hypot(last.x - other.x, last.y - other.y);
      const after = Math.hypot(event.clientX - other.x, event.clientY - other.y);
      this.pan(dx / 2, dy / 2);
      if (before > 0 && after > 0) this.zoom(before / after);
    } else if (event.buttons & 2 || event.buttons & 4 || event.shiftKey) {
      this.pan(dx, dy);
    } else {
      this.rotate(-0.008 * dx, 0.008 * dy);
    }
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  }

  rotate(azimuth, elevation) {
    this.azimuth += azimuth;
    this.elevation = Math.min(STEEPEST, Math.max(-STEEPEST, this.elevation + elevation));
    this.update();
  }

  zoom(factor) {
    this.distance = Math.min(1e4, Math.max(1e-3, this.distance * factor));
    this.update();
  }

  // Moves the target by pixels of the view.
  pan(dx, dy) {
    const perPixel = 2 * this.distance * Math.tan(THREE.MathUtils.degToRad(this.camera.fov) / 2) /
      Math.max(1, this.element.clientHeight);
    const right = new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
    const up = new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
    this.target.addScaledVector(right, -dx * perPixel).addScaledVector(up, dy * perPixel);
    this.update();
  }

  // Frames a box so that it fills the view.
  frame(box) {
    if (box.isEmpty()) return;
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    const half = THREE.MathUtils.degToRad(this.camera.fov) / 2;
    const narrow = Math.atan(Math.tan(half) * Math.min(1, this.camera.aspect));
    this.target.copy(sphere.center);
    this.distance = 1.08 * Math.max(1e-3, sphere.radius) / Math.sin(narrow);
    this.update();
  }

  update() {
    const { camera, target, distance, azimuth, elevation } = this;
    camera.up.set(0, 0, 1);
    camera.position.set(
      target.x + distance * Math.cos(elevation) * Math.cos(azimuth),
      target.y + distance * Math.cos(elevation) * Math.sin(azimuth),
      target.z + distance * Math.sin(elevation));
    camera.lookAt(target);
    camera.near = Math.max(1e-4, 0.01 * distance);
    camera.far = 200 * distance + 100;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld(true);
    this.changed();
  }
}
