// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A small cube that stands as the scene does: a click on a face or an edge of it looks from there, and so do the arrow keys. Drawn only when the
// camera turns, from above the horizon as the camera is; between that the browser has it as a picture. The reckoning is without browser and three.js.

const svg = 'http://www.w3.org/2000/svg';
export const cube_px = 64;
const half_px = 18, seen = 0.06, step = Math.PI / 4;
/// As low as the camera goes.
const lowest = 0.03;

/// x to the right and z up, as the scene's own view from the front has them.
const sides = {front: [0, -1, 0], right: [1, 0, 0], back: [0, 1, 0], left: [-1, 0, 0], top: [0, 0, 1]};
const names = Object.keys(sides);
const around = names.slice(0, 4);
/// [name, where from, its two ends as signs of x, y, z]. Those below are for a camera that goes there.
const edges = around.flatMap((name, i) => {
  const next = around[(i + 1) % 4], [x, y] = sides[name], [nx, ny] = sides[next], across = [-y, x];
  return [[`top ${name}`, [x, y, 1], [[x + across[0], y + across[1], 1], [x - across[0], y - across[1], 1]]],
    [`${name} ${next}`, [x + nx, y + ny, 0], [[x + nx, y + ny, 1], [x + nx, y + ny, -1]]]];
});

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const round = (value) => Math.round(value * 10) / 10;

/// `axes`: [right, up, towards the eye], unit vectors in the scene. {faces: [{name, corners, matrix}], edges: [{name, ends}]}, those that are seen, in px
/// of the cube's own picture; `matrix` lays a word on a face.
export function cube_as_seen([right, up, eye]) {
  const at = (point) => [round(cube_px / 2 + half_px * dot(point, right)), round(cube_px / 2 - half_px * dot(point, up))];
  const faces = names.filter((name) => dot(sides[name], eye) > seen).map((name) => {
    const normal = sides[name], across = name === 'top' ? [1, 0, 0] : [-normal[1], normal[0], 0], above = name === 'top' ? [0, 1, 0] : [0, 0, 1];
    const corner = (s, t) => at(normal.map((value, i) => value + s * across[i] + t * above[i]));
    const middle = at(normal);
    return {name, corners: [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)],
      matrix: [dot(across, right), -dot(across, up), -dot(above, right), dot(above, up)].map((value) => Math.round(value * 1000) / 1000).concat(middle)};
  });
  const is_seen = new Set(faces.map((one) => one.name));
  return {faces, edges: edges.filter(([name]) => name.split(' ').some((one) => is_seen.has(one))).map(([name, , ends]) => ({name, ends: ends.map(at)}))};
}

/// Where one looks from when a face or an edge is meant: a unit vector.
export function direction_of(name) {
  const [x, y, z] = sides[name] ?? edges.find(([edge]) => edge === name)[1], size = Math.hypot(x, y, z);
  return [x / size, y / size, z / size];
}

/// The next of the views in steps of an eighth of a turn, by [times around, times up] from where `eye` is.
export function turned_by(eye, [about, above]) {
  const high = Math.asin(Math.max(-1, Math.min(1, eye[2]))), turn = Math.atan2(eye[1], eye[0]);
  const next = (value, by) => by > 0 ? Math.floor(value / step + 1 + 1e-3) * step : by < 0 ? Math.ceil(value / step - 1 - 1e-3) * step : value;
  const height = Math.max(lowest, Math.min(Math.PI / 2, next(high, above))), way = next(turn, about);
  return [Math.cos(way) * Math.cos(height), Math.sin(way) * Math.cos(height), Math.sin(height)];
}

/// "front, from above": where the eye is, in words.
export function words_of(eye) {
  const [nearest] = around.toSorted((a, b) => dot(sides[b], eye) - dot(sides[a], eye));
  return eye[2] > 0.95 ? 'from above' : `from the ${nearest}${eye[2] > 0.35 ? ', above' : ''}`;
}

const node = (name, words, ...children) => {
  const made = document.createElementNS(svg, name);
  for (const [word, value] of Object.entries(words)) made.setAttribute(word, value);
  made.append(...children);
  return made;
};

export class ViewCube {
  #faces = new Map();
  #edges = new Map();
  #drawn = '';
  #eye = [0, -1, 0];

  /// Draws into `picture`, an svg; `look(direction)` looks from there, `home()` as at first.
  constructor(picture, look, home) {
    this.picture = picture;
    for (const [word, value] of Object.entries({viewBox: `0 0 ${cube_px} ${cube_px}`, tabindex: '0', role: 'group'})) picture.setAttribute(word, value);
    const shape = (kind, name, ...inner) => {
      const made = node('g', {class: kind, 'data-test': `look-${name.replace(' ', '-')}`}, ...inner, node('title', {}, `look from ${kind === 'face' ? 'the ' : ''}${name.replace(' ', ' and ')}`));
      made.addEventListener('click', () => look(direction_of(name)));
      return made;
    };
    for (const name of names) this.#faces.set(name, shape('face', name, node('polygon', {}), node('text', {'text-anchor': 'middle', y: '3.5', 'aria-hidden': 'true'}, name)));
    for (const [name] of edges) this.#edges.set(name, shape('edge', name, node('line', {})));
    picture.replaceChildren(...this.#faces.values(), ...this.#edges.values());
    picture.addEventListener('keydown', (event) => {
      const by = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
      if (!by && event.key !== 'Home') return;
      event.preventDefault();
      if (by) look(turned_by(this.#eye, by));
      else home();
    });
  }

  /// As a camera of three.js stands; nothing is done where it stands as before.
  follow(camera) {
    const {elements: e} = camera.matrixWorld, axes = [[e[0], e[1], e[2]], [e[4], e[5], e[6]], [e[8], e[9], e[10]]];
    const key = axes.flat().map((value) => value.toFixed(3)).join();
    if (key === this.#drawn) return;
    this.#drawn = key;
    this.#eye = axes[2];
    const {faces, edges: lines} = cube_as_seen(axes);
    for (const [name, face] of this.#faces) {
      const shown = faces.find((one) => one.name === name);
      face.style.display = shown ? '' : 'none';
      if (!shown) continue;
      face.firstChild.setAttribute('points', shown.corners.join(' '));
      face.children[1].setAttribute('transform', `matrix(${shown.matrix.join(' ')})`);
    }
    for (const [name, edge] of this.#edges) {
      const shown = lines.find((one) => one.name === name);
      edge.style.display = shown ? '' : 'none';
      if (shown) shown.ends.forEach(([x, y], i) => { edge.firstChild.setAttribute(`x${i + 1}`, x); edge.firstChild.setAttribute(`y${i + 1}`, y); });
    }
    this.picture.setAttribute('aria-label', `seen ${words_of(this.#eye)}: arrow keys look from elsewhere, Home as at first`);
  }
}
