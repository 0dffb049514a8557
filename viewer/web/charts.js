// Line charts as SVG.
import { svgElement } from './elements.js';

const WIDTH = 320, HEIGHT = 150, LEFT = 42, RIGHT = 10, TOP = 18, BOTTOM = 30;
const COLORS = ['#1f77b4', '#d9822b', '#2f9a4a', '#a63fb5', '#c43c39', '#1b8f8f'];

export function chartColor(i) { return COLORS[i % COLORS.length]; }

function number(value) {
  const size = Math.abs(value);
  if (size >= 1e6) return `${+(value / 1e6).toPrecision(3)}M`;
  if (size >= 1e4) return `${+(value / 1e3).toPrecision(3)}k`;
  return `${+value.toPrecision(3)}`;
}

function rangeOf(values, least = Infinity, greatest = -Infinity) {
  for (const value of values) {
    if (value === null || !Number.isFinite(value)) continue;
    least = Math.min(least, value);
    greatest = Math.max(greatest, value);
  }
  if (least > greatest) return [0, 1];
  return greatest - least < 1e-12 ? [least - 0.5, greatest + 0.5] : [least, greatest];
}

function path(points) {
  let text = '', pen = 'M';
  for (const [x, y] of points) {
    if (y === null || !Number.isFinite(y)) {
      pen = 'M';
      continue;
    }
    text += `${pen}${x.toFixed(1)} ${y.toFixed(1)}`;
    pen = 'L';
  }
  return text;
}

// Returns a chart {node, setCursor(x)} of {title, x, y, curves[{name, x[], y[], low[], high[]}]}.
export function lineChart(chart) {
  const all = (key) => chart.curves.flatMap((curve) => curve[key] ?? []);
  const [x0, x1] = rangeOf(all('x'));
  const [y0, y1] = rangeOf([...all('y'), ...all('low'), ...all('high')]);
  const sx = (x) => LEFT + (x - x0) / (x1 - x0) * (WIDTH - LEFT - RIGHT);
  const sy = (y) => y === null ? null : TOP + (y1 - y) / (y1 - y0) * (HEIGHT - TOP - BOTTOM);
  const node = svgElement('svg', {
    viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: 'chart', role: 'img',
    'aria-label': `${chart.title}: ${chart.curves.map((curve) => curve.name).join(', ')}`,
  });
  const text = (x, y, anchor, words) =>
    node.append(svgElement('text', { x, y, 'text-anchor': anchor }, words));
  node.append(svgElement('path', { class: 'axis',
    d: `M${LEFT} ${TOP}V${HEIGHT - BOTTOM}H${WIDTH - RIGHT}` }));
  text(LEFT - 4, TOP + 4, 'end', number(y1));
  text(LEFT - 4, HEIGHT - BOTTOM, 'end', number(y0));
  text(LEFT, HEIGHT - BOTTOM + 12, 'start', number(x0));
  text(WIDTH - RIGHT, HEIGHT - BOTTOM + 12, 'end', number(x1));
  text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 5, 'middle', chart.x);
  text(4, 11, 'start', chart.title);
  chart.curves.forEach((curve, i) => {
    const color = chartColor(i);
    if (curve.low?.length) {
      const upper = curve.x.map((x, k) => [sx(x), sy(curve.high[k])]).filter(([, y]) => y !== null);
      const lower = curve.x.map((x, k) => [sx(x), sy(curve.low[k])]).filter(([, y]) => y !== null);
      if (upper.length > 1) {
        node.append(svgElement('path', { d: `${path([...upper, ...lower.reverse()])}Z`,
          fill: color, opacity: 0.18 }));
      }
    }
    node.append(svgElement('path', { d: path(curve.x.map((x, k) => [sx(x), sy(curve.y[k])])),
      fill: 'none', stroke: color, 'stroke-width': 1.6 }));
    if (chart.curves.length > 1) {
      const label = svgElement('text', { x: WIDTH - RIGHT, y: 11 + 11 * i, 'text-anchor': 'end' }, curve.name);
      label.style.fill = color;
      node.append(label);
    }
  });
  const cursor = svgElement('line', { class: 'cursor', y1: TOP, y2: HEIGHT - BOTTOM, x1: -9, x2: -9 });
  node.append(cursor);
  return {
    node,
    setCursor(x) {
      cursor.setAttribute('x1', sx(x));
      cursor.setAttribute('x2', sx(x));
    },
  };
}
