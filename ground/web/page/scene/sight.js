// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// From where the scene is seen: a camera that begins where the mission has it, and that a mouse turns about what it looks at.
import {PerspectiveCamera, Vector3} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

const usual_fov_deg = 34, narrow = 1.4;

export class Sight {
  /// `begin`: {from_m, to_m, fov_deg, tip_from_m} of a scene.json.
  constructor(begin) {
    this.begin = begin;
    this.fov_deg = begin.fov_deg ?? usual_fov_deg;
    this.scale = new Vector3().fromArray(begin.from_m).distanceTo(new Vector3().fromArray(begin.to_m));
    this.camera = new PerspectiveCamera(this.fov_deg, 1, 0.05 * this.scale, 900 * this.scale);
    this.camera.up.set(0, 0, 1);
    this.camera.position.fromArray(begin.from_m);
  }

  /// By the mouse on `canvas`; `moved` is called whenever it has.
  be_led_on(canvas, moved) {
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.target.fromArray(this.begin.to_m);
    Object.assign(this.controls, {maxDistance: 4 * this.scale, minDistance: 0.15 * this.scale, maxPolarAngle: Math.PI / 2 - 0.02, zoomToCursor: true});
    this.controls.addEventListener('change', () => moved());
    this.controls.update();
  }

  /// The robot keeps its size in a narrow panel.
  fit(aspect) {
    this.camera.aspect = aspect;
    this.camera.fov = aspect < narrow ? this.fov_deg * narrow / aspect : this.fov_deg;
    this.camera.updateProjectionMatrix();
  }

  from(from_m, to_m = this.begin.to_m) {
    this.camera.position.fromArray(from_m);
    this.controls.target.fromArray(to_m);
    // Straight above, the azimuth of before would turn the picture.
    if (Math.hypot(from_m[0] - to_m[0], from_m[1] - to_m[1]) < 0.05 * this.scale) this.camera.position.set(to_m[0], to_m[1] - 1e-3, from_m[2]);
    this.controls.update();
  }

  /// From the side where `direction`, a unit vector, points, as far away as before.
  along(direction) {
    const {target} = this.controls, far = this.camera.position.distanceTo(target);
    this.from(new Vector3().fromArray(direction).multiplyScalar(far).add(target).toArray(), target.toArray());
  }

  /// The tip from near, as the mission has it.
  near(tip) {
    this.from(new Vector3().fromArray(this.begin.tip_from_m).sub(new Vector3().fromArray(this.begin.to_m)).add(tip).toArray(), tip.toArray());
  }
}
