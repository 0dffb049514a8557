// A placed model: one group of objects per link and layer.
import * as THREE from './three.module.min.js';
import { frameGlyph, graspGlyph, graspsAt, jointGlyph, massGlyph, boxGlyph } from './glyphs.js';
import { linkPoses, moves, multiply, restOf } from './kinematics.js';
import { plainMaterial } from './meshes.js';

export const LAYERS = [
  { name: 'visual', title: 'Visual' },
  { name: 'solid', title: 'Solid' },
  { name: 'parts', title: 'Convex parts' },
  { name: 'mass', title: 'Centre of mass' },
  { name: 'box', title: 'Inertia box' },
  { name: 'joints', title: 'Joint axes' },
  { name: 'grasps', title: 'Grasps' },
  { name: 'frames', title: 'Link frames' },
];
const MESH_LAYERS = ['visual', 'solid', 'parts'];

const solidMaterial = plainMaterial(0.55, 0.63, 0.72);
const partMaterials = Array.from({ length: 24 }, (_, i) => {
  const color = new THREE.Color().setHSL((i * 0.618034) % 1, 0.55, 0.58);
  return new THREE.MeshLambertMaterial({ color, side: THREE.DoubleSide });
});

function setMatrix(object, pose) {
  object.matrix.set(...pose, 0, 0, 0, 1);
  object.matrixWorldNeedsUpdate = true;
}

export class Body {
  // `spec`: an entry of a world's bodies. `changed` is called when something was loaded.
  constructor(index, spec, model, store, changed) {
    Object.assign(this, { index, spec, model, store, changed });
    this.name = spec.name;
    this.group = new THREE.Group();
    this.group.matrixAutoUpdate = false;
    this.layers = new Map();
    this.links = model.links.map(() => {
      const group = new THREE.Group();
      group.matrixAutoUpdate = false;
      this.group.add(group);
      return group;
    });
    this.pose = spec.pose;
    this.reset();
  }

  get size() { return this.extent ??= this.makeExtent(); }

  // Returns the size of a link's symbols: that of its inertia box, if it is known, within the body's.
  sizeOf(link) {
    const box = this.model.links[link].box_size;
    return box ? Math.min(this.size, Math.max(0.1 * this.size, 1.5 * Math.hypot(...box))) : this.size;
  }

  makeExtent() {
    const box = this.bounds();
    return box.isEmpty() ? 0.2 : box.getSize(new THREE.Vector3()).length();
  }

  // Returns the joint positions of the world's start, by joint.
  startPositions() {
    return this.model.joints.map((joint) => this.spec.positions?.[joint.name] ?? restOf(joint));
  }

  reset() {
    this.positions = this.startPositions();
    this.pose = this.spec.pose;
    this.update();
  }

  setPosition(joint, position) {
    this.positions[joint] = position;
    this.update();
  }

  update() {
    this.linkPoses = linkPoses(this.model, this.positions);
    setMatrix(this.group, this.pose);
    this.links.forEach((group, i) => setMatrix(group, this.linkPoses[i]));
    this.group.updateMatrixWorld(true);
  }

  // Returns the pose of a link in the world. (12)
  worldFromLink(link) { return multiply(this.pose, this.linkPoses[link]); }

  // Returns true if the model has content for a layer.
  has(layer) {
    if (MESH_LAYERS.includes(layer)) return this.model.links.some((link) => link[layer].length > 0);
    if (layer === 'mass' || layer === 'box') return this.model.links.some((link) => link.mass > 0);
    if (layer === 'joints') return this.model.joints.some(moves);
    if (layer === 'grasps') return Boolean(this.model.grasps);
    return layer === 'frames';
  }

  // Shows or hides a layer; its meshes are loaded when it is first shown. Returns a promise.
  async show(layer, visible) {
    let loading = this.layers.get(layer);
    if (!loading && !visible) return;
    if (!loading) {
      loading = { visible, objects: [] };
      this.layers.set(layer, loading);
      loading.done = this.fill(layer, loading);
    }
    loading.visible = visible;
    for (const object of loading.objects) object.visible = visible;
    await loading.done;
    for (const object of loading.objects) object.visible = loading.visible;
    this.changed();
  }

  async fill(layer, loading) {
    const add = (link, object) => {
      object.visible = loading.visible;
      object.userData.layer = layer;
      this.links[link].add(object);
      loading.objects.push(object);
      object.updateMatrixWorld(true);
    };
    if (MESH_LAYERS.includes(layer)) {
      let part = 0;
      await Promise.all(this.model.links.flatMap((link, i) => link[layer].map(async (index) => {
        const number = part++;
        const [geometry, looks] = await Promise.all([
          this.store.geometry(index), layer === 'visual' ? this.store.looks(index) : null]);
        const material = layer === 'visual' ? looks
          : layer === 'solid' ? [solidMaterial] : [partMaterials[number % partMaterials.length]];
        const mesh = new THREE.Mesh(geometry, material);
        mesh.castShadow = mesh.receiveShadow = true;
        mesh.userData.body = this;
        mesh.userData.link = i;
        add(i, mesh);
        this.extent = undefined;
        this.changed();
      })));
      return;
    }
    const size = this.size;
    this.model.links.forEach((link, i) => {
      if (layer === 'mass' && link.mass > 0) add(i, massGlyph(link.center_of_mass, 0.15 * this.sizeOf(i)));
      if (layer === 'box' && link.mass > 0) add(i, boxGlyph(link.link_from_box, link.box_size));
      if (layer === 'frames') add(i, frameGlyph([0, 0, 0], 0.12 * size));
    });
    this.model.joints.forEach((joint, i) => {
      if (layer === 'joints' && moves(joint)) add(i + 1, jointGlyph(joint, 0.3 * this.sizeOf(i + 1)));
    });
    if (layer === 'grasps' && this.model.grasps) {
      this.model.links.forEach((link, i) => {
        const grasps = graspsAt(this.model.grasps, link.name, i === 0);
        if (grasps.poses.length > 0) add(i, graspGlyph(grasps));
      });
    }
  }

  // Returns the AABB of the loaded meshes in the world.
  bounds() {
    const box = new THREE.Box3();
    this.group.updateMatrixWorld(true);
    this.group.traverse((object) => {
      if (!object.isMesh || !object.userData.body || !object.visible) return;
      box.union(object.geometry.boundingBox.clone().applyMatrix4(object.matrixWorld));
    });
    return box;
  }

  meshes() {
    const found = [];
    this.group.traverse((object) => { if (object.userData.body && object.visible) found.push(object); });
    return found;
  }

  dispose() {
    this.group.removeFromParent();
    this.group.traverse((object) => {
      if (object.userData.body || !object.geometry) return;
      object.geometry.dispose();
      object.material.dispose();
    });
  }
}
