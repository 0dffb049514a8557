// The viewer: opens the content, shows one of its worlds, and connects panel, keys and player.
import * as THREE from './three.module.min.js';
import { Body } from './bodies.js';
import { massGlyph } from './glyphs.js';
import { expose } from './inspection.js';
import { fillHelp, listen } from './keys.js';
import { apply, moves } from './kinematics.js';
import { MeshStore } from './meshes.js';
import { Panel } from './panel.js';
import { openSource, rowsOf } from './source.js';
import { Stage } from './stage.js';
import { Player } from './timeline.js';

const POLL_MS = 2000;
const TOOL_CAMERA = { x: 0.13, z: -0.07 };  // m, in the tool's frame: beside the palm

class App {
  constructor() {
    this.layers = { visual: true };
    this.bodies = [];
    this.selection = null;
    this.index = 0;
    this.ready = false;
    this.messageNode = document.getElementById('message');
    expose(this);
  }

  async start() {
    this.source = await openSource();
    this.stage = new Stage(document.getElementById('canvas'));
    this.player = new Player(this.stage, () => this.panel?.showFrame(this.player));
    this.panel = new Panel(this, document.getElementById('panel'), document.getElementById('player'));
    this.stage.listeners.push(() => this.placeToolCamera());
    this.initTheme();
    this.initPointer();
    this.initFold();
    fillHelp(document.getElementById('help'));
    listen(this);
    await this.showContent();
    if (this.source.live) this.poll();
  }

  async showContent() {
    const { manifest } = this.source;
    document.title = `${manifest.title} – Simwright`;
    this.store?.dispose();
    this.store = new MeshStore(this.source);
    this.charts = await this.source.charts();
    await this.open(Math.min(this.index, Math.max(0, manifest.worlds.length - 1)), true);
  }

  say(text, bad = false) {
    this.messageNode.textContent = text;
    this.messageNode.classList.toggle('bad', bad);
  }

  // Shows a world. `again`: its content may have changed.
  async open(index, again = false) {
    const { manifest } = this.source;
    const opening = (this.opening = {});
    this.ready = false;
    let specs = [];
    try {
      if (manifest.worlds.length > 0) specs = await this.source.bodies(index);
    } catch (error) {
      this.say(error.message, true);
      this.ready = true;
      return;
    }
    if (this.opening !== opening) return;
    const moved = index !== this.index || this.bodies.length === 0;
    for (const body of this.bodies) body.dispose();
    this.player.load(null, []);
    this.selection = null;
    this.index = index;
    this.bodies = specs.map((spec, i) => new Body(
      i, spec, manifest.models[spec.model], this.store, () => this.stage.changed()));
    for (const body of this.bodies) this.stage.world.add(body.group);
    if (this.toolCamera && !this.hasTool()) this.setToolCamera(false);
    this.showMarkers(manifest.worlds[index]?.markers ?? []);
    this.panel.build();
    await this.fillLayers(opening);
    if (this.opening !== opening) return;
    const box = this.bounds();
    if (!box.isEmpty()) {
      this.stage.fit(box);
      if (moved || !again) this.stage.orbit.frame(box);
    }
    const shown = manifest.worlds[index]?.timelines?.find((timeline) => timeline.shown);
    if (shown) await this.loadTimeline(shown);
    this.panel.build();
    this.ready = true;
  }

  // Shows positions that a world names, such as a goal.
  showMarkers(markers) {
    this.markers?.removeFromParent();
    this.markers = new THREE.Group();
    for (const { position } of markers) this.markers.add(massGlyph(position, 0.08));
    this.stage.world.add(this.markers);
  }

  async fillLayers(opening) {
    this.say('Loading');
    try {
      await Promise.all(this.bodies.map((body) => this.showLayers(body)));
      if (this.opening === opening) this.say(this.fault ?? '', Boolean(this.fault));
    } catch (error) {
      if (this.opening === opening) this.say(error.message, true);
    }
  }

  async showLayers(body) {
    const wanted = Object.keys(this.layers).filter((name) => this.layers[name]);
    const meshes = wanted.filter((name) => ['visual', 'solid', 'parts'].includes(name));
    await Promise.all(meshes.map((name) => body.show(name, true)));
    await Promise.all(wanted.filter((name) => !meshes.includes(name)).map((name) => body.show(name, true)));
  }

  bounds() {
    const box = new THREE.Box3();
    for (const body of this.bodies) if (body.group.visible) box.union(body.bounds());
    return box;
  }

  step(by) {
    const count = this.source.manifest.worlds.length;
    if (count > 1) this.open((this.index + by + count) % count);
  }

  frame() {
    const box = this.selection ? this.selection.bounds() : this.bounds();
    this.setToolCamera(false);
    this.stage.orbit.frame(box);
  }

  async setLayer(name, visible) {
    this.layers[name] = visible;
    await Promise.all(this.bodies.map((body) => body.show(name, visible)));
    this.panel.build();
    this.stage.changed();
  }

  toggleLayer(name) { this.setLayer(name, !this.layers[name]); }

  select(body) {
    this.selection = body;
    this.outline?.removeFromParent();
    this.outline?.dispose();
    this.outline = undefined;
    if (body && this.bodies.length > 1) {
      const box = body.bounds();
      if (!box.isEmpty()) {
        this.outline = new THREE.Box3Helper(box, 0x1f7ae0);
        this.stage.scene.add(this.outline);
      }
    }
    this.panel.build();
    this.stage.invalidate();
  }

