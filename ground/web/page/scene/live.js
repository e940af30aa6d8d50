// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What moves, drawn by the processor into a canvas that is no larger than what it shows and stands where that is. Of materials it knows what
// moving parts are made of: lit at their corners, flat, a picture on a plane; a ghost, a halo, a shadow (what `userData.raster` says).
import {BackSide, DoubleSide, Matrix4, Vector3} from 'three';
import {Raster, Texture} from './raster.js';
import {sun_from} from './sky.js';

const numbers = 9, shades = 16384, step_px = 64, usual_gloss = 0.2, depth_step = 1.2e-7, lead_colour = [255, 255, 255], lead_opacity = 0.5, black = {r: 0, g: 0, b: 0};
/// What `userData.raster` of a material says; of three.js' own ones those that light falls on are lit.
const kind_of = (material) => material.userData.raster ?? (material.isMeshStandardMaterial || material.isMeshLambertMaterial || material.isMeshPhongMaterial ? 'lit' : 'flat');
const sun = sun_from.clone().normalize();
/// What is said in light as it is shown, 0 to 255.
const shown = Float64Array.from({length: shades + 1}, (_, i) => 254.99 * (i / shades) ** (1 / 2.2));
const shade = (light) => shown[light <= 0 ? 0 : light >= 1 ? shades : light * shades | 0];

/// As plain.js says it to a graphics card: sun, sky and gloss, toned as three.js does (ACES).
function lit(c, at, colour_r, colour_g, colour_b, gloss, nx, ny, nz, shine) {
  const sunny = Math.max(0, nx * sun.x + ny * sun.y + nz * sun.z), up = 0.5 + 0.5 * nz;
  const white = gloss * shine, pi = 1 / Math.PI;
  const r = (colour_r * (3.4 * sunny + 0.42 * (0.023 + 0.247 * up)) * pi + white) / 0.6, g = (colour_g * (3.03 * sunny + 0.42 * (0.014 + 0.436 * up)) * pi + white) / 0.6;
  const b = (colour_b * (2.6 * sunny + 0.42 * (0.007 + 0.793 * up)) * pi + white) / 0.6;
  const x = 0.59719 * r + 0.35458 * g + 0.04823 * b, y = 0.076 * r + 0.90834 * g + 0.01566 * b, z = 0.0284 * r + 0.13383 * g + 0.83777 * b;
  const p = (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.432951) + 0.238081), q = (y * (y + 0.0245786) - 0.000090537) / (y * (0.983729 * y + 0.432951) + 0.238081);
  const s = (z * (z + 0.0245786) - 0.000090537) / (z * (0.983729 * z + 0.432951) + 0.238081);
  c[at] = shade(1.60475 * p - 0.53108 * q - 0.07367 * s);
  c[at + 1] = shade(-0.10208 * p + 1.10813 * q - 0.00605 * s);
  c[at + 2] = shade(-0.00327 * p - 0.07276 * q + 1.07602 * s);
}

/// What one draws into, in `stage` where there is one.
export function live_canvas(stage) {
  const canvas = document.createElement('canvas');
  canvas.className = 'live';
  stage?.append(canvas);
  return canvas;
}

export class LivePicture {
  #raster = new Raster();
  #canvas;
  #whole = new Matrix4();
  #eye = new Vector3();
  #textures = new WeakMap();
  #place = null;

  constructor(canvas) {
    this.#canvas = canvas;
    this.#canvas.width = this.#canvas.height = 0;
  }

