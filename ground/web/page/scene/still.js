// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What stands still, as a picture that is drawn once for a camera: for processors that draw by themselves. In bands and program by program,
// one for each frame of the robot, so that the page never waits for all of it; coarse while the camera turns.

const bands = 8, coarse = 0.34;
const background = 0x04060a, empty = '#04060a';

export class StillPicture {
  /// `renderer` is given to it before there is something in `scene`.
  constructor(scene, canvas) {
    // Nothing is seen through it: a browser has less to mix.
    Object.assign(this, {renderer: null, scene, canvas, context: canvas.getContext('2d', {alpha: false}), band: 0, wanted: false, held: false, whole: false, unseen: null, grown_once: false});
  }

  /// The camera moved, or there is more to be seen.
  ask() {
    this.wanted = true;
    this.held = false;
    this.band = 0;
  }

  /// It is not what is wanted any more, but stands until somebody asks again.
  hold() {
    this.wanted = false;
    this.held = true;
  }

  /// One step of it; true when there is more to do. The renderer's own canvas is spoiled by it.
  draw(camera, {x: width, y: height}, turning) {
    if (!this.wanted || !this.renderer || !this.grown_once) return false;
    const {canvas} = this;
    if (canvas.width !== width || canvas.height !== height) this.#stretch(width, height);
    if (this.unseen === null) this.unseen = kinds_of(this.scene);
    if (this.unseen.length) {
      this.#warm(camera, this.unseen.pop());
      return true;
    }
    if (turning && this.whole) {
      this.band = 0;
      const wide = Math.round(width * coarse), tall = Math.round(height * coarse);
      this.#render(camera, wide, tall);
      this.context.drawImage(this.renderer.domElement, 0, height - tall, wide, tall, 0, 0, width, height);
      this.#shade(width, height);
      return true;
    }
    const top = Math.round(height * this.band / bands), tall = Math.round(height * (this.band + 1) / bands) - top;
    camera.setViewOffset(width, height, 0, top, width, tall);
    this.#render(camera, width, tall);
    camera.clearViewOffset();
    this.context.drawImage(this.renderer.domElement, 0, height - tall, width, tall, 0, top, width, tall);
    this.wanted = ++this.band < bands;
    if (this.wanted) return true;
    this.whole = true;
    this.#shade(width, height);
    return false;
  }

  /// More has been added, of which its programs are made first; before, there is nothing worth a picture.
  grown() {
    this.grown_once = true;
    this.unseen = null;
    this.ask();
  }

  /// To another size: the picture of before stands there until there is a new one.
  #stretch(width, height) {
    const {canvas} = this, before = document.createElement('canvas');
    [before.width, before.height] = [Math.max(1, canvas.width), Math.max(1, canvas.height)];
    before.getContext('2d').drawImage(canvas, 0, 0);
    [canvas.width, canvas.height] = [width, height];
    this.context.fillStyle = empty;
    this.context.fillRect(0, 0, width, height);
    if (this.whole) this.context.drawImage(before, 0, 0, width, height);
  }

  /// Darker towards the edges, once: a layer above would be mixed in with every frame.
  #shade(width, height) {
    const {context} = this;
    context.save();
    context.scale(width / 2, height / 2);
    const shade = context.createRadialGradient(1, 1, 0, 1, 1, 1.64);
    shade.addColorStop(0.56, 'rgba(4, 6, 10, 0)');
    shade.addColorStop(1, 'rgba(4, 6, 10, .55)');
    context.fillStyle = shade;
    context.fillRect(0, 0, 2, 2);
    context.restore();
  }

  #render(camera, wide, tall) {
    const {renderer, scene} = this;
    renderer.setScissorTest(true);
    renderer.setScissor(0, 0, wide, tall);
    renderer.setViewport(0, 0, wide, tall);
    renderer.setClearColor(background, 1);
    renderer.clear();
    renderer.render(scene, camera);
  }

  /// Draws one part alone, as small as can be: what that costs is the making of its program.
  #warm(camera, part) {
    const hidden = [];
    this.scene.traverse((other) => {
      if (other === part || !(other.isMesh || other.isPoints) || !other.visible) return;
      other.visible = false;
      hidden.push(other);
    });
    // A part within another one would be hidden with it.
    for (let above = part; above; above = above.parent) above.visible = true;
    const {frustumCulled} = part;
    part.frustumCulled = false;
    this.#render(camera, 4, 4);
    part.frustumCulled = frustumCulled;
    for (const other of hidden) other.visible = true;
  }
}

/// One part for each kind of program that the scene takes.
function kinds_of(scene) {
  const found = new Map();
  scene.traverse((part) => {
    if (!part.isMesh && !part.isPoints) return;
    const material = [part.material].flat()[0];
    const kind = material.isShaderMaterial ? material.fragmentShader : [material.type, Boolean(material.map), Boolean(material.normalMap), Boolean(material.envMap), material.side, material.transparent].join();
    if (!found.has(kind)) found.set(kind, part);
  });
  return [...found.values()];
}
