// Elements of the page. Texts from data are always inserted as text, never as markup.

const SVG = 'http://www.w3.org/2000/svg';

function fill(node, properties, children) {
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else if (value === true) node.setAttribute(name, '');
    else if (value !== false && value !== undefined) node.setAttribute(name, String(value));
  }
  for (const child of children.flat(Infinity)) {
    if (child !== null && child !== undefined) node.append(child);
  }
  return node;
}

// Returns an element with attributes, listeners ('onclick') and children (elements or texts).
export function element(tag, properties = {}, ...children) {
  return fill(document.createElement(tag), properties, children);
}

export function svgElement(tag, properties = {}, ...children) {
  return fill(document.createElementNS(SVG, tag), properties, children);
}

// Returns a table of [name, value] pairs.
export function factTable(facts) {
  return element('table', {}, element('tbody', {},
    facts.map(([name, value]) => element('tr', {}, element('td', {}, name), element('td', {}, value)))));
}

export function button(text, label, onclick, properties = {}) {
  return element('button', { type: 'button', 'aria-label': label, title: label, onclick, ...properties }, text);
}