  /// `scene` as `camera` sees it, `width` by `height` px; `leads` are lines in px above it.
  draw(scene, camera, width, height, {leads = []} = {}) {
    const raster = this.#raster, opaque = [], clear = [];
    raster.begin(width, height);
    if (scene.matrixWorldAutoUpdate) scene.updateMatrixWorld();
    if (!camera.parent) camera.updateMatrixWorld();
    camera.getWorldPosition(this.#eye);
    this.camera = camera;
    const collect = (part) => {
      if (!part.visible) return;
      if (part.isMesh || part.isLine) ([part.material].flat()[0].transparent ? clear : opaque).push(part);
      for (const child of part.children) collect(child);
    };
    collect(scene);
    const far = (part) => part.matrixWorld.elements[12] * eye.x + part.matrixWorld.elements[13] * eye.y + part.matrixWorld.elements[14] * eye.z;
    const eye = camera.getWorldDirection(new Vector3());
    opaque.sort((a, b) => a.renderOrder - b.renderOrder);
    clear.sort((a, b) => a.renderOrder - b.renderOrder || far(b) - far(a));
    for (const part of opaque) this.#draw_part(part);
    for (const part of clear) this.#draw_part(part);
    for (const [x0, y0, x1, y1] of leads) raster.line(x0, y0, x1, y1, lead_colour, lead_opacity);
    this.#show();
  }

  /// What it shows, where that is, into a picture of what the canvas stands in.
  copy_to(context) {
    if (this.#place) context.drawImage(this.#canvas, ...this.#place);
  }

  #show() {
    const box = this.#raster.drawn(), canvas = this.#canvas, hidden = box ? '' : 'hidden';
    if (canvas.style.visibility !== hidden) canvas.style.visibility = hidden;
    if (!box) return void (this.#place = null);
    this.#stretch(box);
    const [left, top] = this.#place;
    // All of it, with what is empty: so nothing of the picture before stays.
    this.context.putImageData(this.#raster.image, -left, -top, left, top, canvas.width, canvas.height);
  }

  /// Another place makes the browser list all layers anew, another size is new memory: it is one of few, and stays while it will do.
  #stretch({left, top, width, height}) {
    const canvas = this.#canvas, [x, y] = this.#place ?? [Infinity, Infinity], [right, bottom] = [left + width, top + height];
    const holds = x <= left && y <= top && x + canvas.width >= right && y + canvas.height >= bottom;
    if (holds && canvas.width < width + 3 * step_px && canvas.height < height + 3 * step_px) return;
    const at = [left, top].map((value) => Math.floor(value / step_px) * step_px), size = [Math.ceil((right - at[0]) / step_px) * step_px, Math.ceil((bottom - at[1]) / step_px) * step_px];
    if (canvas.width !== size[0] || canvas.height !== size[1]) {
      [canvas.width, canvas.height] = size;
      [canvas.style.width, canvas.style.height] = size.map((value) => `${value}px`);
      this.context = canvas.getContext('2d');
    }
    this.#place = at;
    canvas.style.transform = `translate(${at[0]}px, ${at[1]}px)`;
  }

  /// Corners in px and depths: the first three of nine numbers each.
  #project(part, corners, count, grown = 0) {
    const {position, normal} = part.geometry.attributes, p = position.array, {width, height} = this.#raster, n = grown ? normal.array : null;
    const e = this.#whole.multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse).multiply(part.matrixWorld).elements;
    for (let i = 0, k = 0, at = 0; i < count; ++i, k += 3, at += numbers) {
      const x = p[k] + (n ? grown * n[k] : 0), y = p[k + 1] + (n ? grown * n[k + 1] : 0), z = p[k + 2] + (n ? grown * n[k + 2] : 0);
      const w = e[3] * x + e[7] * y + e[11] * z + e[15];
      if (w < this.camera.near) {
        corners[at] = corners[at + 1] = corners[at + 2] = NaN;
        continue;
      }
      corners[at] = ((e[0] * x + e[4] * y + e[8] * z + e[12]) / w + 1) * 0.5 * width;
      corners[at + 1] = (1 - (e[1] * x + e[5] * y + e[9] * z + e[13]) / w) * 0.5 * height;
      corners[at + 2] = (e[2] * x + e[6] * y + e[10] * z + e[14]) / w;
    }
  }

  #draw_part(part) {
    const {geometry, material} = part, {start, count} = geometry.drawRange;
    if (!Array.isArray(material)) return this.#draw_range(part, material, start, count);
    for (const group of geometry.groups) this.#draw_range(part, material[group.materialIndex], group.start, group.count);
  }

