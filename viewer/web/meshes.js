// Meshes of the manifest as geometries with materials, each made once.
import * as THREE from './three.module.min.js';

const WRAP = THREE.RepeatWrapping;

// Returns a material of sRGB colours.
export function plainMaterial(red, green, blue, opacity = 1) {
  return new THREE.MeshLambertMaterial({
    color: new THREE.Color().setRGB(red, green, blue, THREE.SRGBColorSpace),
    transparent: opacity < 1,
    opacity,
    side: THREE.DoubleSide,
  });
}

export class MeshStore {
  constructor(source) {
    this.source = source;
    this.geometries = new Map();
    this.textures = new Map();
    this.materials = new Map();
  }

  geometry(index) {
    if (!this.geometries.has(index)) this.geometries.set(index, this.makeGeometry(index));
    return this.geometries.get(index);
  }

  async makeGeometry(index) {
    const mesh = this.source.manifest.meshes[index];
    const { bytes } = await this.source.buffer(mesh.buffer);
    const data = bytes.byteOffset % 4 === 0 ? bytes : bytes.slice();
    let at = data.byteOffset;
    const take = (type, count) => {
      const array = new type(data.buffer, at, count);
      at += array.byteLength;
      return array;
    };
    const geometry = new THREE.BufferGeometry();
    const count = mesh.vertices;
    geometry.setAttribute('position', new THREE.BufferAttribute(take(Float32Array, 3 * count), 3));
    geometry.setAttribute('normal', new THREE.BufferAttribute(take(Int8Array, 4 * count), 4, true));
    if (mesh.uvs) geometry.setAttribute('uv', new THREE.BufferAttribute(take(Float32Array, 2 * count), 2));
    geometry.setIndex(new THREE.BufferAttribute(take(Uint32Array, 3 * mesh.triangles), 1));
    for (const [first, number, material] of mesh.groups) {
      geometry.addGroup(3 * first, 3 * number, material);
    }
    geometry.computeBoundingBox();
    geometry.computeBoundingSphere();
    return geometry;
  }

  texture(index) {
    if (!this.textures.has(index)) this.textures.set(index, this.makeTexture(index));
    return this.textures.get(index);
  }

  async makeTexture(index) {
    const { bytes, type } = await this.source.buffer(index);
    const bitmap = await createImageBitmap(new Blob([bytes], { type }), { imageOrientation: 'flipY' });
    const texture = new THREE.Texture(bitmap);
    texture.flipY = false;
    texture.wrapS = texture.wrapT = WRAP;
    texture.colorSpace = THREE.SRGBColorSpace;
    texture.anisotropy = 4;
    texture.needsUpdate = true;
    return texture;
  }

  // Returns the materials of a mesh, by index.
  looks(index) {
    if (!this.materials.has(index)) this.materials.set(index, this.makeLooks(index));
    return this.materials.get(index);
  }

  makeLooks(index) {
    return Promise.all(this.source.manifest.meshes[index].materials.map(async ({ color, texture }) => {
      const material = plainMaterial(...color);
      if (texture >= 0) {
        try {
          material.map = await this.texture(texture);
        } catch {
          material.map = null;  // The colour alone is shown.
        }
      }
      return material;
    }));
  }

  dispose() {
    for (const [kept, key] of [[this.geometries, 0], [this.textures, 0], [this.materials, 1]]) {
      for (const promise of kept.values()) {
        promise.then((value) => (key ? value : [value]).forEach((one) => one.dispose()), () => {});
      }
    }
  }
}
