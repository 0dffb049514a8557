// The side panel and the player's bar.
import { LAYERS } from './bodies.js';
import { lineChart } from './charts.js';
import { button, element, factTable } from './elements.js';
import { moves, rangeOf } from './kinematics.js';

const KINDS = {
  asset: 'Asset', assets: 'Assets', scenes: 'Scenes', tasks: 'Tasks', rollout: 'Rollout', run: 'Run',
};

function section(title, ...children) {
  return element('section', { 'aria-label': title }, element('h2', {}, title), children);
}

// Returns a joint's position with its unit: degrees of a hinge, millimetres of a slider.
export function positionText(joint, position) {
  return joint.type === 'prismatic'
    ? `${(1000 * position).toFixed(1)} mm` : `${(position * 180 / Math.PI).toFixed(1)}°`;
}

export class Panel {
  constructor(app, node, bar) {
    Object.assign(this, { app, node, bar });
  }

  // Builds the panel again, for another world or selection.
  build() {
    const { app } = this;
    const top = this.node.scrollTop;
    this.node.replaceChildren(...[
      this.header(), this.worlds(), this.replay(), this.layers(), this.joints(), this.objects(),
      this.selected(), this.charts(), this.findings()].filter(Boolean));
    this.node.scrollTop = top;
    if (app.player.timeline) this.showFrame(app.player);
  }

  header() {
    const { app } = this;
    const { manifest } = app.source;
    return element('header', {},
      element('h1', {}, manifest.title),
      element('p', { class: 'soft' }, KINDS[manifest.kind] ?? manifest.kind),
      element('div', { class: 'row' },
        button('Frame', 'Frame everything (f)', () => app.frame()),
        button('Camera', 'Switch between the free camera and the robot\'s tool (c)', () => app.nextCamera(),
          { hidden: !app.hasTool() }),
        button('◐', 'Dark or light (d)', () => app.toggleTheme()),
        button('?', 'Keys (?)', () => app.help())));
  }

  worlds() {
    const { app } = this;
    const { worlds } = app.source.manifest;
    const world = worlds[app.index];
    const about = world === undefined ? [] : [
      world.description ? element('p', {}, world.description) : null,
      world.facts?.length ? factTable(world.facts) : null,
      world.code ? element('details', {}, element('summary', {}, 'Reward program'),
        element('pre', {}, world.code)) : null];
    if (worlds.length < 2) return about.some(Boolean) ? section('About', about) : null;
    const number = element('input', {
      type: 'number', min: 1, max: worlds.length, 'aria-label': 'Number of the entry',
      onchange: () => {
        const index = Math.round(Number(number.value)) - 1;
        if (index >= 0 && index < worlds.length) app.open(index);
      },
    });
    number.value = app.index + 1;
    return section(`${app.index + 1} of ${worlds.length}`,
      element('div', { class: 'row' },
        button('← Previous', 'Previous entry (p)', () => app.step(-1)), number,
        button('Next →', 'Next entry (n)', () => app.step(1))),
      this.entryList(worlds), about);
  }

  // Returns the list of the entries, with the current one marked. It is made once for a manifest:
  // there may be thousands.
  entryList(worlds) {
    const { app } = this;
    if (this.listOf !== worlds) {
      this.listOf = worlds;
      this.entries = worlds.map(({ name, group }, i) => element('button', {
        type: 'button', class: 'wide', onclick: () => app.open(i),
      }, group ? `${group}: ${name}` : name));
      this.list = element('ul', { class: 'list', 'aria-label': 'Entries' },
        this.entries.map((entry) => element('li', {}, entry)));
    }
    this.current?.removeAttribute('aria-current');
    this.current = this.entries[app.index];
    this.current.setAttribute('aria-current', 'true');
    const item = this.current.parentNode;
    requestAnimationFrame(() => { this.list.scrollTop = item.offsetTop - this.list.offsetTop - 40; });
    return this.list;
  }

  replay() {
    const { app } = this;
    const world = app.source.manifest.worlds[app.index];
    const timeline = app.player.timeline;
    const choices = (world?.timelines ?? []).map((one) => button(
      one.name, `Show: ${one.name}`, () => app.loadTimeline(one),
      { 'aria-pressed': String(timeline?.name === one.name) }));
    if (timeline) choices.unshift(button('Start', 'Show the start instead', () => app.leaveTimeline()));
    if (world?.replay) {
      choices.push(button(world.replay.title, world.replay.title, () => app.requestReplay(),
        { disabled: Boolean(app.replaying) }));
    }
    if (choices.length === 0) return null;
    this.signalCharts = [];
    const charts = (timeline?.signals ?? []).map((signal) => {
      const frames = Array.from({ length: timeline.frames }, (_, i) => i);
      const chart = lineChart({
        title: signal.unit ? `${signal.name}, ${signal.unit}` : signal.name, x: 'time, s', y: '',
        curves: [{ name: signal.name, x: frames.map((i) => i / timeline.rate),
          y: frames.map((i) => app.player.value(signal, i)) }],
      });
      this.signalCharts.push(chart);
      return chart.node;
    });
    const marks = (timeline?.marks ?? []).map((mark) => button(
      mark.name, `Go to ${mark.name}`, () => app.player.seek(mark.frame)));
    return section('Motion', element('div', { class: 'row' }, choices),
      marks.length > 1 ? element('div', { class: 'row' }, marks) : null,
      timeline?.facts?.length ? factTable(timeline.facts) : null, charts);
  }