  #draw_range(part, material, start, most) {
    const {geometry} = part, raster = this.#raster, {position, tint} = geometry.attributes, kind = kind_of(material), {count} = position;
    if (!count || !most) return;
    const c = raster.room(count);
    const how = {write: material.colorWrite === false ? '' : material.transparent ? 'blend' : 'opaque', side: material.side === DoubleSide ? 0 : material.side === BackSide ? -1 : 1,
      test: material.depthTest, keep: material.depthTest && material.depthWrite, lean: material.polygonOffset ? -material.polygonOffsetFactor : 0, nearer: material.polygonOffset ? -material.polygonOffsetUnits * depth_step : 0, texture: null};
    if (kind === 'shadow') this.#project_shadow(part, c, count, material.uniforms);
    else this.#project(part, c, count, kind === 'halo' ? material.uniforms.grown.value : 0);
    if (part.isLine) return this.#draw_line(c, material.color);
    if (how.write && kind === 'shadow') how.write = 'darkest';
    if (how.write) how.texture = this.#paint_corners(part, material, kind, c, count, tint?.array);
    const index = geometry.index?.array ?? null, all = index ? index.length : count, end = Math.min(all, start + most);
    if (start === 0 && (end === all || index)) raster.triangles(index, end, how);
    else raster.triangles((index ?? Uint32Array.from({length: count}, (_, i) => i)).subarray(start, end), end - start, how);
  }

  /// Colours of corners by what a material is; the picture on it, where it has one.
  #paint_corners(part, material, kind, c, count, tints) {
    const {uniforms, map} = material, {uv} = part.geometry.attributes;
    if (kind === 'tinted') this.#light(part, c, count, tints);
    else if (kind === 'lit') this.#light(part, c, count, null, uniforms?.colour.value ?? material.color, uniforms?.gloss.value ?? usual_gloss);
    else if (kind === 'ghost') this.#ghost(part, c, count);
    else if (kind === 'halo') this.#paint(c, count, uniforms.colour.value, uniforms.opacity.value);
    else if (kind === 'shadow') this.#paint(c, count, black, uniforms.strength.value);
    else this.#flat(part.geometry, material, c, count);
    if (!map?.image || !uv) return null;
    for (let i = 0, at = 7; i < count; ++i, at += numbers) {
      c[at] = uv.array[2 * i];
      c[at + 1] = uv.array[2 * i + 1];
    }
    if (!this.#textures.has(map)) this.#textures.set(map, new Texture(map.image));
    return this.#textures.get(map);
  }

  #draw_line(c, {r, g, b}) {
    this.#raster.line(c[0], c[1], c[numbers], c[numbers + 1], [r, g, b].map((value) => Math.round(shade(value))));
  }

  #paint(c, count, {r, g, b}, opacity) {
    const colour = [shade(r), shade(g), shade(b)];
    for (let i = 0, at = 3; i < count; ++i, at += numbers) {
      c[at] = colour[0];
      c[at + 1] = colour[1];
      c[at + 2] = colour[2];
      c[at + 3] = opacity;
    }
  }

  #flat(geometry, material, c, count) {
    const {color: tint} = geometry.attributes, {opacity} = material;
    this.#paint(c, count, material.color, opacity);
    if (material.vertexColors && tint) {
      const t = tint.array, wide = tint.itemSize;
      for (let i = 0, at = 3, k = 0; i < count; ++i, at += numbers, k += wide) {
        c[at] = shade(t[k]);
        c[at + 1] = shade(t[k + 1]);
        c[at + 2] = shade(t[k + 2]);
        c[at + 3] = (wide > 3 ? t[k + 3] : 1) * opacity;
      }
    }
  }

  #light(part, c, count, tints, colour, gloss) {
    const {position, normal} = part.geometry.attributes, p = position.array, n = normal.array, e = part.matrixWorld.elements, {x: ex, y: ey, z: ez} = this.#eye;
    for (let i = 0, k = 0, at = 0; i < count; ++i, k += 3, at += numbers) {
      let nx = e[0] * n[k] + e[4] * n[k + 1] + e[8] * n[k + 2], ny = e[1] * n[k] + e[5] * n[k + 1] + e[9] * n[k + 2], nz = e[2] * n[k] + e[6] * n[k + 1] + e[10] * n[k + 2];
      const long = 1 / (Math.sqrt(nx * nx + ny * ny + nz * nz) || 1);
      nx *= long; ny *= long; nz *= long;
      const vx = ex - (e[0] * p[k] + e[4] * p[k + 1] + e[8] * p[k + 2] + e[12]), vy = ey - (e[1] * p[k] + e[5] * p[k + 1] + e[9] * p[k + 2] + e[13]);
      const vz = ez - (e[2] * p[k] + e[6] * p[k + 1] + e[10] * p[k + 2] + e[14]), away = 1 / Math.sqrt(vx * vx + vy * vy + vz * vz);
      const hx = sun.x + vx * away, hy = sun.y + vy * away, hz = sun.z + vz * away;
      const half = Math.max(0, nx * hx + ny * hy + nz * hz) / Math.sqrt(hx * hx + hy * hy + hz * hz), h4 = half * half * half * half, h8 = h4 * h4;
      if (tints) lit(c, at + 3, tints[4 * i], tints[4 * i + 1], tints[4 * i + 2], tints[4 * i + 3], nx, ny, nz, h8 * h8 * h8);
      else lit(c, at + 3, colour.r, colour.g, colour.b, gloss, nx, ny, nz, h8 * h8 * h8);
      c[at + 6] = 1;
    }
  }

  /// Brighter and less clear at the edges, as skins.js says it to a graphics card.
  #ghost(part, c, count) {
    const {position, normal} = part.geometry.attributes, p = position.array, n = normal.array, e = part.matrixWorld.elements, {x: ex, y: ey, z: ez} = this.#eye;
    const {colour: {value: {r, g, b}}, opacity: {value: opacity}} = part.material.uniforms;
    for (let i = 0, k = 0, at = 3; i < count; ++i, k += 3, at += numbers) {
      const nx = e[0] * n[k] + e[4] * n[k + 1] + e[8] * n[k + 2], ny = e[1] * n[k] + e[5] * n[k + 1] + e[9] * n[k + 2], nz = e[2] * n[k] + e[6] * n[k + 1] + e[10] * n[k + 2];
      const vx = ex - (e[0] * p[k] + e[4] * p[k + 1] + e[8] * p[k + 2] + e[12]), vy = ey - (e[1] * p[k] + e[5] * p[k + 1] + e[9] * p[k + 2] + e[13]), vz = ez - (e[2] * p[k] + e[6] * p[k + 1] + e[10] * p[k + 2] + e[14]);
      const f = 1 - Math.abs(nx * vx + ny * vy + nz * vz) / (Math.hypot(nx, ny, nz) * Math.hypot(vx, vy, vz) || 1), bright = 0.62 + 0.6 * f;
      c[at] = shade(r * bright);
      c[at + 1] = shade(g * bright);
      c[at + 2] = shade(b * bright);
      c[at + 3] = Math.min(1, opacity * (0.7 + 0.9 * f * f) + 0.1);
    }
  }

  /// Where the sun's rays through each corner meet a plane.
  #project_shadow(part, c, count, {sun: {value: from}, z: {value: plane}}) {
    const {array: p} = part.geometry.attributes.position, m = part.matrixWorld.elements, {width, height} = this.#raster;
    const e = this.#whole.multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse).elements;
    for (let i = 0, k = 0, at = 0; i < count; ++i, k += 3, at += numbers) {
      const above = (m[2] * p[k] + m[6] * p[k + 1] + m[10] * p[k + 2] + m[14] - plane) / from.z;
      const x = m[0] * p[k] + m[4] * p[k + 1] + m[8] * p[k + 2] + m[12] - from.x * above, y = m[1] * p[k] + m[5] * p[k + 1] + m[9] * p[k + 2] + m[13] - from.y * above;
      const w = e[3] * x + e[7] * y + e[11] * plane + e[15];
      c[at] = w < this.camera.near ? NaN : ((e[0] * x + e[4] * y + e[8] * plane + e[12]) / w + 1) * 0.5 * width;
      c[at + 1] = (1 - (e[1] * x + e[5] * y + e[9] * plane + e[13]) / w) * 0.5 * height;
      c[at + 2] = (e[2] * x + e[6] * y + e[10] * plane + e[14]) / w;
    }
  }
}
