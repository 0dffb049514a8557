// Plays a timeline: the poses and joints of bodies, and contacts, frame by frame.
import { ContactGlyphs, poseFromRow } from './glyphs.js';

export class Player {
  // `stage`: renders; `report(player)` is called when the frame or the state changes.
  constructor(stage, report) {
    Object.assign(this, { stage, report, frame: 0, playing: false, speed: 1 });
    stage.listeners.push((time) => this.tick(time));
  }

  // Takes a timeline with its rows, or null; `bodies` are those of its world.
  load(timeline, bodies, size = 1) {
    this.contacts?.object.removeFromParent();
    this.contacts = undefined;
    Object.assign(this, { timeline, bodies, frame: 0, playing: false });
    if (timeline?.contacts > 0) {
      this.contacts = new ContactGlyphs(timeline.contacts, 0.012 * Math.min(1, size));
      this.stage.world.add(this.contacts.object);
    }
    if (timeline) this.columns = timeline.tracks.map((track) => this.joints(track));
    if (timeline) this.seek(0);
    this.report(this);
  }

  // Returns the joints of a track with their columns.
  joints(track) {
    const names = this.bodies[track.body].model.joints.map((joint) => joint.name);
    return track.joints.map((name, i) => [names.indexOf(name), track.joint_columns + i])
      .filter(([joint]) => joint >= 0);
  }

  get last() { return this.timeline ? this.timeline.frames - 1 : 0; }
  get seconds() { return this.timeline ? this.frame / this.timeline.rate : 0; }

  row(frame) {
    const { rows, width } = this.timeline;
    return rows.subarray(frame * width, (frame + 1) * width);
  }

  seek(frame) {
    if (!this.timeline) return;
    this.frame = Math.min(this.last, Math.max(0, frame));
    const row = this.row(Math.round(this.frame));
    this.timeline.tracks.forEach((track, i) => {
      const body = this.bodies[track.body];
      if (track.pose >= 0) body.pose = poseFromRow(row, track.pose);
      for (const [joint, column] of this.columns[i]) body.positions[joint] = row[column];
      body.update();
    });
    this.contacts?.set(row.subarray(this.timeline.contact_columns));
    this.stage.changed();
    this.report(this);
  }

  // Returns the value of a signal at a frame.
  value(signal, frame = Math.round(this.frame)) { return this.row(frame)[signal.column]; }

  toggle() {
    if (!this.timeline) return;
    if (!this.playing && this.frame >= this.last) this.frame = 0;
    this.playing = !this.playing;
    this.time = undefined;
    this.report(this);
    this.stage.invalidate();
  }

  tick(time) {
    if (!this.playing) return;
    const elapsed = this.time === undefined ? 0 : Math.min(0.25, (time - this.time) / 1000);
    this.time = time;
    const frame = this.frame + elapsed * this.timeline.rate * this.speed;
    if (frame >= this.last) this.playing = false;
    this.seek(frame);
    if (this.playing) requestAnimationFrame(() => this.stage.invalidate());
  }
}
