// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A robot's parts as a processor can draw them: lit at their corners, and all of one link at once. Each call to draw costs such a processor as
// much as a thousand corners.
import {BufferGeometry, Color, Float32BufferAttribute, Mesh, MeshBasicMaterial, MeshLambertMaterial, ShaderMaterial, Vector3} from 'three';
import {mergeGeometries} from 'three/addons/utils/BufferGeometryUtils.js';
import {sun_from} from './sky.js';

/// A metal that mirrors nothing would be dark.
const colour_of = ({color, metalness = 0}) => color.clone().lerp(new Color(0xffffff), metalness * 0.12);
const gloss_of = ({roughness = 0.5}) => (1 - roughness) * 0.55;

/// Lit by the sun and the sky of sky.js, and toned there. `tinted`: colour and gloss come with each corner.
function lit_at_corners(uniforms, tinted = false) {
  const skin = new ShaderMaterial({
    uniforms: {...uniforms, sun: {value: sun_from.clone().normalize()}},
    vertexShader: `${tinted ? 'attribute vec4 tint;' : 'uniform vec3 colour; uniform float gloss;'} uniform vec3 sun; varying vec3 seen;
      #include <common>
      #include <tonemapping_pars_fragment>
      void main() {
        ${tinted ? 'vec3 colour = tint.rgb; float gloss = tint.a;' : ''}
        vec4 p = modelMatrix * vec4(position, 1.);
        vec3 n = normalize(mat3(modelMatrix) * normal), half_way = normalize(sun + normalize(cameraPosition - p.xyz));
        vec3 light = vec3(3.4, 3.03, 2.6) * max(dot(n, sun), 0.) + .42 * mix(vec3(.023, .014, .007), vec3(.27, .45, .80), .5 + .5 * n.z);
        vec3 c = colour * light * RECIPROCAL_PI + gloss * pow(max(dot(n, half_way), 0.), 24.);
        seen = pow(ACESFilmicToneMapping(c), vec3(1. / 2.2));
        gl_Position = projectionMatrix * viewMatrix * p;
      }`,
    fragmentShader: 'varying vec3 seen; void main() { gl_FragColor = vec4(seen, 1.); }'});
  skin.userData.raster = tinted ? 'tinted' : 'lit';
  return skin;
}

/// Materials of a graphics card, or the same colours as a processor can draw them.
const plain = new Map();
export function affordable(material, software) {
  if (!software || !material.isMeshStandardMaterial) return material;
  if (!plain.has(material)) plain.set(material, material.map ? new (material.transparent ? MeshBasicMaterial : MeshLambertMaterial)({color: material.color, map: material.map, transparent: material.transparent,
    polygonOffset: material.polygonOffset, polygonOffsetFactor: material.polygonOffsetFactor}) : lit_at_corners({colour: {value: colour_of(material)}, gloss: {value: gloss_of(material)}}));
  return plain.get(material);
}

const sliver_m = 2e-4;
/// No triangle that is a line: parts that are turned on a lathe have one for each of their sides at both ends.
function drop_slivers(geometry) {
  const {position} = geometry.attributes, {index} = geometry, a = new Vector3(), b = new Vector3();
  const apart = (i, j) => a.fromBufferAttribute(position, i).distanceToSquared(b.fromBufferAttribute(position, j)) > sliver_m ** 2;
  const kept = [];
  for (let i = 0; i + 2 < index.count; i += 3) {
    const [first, second, third] = [index.getX(i), index.getX(i + 1), index.getX(i + 2)];
    if (apart(first, second) && apart(second, third) && apart(third, first)) kept.push(first, second, third);
  }
  geometry.setIndex(kept);
}

let tinted_skin = null;
const may_be_joined = ({isMesh, material, children, userData}) => isMesh && material.isMeshStandardMaterial && !material.map && !material.transparent && !children.length && !userData.label;

