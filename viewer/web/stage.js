// The canvas: renderer, lights, ground. It renders only when something has changed.
import * as THREE from './three.module.min.js';
import { Orbit } from './orbit.js';

const SLOW_FRAME = 70;  // ms between frames: the resolution is then halved while the view moves

// Returns true if the processor renders, as in a virtual machine.
function rendersInSoftware() {
  const gl = document.createElement('canvas').getContext('webgl2');
  const names = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = names ? gl.getParameter(names.UNMASKED_RENDERER_WEBGL) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.software = rendersInSoftware() && location.hash !== '#full';
    this.renderer = new THREE.WebGLRenderer({
      canvas, antialias: !this.software, preserveDrawingBuffer: true });
    this.renderer.shadowMap.enabled = !this.software;
    this.renderer.shadowMap.autoUpdate = false;
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.01, 100);
    this.world = new THREE.Group();
    this.scene.add(this.world);
    this.addLights();
    this.addGround();
    this.listeners = [];
    this.scale = 1;  // of the resolution
    this.orbit = new Orbit(this.camera, canvas, () => this.moved());
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  addLights() {
    this.sky = new THREE.HemisphereLight(0xffffff, 0x8d8a85, 1.9);
    this.sky.position.set(0, 0, 1);
    this.sun = new THREE.DirectionalLight(0xffffff, 1.9);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.bias = -0.002;
    this.scene.add(this.sky, this.sun, this.sun.target);
  }

  addGround() {
    this.ground = new THREE.Group();
    this.shade = new THREE.Mesh(new THREE.PlaneGeometry(1, 1),
      new THREE.ShadowMaterial({ opacity: 0.22, depthWrite: false }));
    this.shade.receiveShadow = true;
    this.ground.add(this.shade);
    this.shade.visible = !this.software;
    this.scene.add(this.ground);
  }

  // Fits ground and light to the content. Requires a box that is not empty.
  fit(box) {
    const size = box.getSize(new THREE.Vector3()).length();
    const center = box.getCenter(new THREE.Vector3());
    const cell = 10 ** Math.round(Math.log10(0.25 * size));
    const cells = 2 * Math.ceil(1.5 * size / cell);
    this.grid?.removeFromParent();
    this.grid?.geometry.dispose();
    this.grid = new THREE.GridHelper(cell * cells, cells, this.lineColor, this.lineColor);
    this.grid.rotation.x = Math.PI / 2;
    const snap = (value) => Math.round(value / cell) * cell;
    this.grid.position.set(snap(center.x), snap(center.y), -1e-4 * size);
    this.ground.add(this.grid);
    this.cell = cell;
    this.shade.scale.set(8 * size, 8 * size, 1);
    this.shade.position.set(center.x, center.y, -5e-5 * size);
    const camera = this.sun.shadow.camera;
    this.sun.position.copy(center).add(new THREE.Vector3(-0.5, -0.75, 1.6).multiplyScalar(size));
    this.sun.target.position.copy(center);
    Object.assign(camera, {
      left: -0.8 * size, right: 0.8 * size, top: 0.8 * size, bottom: -0.8 * size,
      near: 0.2 * size, far: 4 * size });
    this.sun.shadow.bias = -0.0015;
    this.sun.shadow.normalBias = 0.004 * size;
    camera.updateProjectionMatrix();
    this.sun.target.updateMatrixWorld(true);
    this.changed();
  }

  setTheme(dark) {
    this.lineColor = dark ? 0x3c464d : 0xc3ccd2;
    this.background = new THREE.Color(dark ? 0x20262b : 0xe9eef2);
    this.shade.material.opacity = dark ? 0.45 : 0.22;
    this.scene.background = this.background;
    this.invalidate();
  }

  // Paints the content white on black and hides all else, for comparison with other renderers.
  setSilhouette(on) {
    this.scene.overrideMaterial = on
      ? new THREE.MeshBasicMaterial({ color: 0xffffff, side: THREE.DoubleSide }) : null;
    this.scene.background = on ? new THREE.Color(0) : this.background;
    this.ground.visible = !on;
    this.invalidate();
  }

  resize() {
    const width = Math.max(1, this.canvas.clientWidth), height = Math.max(1, this.canvas.clientHeight);
    this.renderer.setPixelRatio(this.scale * Math.min(this.software ? 1 : 2, window.devicePixelRatio));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.invalidate();
  }

  // The content has moved: its shadows are drawn again.
  changed() {
    this.renderer.shadowMap.needsUpdate = true;
    this.invalidate();
  }

  // The camera has moved.
  moved() {
    clearTimeout(this.settling);
    this.settling = setTimeout(() => {
      this.moving = false;
      this.setScale(1);
    }, 300);
    this.moving = true;
    this.invalidate();
  }

  setScale(scale) {
    if (this.scale === scale) return;
    this.scale = scale;
    this.resize();
  }

  invalidate() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame((time) => this.render(time));
  }

  render(time) {
    this.pending = false;
    const interval = time - (this.lastTime ?? 0);
    this.lastTime = time;
    if (this.moving && interval < 1000) this.measure(interval);
    for (const listener of this.listeners) listener(time);
    this.renderer.render(this.scene, this.camera);
    this.rendered = (this.rendered ?? 0) + 1;
  }

  measure(interval) {
    this.intervals = [...(this.intervals ?? []), interval].slice(-3);
    if (this.intervals.length === 3 && this.intervals.every((one) => one > SLOW_FRAME)) {
      this.intervals = [];
      this.setScale(0.5);
    }
  }

  // Returns the body under a point of the canvas, in pixels, with the point hit, or null.
  pick(x, y, bodies) {
    const rectangle = this.canvas.getBoundingClientRect();
    const point = new THREE.Vector2(
      2 * (x - rectangle.left) / rectangle.width - 1, 1 - 2 * (y - rectangle.top) / rectangle.height);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(point, this.camera);
    const meshes = bodies.filter((body) => body.group.visible).flatMap((body) => body.meshes());
    const [hit] = caster.intersectObjects(meshes, false);
    return hit ? { body: hit.object.userData.body, link: hit.object.userData.link, point: hit.point } : null;
  }
}