  setVisible(body, visible) {
    body.group.visible = visible;
    if (!visible && this.selection === body) this.select(null);
    this.panel.build();
    this.stage.changed();
  }

  hideSelected() { if (this.selection) this.setVisible(this.selection, false); }

  showAll() {
    for (const body of this.bodies) body.group.visible = true;
    this.panel.build();
    this.stage.changed();
  }

  // Returns the body whose joints the panel shows.
  jointBody() {
    const articulated = (body) => body?.model.joints.some(moves);
    if (this.selection) return articulated(this.selection) ? this.selection : null;
    const movable = this.bodies.filter(articulated);
    return movable.length === 1 || this.bodies.length === 1 ? movable[0] : null;
  }

  async loadTimeline(timeline) {
    if (timeline.rows === undefined) {
      const { bytes } = await this.source.buffer(timeline.buffer);
      timeline.rows = rowsOf(bytes);
    }
    this.select(null);
    const box = this.bounds();
    this.player.load(timeline, this.bodies, box.isEmpty() ? 1 : box.getSize(new THREE.Vector3()).length());
    this.panel.build();
  }

  // Shows the start instead of a motion.
  leaveTimeline() {
    this.player.load(null, []);
    for (const body of this.bodies) body.reset();
    this.stage.changed();
    this.panel.build();
  }

  async requestReplay() {
    const world = this.source.manifest.worlds[this.index];
    if (!world?.replay || this.replaying) return;
    this.replaying = true;
    this.say(world.replay.waiting);
    this.panel.build();
    try {
      const timeline = await this.source.replay(this.index);
      if (this.source.manifest.worlds[this.index] === world) {
        world.timelines = [...(world.timelines ?? []).filter(({ name }) => name !== timeline.name), timeline];
        await this.loadTimeline(timeline);
        this.player.toggle();
      }
      this.say('');
    } catch (error) {
      this.say(error.message, true);
    }
    this.replaying = false;
    this.panel.build();
  }

  // The camera at the robot's tool.
  tool() {
    for (const body of this.bodies) {
      const link = body.model.camera_link;
      if (link !== undefined) return { body, link };
    }
    return null;
  }

  hasTool() { return this.tool() !== null; }

  setToolCamera(on) {
    this.toolCamera = on && this.hasTool();
    this.stage.orbit.enabled = !this.toolCamera;
    if (!this.toolCamera) {
      this.stage.camera.fov = 40;
      this.stage.orbit.update();
    }
    this.stage.invalidate();
  }

  nextCamera() { this.setToolCamera(!this.toolCamera); }

  placeToolCamera() {
    const tool = this.toolCamera ? this.tool() : null;
    if (!tool) return;
    const { body, link } = tool;
    const pose = body.worldFromLink(link);
    const at = (x, z) => new THREE.Vector3(...apply(pose, [x, 0, z]));
    const { camera } = this.stage;
    camera.fov = 75;
    camera.near = 0.01;
    camera.position.copy(at(TOOL_CAMERA.x, TOOL_CAMERA.z));
    camera.up.set(pose[0], pose[4], pose[8]);
    camera.lookAt(at(0, 0.02));
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld(true);
  }

  initTheme() {
    const dark = window.matchMedia('(prefers-color-scheme: dark)');
    this.setTheme(dark.matches);
    dark.addEventListener('change', () => this.setTheme(dark.matches));
  }

  setTheme(dark) {
    this.dark = dark;
    document.documentElement.dataset.theme = dark ? 'dark' : 'light';
    this.stage.setTheme(dark);
    const box = this.bounds();
    if (!box.isEmpty()) this.stage.fit(box);
  }

  toggleTheme() { this.setTheme(!this.dark); }

  initPointer() {
    const { canvas } = this.stage;
    let down = null;
    canvas.addEventListener('pointerdown', (event) => { down = [event.clientX, event.clientY]; });
    canvas.addEventListener('pointerup', (event) => {
      if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
      this.select(this.stage.pick(event.clientX, event.clientY, this.bodies)?.body ?? null);
    });
  }

  initFold() {
    document.getElementById('fold').addEventListener('click', () => this.togglePanel());
  }

  togglePanel() {
    const folded = document.body.classList.toggle('folded');
    document.getElementById('fold').setAttribute('aria-expanded', String(!folded));
  }

  help() {
    const dialog = document.getElementById('help');
    if (dialog.open) dialog.close();
    else dialog.showModal();
  }

  // Asks for changes of the files.
  async poll() {
    try {
      const { version, fault } = await this.source.version();
      if (fault !== (this.fault ?? '')) {
        this.fault = fault;
        this.say(fault, fault !== '');
      }
      if (version !== this.source.manifest.version) {
        await this.source.open();
        await this.showContent();
      } else if (this.source.manifest.live) {
        const charts = await this.source.charts();
        if (JSON.stringify(charts) !== JSON.stringify(this.charts)) {
          this.charts = charts;
          this.panel.build();
        }
      }
      if (this.lost) this.say(this.fault ?? '', Boolean(this.fault));
      this.lost = false;
    } catch {
      this.lost = true;
      this.say('The server does not answer: simwright view may have ended', true);
    }
    setTimeout(() => this.poll(), POLL_MS);
  }
}

const app = new App();
app.start().catch((error) => app.say(error.message, true));
