// Keys of the viewer, and the dialog that lists them.
import { button, element } from './elements.js';
import { LAYERS } from './bodies.js';

const LIST = [
  ['← → ↑ ↓', 'orbit; with Shift: pan'],
  ['+ −', 'zoom'],
  ['f', 'frame everything; the selected object'],
  [`1 to ${LAYERS.length}`, `show or hide: ${LAYERS.map((layer) => layer.title.toLowerCase()).join(', ')}`],
  ['n p', 'next or previous entry'],
  ['h', 'hide the selected object; H: show all'],
  ['Esc', 'select nothing'],
  ['space', 'play or pause; r: back to the start'],
  [', .', 'one frame back or on'],
  ['c', 'camera: free, or at the robot\'s tool'],
  ['d', 'dark or light'],
  ['m', 'show or hide the panel'],
  ['?', 'these keys'],
];

export function fillHelp(dialog) {
  dialog.replaceChildren(
    element('h1', {}, 'Keys'),
    element('table', {}, element('tbody', {}, LIST.map(([key, what]) => element('tr', {},
      element('td', {}, element('kbd', {}, key)), element('td', {}, what))))),
    element('p', { class: 'soft' },
      'Drag: orbit. Right drag, or two fingers: pan. Wheel, or pinch: zoom. Click: select.'),
    button('Close', 'Close', () => dialog.close()));
}

// Calls actions of `app` for keys, unless a text field or a slider has the focus.
export function listen(app) {
  const orbit = app.stage.orbit;
  const step = 0.12;
  const arrows = {
    ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1],
  };
  const actions = {
    '+': () => orbit.zoom(0.87), '=': () => orbit.zoom(0.87), '-': () => orbit.zoom(1.15),
    f: () => app.frame(), n: () => app.step(1), p: () => app.step(-1),
    h: () => app.hideSelected(), H: () => app.showAll(), Escape: () => app.select(null),
    ' ': () => app.player.toggle(), r: () => app.player.seek(0),
    ',': () => app.player.seek(app.player.frame - 1), '.': () => app.player.seek(app.player.frame + 1),
    c: () => app.nextCamera(), d: () => app.toggleTheme(), m: () => app.togglePanel(),
    '?': () => app.help(),
  };
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const tag = event.target.tagName;
    if (tag === 'INPUT' || tag === 'SELECT' || tag === 'DIALOG') return;
    if (tag === 'BUTTON' && (event.key === ' ' || event.key === 'Enter')) return;
    const arrow = arrows[event.key];
    if (arrow) {
      if (event.shiftKey) orbit.pan(-30 * arrow[0], 30 * arrow[1]);
      else orbit.rotate(step * arrow[0], step * arrow[1]);
    } else if (/^[1-9]$/.test(event.key) && LAYERS[event.key - 1]) {
      app.toggleLayer(LAYERS[event.key - 1].name);
    } else if (actions[event.key]) {
      actions[event.key]();
    } else {
      return;
    }
    event.preventDefault();
  });
}