  layers() {
    const { app } = this;
    const row = LAYERS.map(({ name, title }, i) => app.bodies.some((body) => body.has(name))
      ? button(title, `${title} (${i + 1})`, () => app.toggleLayer(name),
        { 'aria-pressed': String(Boolean(app.layers[name])) }) : null);
    return section('Layers', element('div', { class: 'row' }, row));
  }

  joints() {
    const { app } = this;
    const body = app.jointBody();
    if (!body) return null;
    this.sliders = new Map();
    const rows = body.model.joints.map((joint, i) => {
      if (!moves(joint) || joint.mimic) return null;
      const [lower, upper] = rangeOf(joint);
      const output = element('output', {}, positionText(joint, body.positions[i]));
      const slider = element('input', {
        type: 'range', min: lower, max: upper, step: 'any', 'aria-label': `Joint ${joint.name}`,
        'data-joint': joint.name,
        oninput: () => {
          body.setPosition(i, Number(slider.value));
          output.textContent = positionText(joint, body.positions[i]);
          app.stage.changed();
        },
      });
      slider.value = body.positions[i];
      this.sliders.set(i, { slider, output, joint, body });
      const range = `${positionText(joint, lower)} to ${positionText(joint, upper)}`;
      return element('div', { class: 'joint', title: range },
        element('label', {}, joint.name), output, slider);
    });
    return section('Joints', rows, element('div', { class: 'row' },
      button('Home', 'Move all joints to the start', () => {
        body.reset();
        app.stage.changed();
        this.build();
      })));
  }

  objects() {
    const { app } = this;
    if (app.bodies.length < 2) return null;
    const items = app.bodies.map((body) => element('li', {},
      element('button', {
        type: 'button', class: 'wide', 'aria-current': String(body === app.selection),
        onclick: () => app.select(body === app.selection ? null : body),
      }, body.name),
      button(body.group.visible ? '●' : '○', body.group.visible ? `Hide ${body.name}` : `Show ${body.name}`,
        () => app.setVisible(body, !body.group.visible))));
    return section(`${app.bodies.length} objects`,
      element('ul', { class: 'list', 'aria-label': 'Objects' }, items));
  }

  selected() {
    const { app } = this;
    const body = app.selection ?? (app.bodies.length === 1 ? app.bodies[0] : null);
    if (!body) return null;
    const millimetres = [3, 7, 11].map((i) => (1000 * body.pose[i]).toFixed(1)).join(', ');
    const yaw = Math.atan2(body.pose[4], body.pose[0]) * 180 / Math.PI;
    const facts = [...body.model.facts];
    if (app.bodies.length > 1) {
      facts.unshift(['position', `${millimetres} mm`], ['yaw', `${yaw.toFixed(1)}°`],
        ['base', body.spec.fixed ? 'fixed' : 'free']);
    }
    if (body.model.grasps) {
      facts.push(['grasps', `${body.model.grasps.shown} of ${body.model.grasps.count} shown`]);
    }
    const links = body.model.links.length > 1 ? element('p', { class: 'small soft' },
      `Links: ${body.model.links.map((link) => link.name).join(', ')}`) : null;
    return section(body.name, factTable(facts), links);
  }

  charts() {
    const { charts } = this.app;
    if (!charts?.length) return null;
    return section('Training', charts.map((chart) => lineChart(chart).node),
      element('p', { class: 'small soft' }, 'The bands are 95 % intervals.'));
  }

  findings() {
    const { findings } = this.app.source.manifest;
    if (!findings.length) return null;
    return section('Findings', findings.map((finding) => element('div', { class: `finding ${finding.severity}` },
      element('p', {}, finding.place ? `${finding.place}: ` : '', finding.sentence),
      finding.remedy ? element('p', { class: 'soft small' }, finding.remedy) : null)));
  }

  // Shows the frame of the player in its bar, its charts and the sliders.
  showFrame(player) {
    this.bar.hidden = !player.timeline;
    if (!player.timeline) {
      this.barOf = undefined;
      return;
    }
    if (this.barOf !== player.timeline) this.buildBar(player);
    this.play.textContent = player.playing ? '❚❚' : '▶';
    this.scrub.value = player.frame;
    this.clock.textContent = `${player.seconds.toFixed(2)} / ${(player.last / player.timeline.rate).toFixed(2)} s`;
    for (const chart of this.signalCharts ?? []) chart.setCursor(player.seconds);
    for (const [i, { slider, output, joint, body }] of this.sliders ?? []) {
      slider.value = body.positions[i];
      output.textContent = positionText(joint, body.positions[i]);
    }
  }

  buildBar(player) {
    this.barOf = player.timeline;
    this.play = button('▶', 'Play or pause (space)', () => player.toggle());
    this.scrub = element('input', {
      type: 'range', min: 0, max: player.last, step: 1, 'aria-label': 'Time',
      oninput: () => player.seek(Number(this.scrub.value)),
    });
    this.clock = element('output');
    const speed = element('select', { 'aria-label': 'Speed',
      onchange: () => { player.speed = Number(speed.value); } },
    [0.1, 0.25, 0.5, 1, 2, 4].map((value) =>
      element('option', { value, selected: value === player.speed }, `${value}×`)));
    this.bar.replaceChildren(element('div', { class: 'row' }, this.play, this.scrub, this.clock, speed));
  }
}