/// The parts of `whole` (kit.js merged()) that differ in colour only as one mesh, each corner with its own; also a single one, so that all robots
/// take one program.
export function joined(whole) {
  const parts = whole.children.filter(may_be_joined);
  if (!parts.length) return whole;
  const geometries = parts.map(({geometry, material}) => {
    const made = geometry.clone(), count = made.attributes.position.count, {r, g, b} = colour_of(material), gloss = gloss_of(material);
    for (const name of Object.keys(made.attributes)) if (!['position', 'normal'].includes(name)) made.deleteAttribute(name);
    drop_slivers(made);
    return made.setAttribute('tint', new Float32BufferAttribute(Array.from({length: count}, () => [r, g, b, gloss]).flat(), 4));
  });
  whole.remove(...parts);
  whole.add(new Mesh(mergeGeometries(geometries), tinted_skin ??= lit_at_corners({}, true)));
  return whole;
}

const most_cells = 65536;
/// All corners in one cell as one in their middle, and no triangle that has become a line: a fifth of them, of nearly the same outline. A processor
/// that draws pays for each.
export function coarse(geometry, cell_m) {
  const {position} = geometry.attributes, known = new Map(), sums = [], index = [];
  const of_cell = Array.from({length: position.count}, (_, i) => {
    const at = [position.getX(i), position.getY(i), position.getZ(i)];
    const key = at.reduce((sum, value) => sum * most_cells + Math.round(value / cell_m) + most_cells / 2, 0);
    if (!known.has(key)) {
      known.set(key, known.size);
      sums.push([0, 0, 0, 0]);
    }
    const cell = known.get(key);
    [...at, 1].forEach((value, k) => { sums[cell][k] += value; });
    return cell;
  });
  const corner = geometry.index ? (i) => of_cell[geometry.index.getX(i)] : (i) => of_cell[i], drawn = new Set();
  for (let i = 0, end = geometry.index?.count ?? position.count; i + 2 < end; i += 3) {
    const [a, b, c] = [corner(i), corner(i + 1), corner(i + 2)];
    if (a === b || b === c || c === a) continue;
    const least = Math.min(a, b, c), most = Math.max(a, b, c), key = (least * sums.length + a + b + c - least - most) * sums.length + most;
    if (drawn.has(key)) continue;
    drawn.add(key);
    index.push(a, b, c);
  }
  return new BufferGeometry().setAttribute('position', new Float32BufferAttribute(sums.flatMap(([x, y, z, count]) => [x / count, y / count, z / count]), 3)).setIndex(index);
}

const hiding_cell = 0.15, most_hiding_cell_m = 0.007, least_hiding_m = 0.008;
const unseen = new MeshBasicMaterial({colorWrite: false}), before_all = -3;

function hiding(geometry, scale) {
  geometry.computeBoundingSphere();
  const {radius} = geometry.boundingSphere;
  return radius > least_hiding_m * scale ? coarse(geometry, Math.min(radius * hiding_cell, most_hiding_cell_m * scale)) : null;
}

/// What `group` hides, as one unseen mesh: what is small against a metre of `scale` hides nothing, and edges need no roundness.
export function hider_of(group, scale) {
  group.updateMatrixWorld(true);
  const home = group.matrixWorld.clone().invert(), geometries = [];
  group.traverse((part) => {
    if (!part.isMesh || part.userData.label || part.userData.flush) return;
    const geometry = hiding(part.geometry.clone().applyMatrix4(home.clone().multiply(part.matrixWorld)), scale);
    if (geometry) geometries.push(geometry);
  });
  if (!geometries.length) return null;
  const mesh = new Mesh(mergeGeometries(geometries), unseen);
  mesh.renderOrder = before_all;
  return mesh;
}

/// `dress`, made of `parts`, shows nothing itself any more and hides as they do; its halo and shadow, which hang on it, stay.
export function become_hider(dress, parts, scale) {
  const meshes = dress.children.filter((part) => part.isMesh), nothing = new BufferGeometry().setAttribute('position', new Float32BufferAttribute([], 3));
  const hider = hider_of(parts, scale)?.geometry ?? nothing;
  meshes.forEach((part) => {
    if (part.userData.label) part.visible = false;
    else Object.assign(part, {userData: {...part.userData, shown_once: part.geometry}, geometry: part === meshes[0] ? hider : nothing, material: unseen, renderOrder: before_all});
  });
}
