// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Numbers that stand at what they measure. Each tag takes the first free of eight places around its point and keeps it as long as it may.
import {placing} from './place.js';

const places = [[1, -0.2], [-1, -0.2], [1, 1], [-1, 1], [0, -1], [0, 1], [1, -1.2], [-1, -1.2]];
const gap_px = 34, lead_from_px = 26;

const overlap = (a, b) => a.left < b.right + 3 && b.left < a.right + 3 && a.top < b.bottom + 3 && b.top < a.bottom + 3;

export class Tags {
  /// `leads`, of leads.js, take the lines of those that stand away from their points.
  constructor(node, leads) {
    this.node = node;
    this.leads = leads;
    this.list = [];
  }

  /// `words`: [text before, text after] of the number; an empty number hides the tag.
  add(look, before, after) {
    const node = document.createElement('span'), number = document.createElement('b'), unit = document.createElement('small');
    node.className = `tag ${look}`;
    node.append(before, number, ' ', unit);
    unit.textContent = after;
    node.hidden = true;
    this.node.append(node);
    const tag = {node, number, unit, look, lead: this.leads.add(), place: 0, at: null, size: [0, 0], shown: false, put: placing(node)};
    this.list.push(tag);
    return tag;
  }

  /// New words; measured only where they are of another length.
  tell(tag, text, {shown = true, stale = false, look = tag.look, unit} = {}) {
    const longer = text.length !== tag.number.textContent.length || (unit !== undefined && unit !== tag.unit.textContent);
    if (tag.number.textContent !== text) tag.number.textContent = text;
    if (unit !== undefined && tag.unit.textContent !== unit) tag.unit.textContent = unit;
    const name = `tag ${look}${stale ? ' stale' : ''}`;
    if (tag.node.className !== name) tag.node.className = name;
    if (tag.shown !== shown || longer) {
      tag.node.hidden = !shown;
      tag.shown = shown;
      tag.size = shown ? [tag.node.offsetWidth, tag.node.offsetHeight] : [0, 0];
    }
  }

  /// To their points: `at` of each is [x, y] in px or null. `taken` are boxes that belong to others.
  lay(width, height, taken, choose) {
    const set = [...taken];
    for (const tag of this.list) {
      const seen = tag.shown && tag.at && tag.at[0] > 0 && tag.at[1] > 0 && tag.at[0] < width && tag.at[1] < height;
      if (!seen) {
        this.#hide(tag);
        continue;
      }
      let box = this.#box(tag, tag.place);
      if (choose) {
        tag.crowded = false;
        if (!this.#fits(box, set, width, height)) {
          const free = places.findIndex((_, i) => this.#fits(this.#box(tag, i), set, width, height));
          if (free >= 0) tag.place = free;
          tag.crowded = free < 0;
          box = this.#box(tag, tag.place);
        }
      }
      // Rather no number than one upon another.
      if (tag.crowded) {
        this.#hide(tag);
        continue;
      }
      set.push(box);
      this.#put(tag, 'seen', tag.node.style, 'visibility', '');
      tag.put(Math.round(box.left), Math.round(box.top));
      const end = [Math.max(box.left, Math.min(box.right, tag.at[0])), Math.max(box.top, Math.min(box.bottom, tag.at[1]))];
      const far = Math.hypot(end[0] - tag.at[0], end[1] - tag.at[1]) > lead_from_px;
      tag.lead(far ? [...tag.at, ...end] : null);
    }
  }

  /// What is as it was is not written: a browser would style and lay out all the same, twenty times a second.
  #put(tag, key, target, name, value) {
    if (tag[key] === value) return;
    tag[key] = value;
    target[name] = value;
  }

  #hide(tag) {
    if (tag.shown) this.#put(tag, 'seen', tag.node.style, 'visibility', 'hidden');
    tag.lead(null);
  }

  #box(tag, place) {
    const [dx, dy] = places[place], [width, height] = tag.size;
    const x = tag.at[0] + dx * (gap_px + width / 2), y = tag.at[1] + dy * gap_px;
    return {left: x - width / 2, right: x + width / 2, top: y - height / 2, bottom: y + height / 2};
  }

  #fits(box, set, width, height) {
    return box.left > 4 && box.top > 4 && box.right < width - 4 && box.bottom < height - 4 && !set.some((other) => overlap(box, other));
  }
}
