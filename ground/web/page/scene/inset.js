// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The picture of the hand within that of the robot: a scene of its own, in the window that a view has for it, with an arrow for what the hand feels.
import {PerspectiveCamera, Scene, Vector3} from 'three';
import {Arrow, colours} from './instruments.js';
import {LivePicture, live_canvas} from './live.js';
import {lights} from './sky.js';

export class Inset {
  /// `software`: a processor draws it, into a canvas of its own.
  constructor({from_m, to_m}, software) {
    Object.assign(this, {scene: new Scene(), camera: new PerspectiveCamera(28, 1, 0.02, 5), box: {left: 0, top: 0, width: 0, height: 0}});
    this.camera.up.set(0, 0, 1);
    this.camera.position.fromArray(from_m);
    this.camera.lookAt(...to_m);
    if (software) this.live = new LivePicture(this.canvas = live_canvas(null));
    this.scene.add(...lights({target: new Vector3(), reach_m: 0.3, shadow: false}));
    this.felt = new Arrow(colours.felt, 0.0036);
    this.scene.add(this.felt.group);
  }

  /// Where `window` is on the stage. True: as large as before.
  lay(stage, window) {
    const {width: wide_before, height: tall_before} = this.box, outer = stage.getBoundingClientRect(), box = window.getBoundingClientRect();
    this.box = {left: box.left - outer.left, top: box.top - outer.top, width: box.width, height: box.height};
    this.camera.aspect = box.width / Math.max(1, box.height);
    this.camera.updateProjectionMatrix();
    return box.width === wide_before && box.height === tall_before;
  }

  /// Of a place on the stage, in px.
  has(left, top) {
    const x = left - this.box.left, y = top - this.box.top;
    return x >= 0 && y >= 0 && x <= this.box.width && y <= this.box.height;
  }

  /// The torque of a stick about its two axes, N m.
  feel([x, y], shown) {
    const size = Math.hypot(x, y);
    this.felt.group.visible = shown && size > 0.004;
    if (this.felt.group.visible) this.felt.point(new Vector3(0, 0, 0.19), new Vector3(x / size, y / size, 0), Math.min(0.1, 0.03 + 0.5 * size));
  }

  /// By `renderer` into what it has drawn, which is `tall` px high; by a processor into the own canvas.
  draw(renderer, tall) {
    const {left, top, width, height} = this.box;
    if (!width) return;
    if (this.live) return this.live.draw(this.scene, this.camera, Math.round(width), Math.round(height));
    const bottom = tall - top - height;
    renderer.setScissorTest(true);
    renderer.setScissor(left, bottom, width, height);
    renderer.setViewport(left, bottom, width, height);
    renderer.setClearColor(0x14171b, 1);
    renderer.clear();
    renderer.render(this.scene, this.camera);
    renderer.setScissorTest(false);
  }
}
