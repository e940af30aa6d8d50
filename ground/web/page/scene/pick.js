// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A click on a part of the robot: which link that is. Looked for when somebody clicks, not while the mouse moves, so pictures cost what they did.
import {Raycaster, Vector2} from 'three';

const still_px = 4, longest_ms = 500;

const is_shown = (part) => {
  for (let above = part; above; above = above.parent) if (!above.visible) return false;
  return true;
};

/// The link whose own shape `part` is of; null for dials, frames and halos, which hang on links, too.
function link_of(part) {
  let child = part;
  for (let above = part.parent; above; child = above, above = above.parent) {
    if (above.isURDFLink) return child.isURDFVisual || child.userData.dress || child.userData.bones ? above : null;
  }
  return null;
}

export class Picker {
  #ray = new Raycaster();
  #from = null;

  /// `view`: {canvas, robots, is_in_inset(event), eye_at(event, inset)}; `on_pick(robot, link)`. Made after what takes hold of parts: a click there is none here.
  constructor(view, on_pick) {
    const {canvas} = view;
    canvas.addEventListener('pointerdown', (event) => { this.#from = event.button === 0 && event.isPrimary ? event : null; });
    canvas.addEventListener('pointercancel', () => { this.#from = null; });
    canvas.addEventListener('pointerup', (event) => {
      const from = this.#from;
      this.#from = null;
      if (!from || event.timeStamp - from.timeStamp > longest_ms || Math.hypot(event.clientX - from.clientX, event.clientY - from.clientY) > still_px) return;
      const found = this.#link_at(view, event);
      if (found) on_pick(...found);
    });
  }

  #link_at(view, event) {
    const inset = view.is_in_inset(event), [x, y, camera] = view.eye_at(event, inset);
    this.#ray.setFromCamera(new Vector2(x, y), camera);
    const robots = view.robots.filter((robot) => robot.body.visible && Boolean(robot.about.inset && view.inset) === inset);
    for (const {object} of this.#ray.intersectObjects(robots.map(({body}) => body), true)) {
      const link = is_shown(object) ? link_of(object) : null;
      if (link) return [robots.find(({body}) => Object.values(body.links).includes(link)), link];
    }
    return null;
  }
}
