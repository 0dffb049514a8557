// `window.simwright`: what tests and scripts in the browser's console may read and set. docs/viewer.md
// describes it.
import * as THREE from './three.module.min.js';
import { apply } from './kinematics.js';

export function expose(app) {
  window.simwright = {
    get ready() { return app.ready; },
    get manifest() { return app.source.manifest; },
    get index() { return app.index; },
    get fault() { return app.fault; },
    get frames() { return app.stage.rendered; },
    get layers() { return { ...app.layers }; },
    get camera() {
      const { azimuth, elevation, distance, target } = app.stage.orbit;
      return { azimuth, elevation, distance, target: target.toArray() };
    },
    get player() {
      const { frame, last, playing, timeline } = app.player;
      return timeline ? { frame, last, playing, name: timeline.name } : null;
    },
    // Returns the names, poses (12 numbers), joint positions and visibility of the bodies.
    bodies: () => app.bodies.map((body) => ({
      name: body.name, pose: [...body.pose], positions: [...body.positions],
      visible: body.group.visible, joints: body.model.joints.map((joint) => joint.name),
    })),
    // Returns the pose of each link of a body in the world. (12)
    links: (body) => Object.fromEntries(app.bodies[body].model.links.map(
      (link, i) => [link.name, app.bodies[body].worldFromLink(i)])),
    // Returns the matrices with which the links are drawn, column by column. (16)
    drawn: (body) => Object.fromEntries(app.bodies[body].model.links.map(
      (link, i) => [link.name, app.bodies[body].links[i].matrixWorld.toArray()])),
    // Returns where a point of the world (m) is on the page, pixels.
    project: (point) => {
      const { camera, canvas } = app.stage;
      const seen = new THREE.Vector3(...point).project(camera);
      const box = canvas.getBoundingClientRect();
      return [box.left + 0.5 * (1 + seen.x) * box.width, box.top + 0.5 * (1 - seen.y) * box.height];
    },
    // Returns the points of a body's symbols of a layer, in the frame of their link.
    glyph: (body, layer) => app.bodies[body].links.flatMap((link) => link.children)
      .filter((object) => object.userData.layer === layer).flatMap((object) => {
        const { array } = object.geometry.attributes.position;
        return Array.from({ length: array.length / 3 }, (_, i) => [...array.slice(3 * i, 3 * i + 3)]);
      }),
    setPosition: (body, joint, position) => {
      app.bodies[body].setPosition(app.bodies[body].model.joints.findIndex(({ name }) => name === joint), position);
      app.stage.changed();
    },
    showLayer: (name, visible) => app.setLayer(name, visible),
    open: (index) => app.open(index),
    select: (body) => app.select(app.bodies[body] ?? null),
    seek: (frame) => app.player.seek(frame),
    replay: () => app.requestReplay(),
    // Sets a pinhole camera: fy in pixels of the canvas' height, world_from_camera as 12 numbers with
    // the camera looking along +z, y down.
    setCamera: ({ height, fy, world_from_camera: pose }) => {
      const { camera, orbit } = app.stage;
      orbit.enabled = false;
      camera.fov = 2 * Math.atan(0.5 * height / fy) * 180 / Math.PI;
      camera.position.set(...apply(pose, [0, 0, 0]));
      camera.up.set(-pose[1], -pose[5], -pose[9]);
      camera.lookAt(...apply(pose, [0, 0, 1]));
      camera.near = 1e-3;
      camera.far = 1e3;
      camera.updateProjectionMatrix();
      app.stage.invalidate();
    },
    // Paints the content white on black, without panel and ground.
    setSilhouette: (on) => {
      document.body.classList.toggle('bare', on);
      app.stage.resize();
      app.stage.setSilhouette(on);
    },
    // Returns the triangles and draw calls of the last frame.
    get statistics() {
      const { triangles, calls } = app.stage.renderer.info.render;
      return { triangles, calls, software: app.stage.software };
    },
    // Renders `count` frames one after the other while the view turns; returns the mean in ms.
    timeFrames: async (count) => {
      const gl = app.stage.renderer.getContext();
      const pixel = new Uint8Array(4);
      const begin = performance.now();
      for (let i = 0; i < count; ++i) {
        app.stage.orbit.rotate(2 * Math.PI / count, 0);
        app.stage.render(performance.now());
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      }
      return (performance.now() - begin) / count;
    },
  };
}
