// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Other ways to draw the parts of a robot: as the ghost of where it shall go, with a halo where it is stopped, as its shadow on a plate.
import {BackSide, Color, CustomBlending, LessEqualDepth, MaxEquation, Mesh, MeshBasicMaterial, OneFactor, ShaderMaterial, Vector3, ZeroFactor} from 'three';
import {coarse} from './plain.js';

const world = 'vec4 p = modelMatrix * vec4(position, 1.); vec3 k = normalize(mat3(viewMatrix) * mat3(modelMatrix) * normal);';

/// For live.js, which knows no programs.
function known_as(kind, material) {
  material.userData.raster = kind;
  return material;
}

// What turns around an axis that both have lies in the same place: there the robot is seen, not both in stripes.
const behind_robot = (units) => ({polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: units});
const ghost_depth = new MeshBasicMaterial({colorWrite: false, ...behind_robot(1500)});
/// One layer of translucent colour, brighter at the edges: behind it stands its own depth, so that no inner face is seen.
export function ghost_skin(colour) {
  return known_as('ghost', new ShaderMaterial({transparent: true, depthWrite: false, depthFunc: LessEqualDepth, ...behind_robot(1400), uniforms: {colour: {value: new Color(colour)}, opacity: {value: 0.34}},
    vertexShader: `varying vec3 n, v; void main() { ${world} vec4 c = viewMatrix * p; n = k; v = normalize(-c.xyz); gl_Position = projectionMatrix * c; }`,
    fragmentShader: `uniform vec3 colour; uniform float opacity; varying vec3 n, v;
      void main() { float f = 1. - abs(dot(normalize(n), normalize(v))); gl_FragColor = vec4(colour * (.62 + .6 * f), opacity * (.7 + .9 * f * f) + .1);
      #include <colorspace_fragment>
      }`}));
}

const halo_hulls = [[0.0028, 0.95], [0.007, 0.34], [0.013, 0.16]];
/// Hulls grown along the normals and seen from inside, so a red rim without a second pass over the picture.
function halo_skins(count) {
  return halo_hulls.slice(0, count).map(([grown, opacity]) => known_as('halo', new ShaderMaterial({transparent: true, side: BackSide, depthWrite: false,
    uniforms: {colour: {value: new Color(0xff4f48)}, opacity: {value: opacity}, grown: {value: grown}},
    vertexShader: `uniform float grown; void main() { ${world} vec4 c = viewMatrix * p; c.xyz += k * grown; gl_Position = projectionMatrix * c; }`,
    fragmentShader: `uniform vec3 colour; uniform float opacity; void main() { gl_FragColor = vec4(colour, opacity);
      #include <colorspace_fragment>
      }`})));
}

/// Where the sun's rays through each point meet the plane z: the darkest of all that falls on a place counts, not their sum. What faces the sun
/// covers it all, and lies on the plane as it faces who looks from above.
function shadow_skin(sun, z, strength) {
  return known_as('shadow', new ShaderMaterial({transparent: true, depthWrite: false, blending: CustomBlending, blendEquation: MaxEquation, blendSrc: OneFactor, blendDst: OneFactor,
    blendEquationAlpha: MaxEquation, blendSrcAlpha: OneFactor, blendDstAlpha: ZeroFactor, uniforms: {sun: {value: sun}, z: {value: z}, strength: {value: strength}},
    vertexShader: `uniform vec3 sun; uniform float z; void main() { vec4 p = modelMatrix * vec4(position, 1.); p.xyz -= sun * (p.z - z) / sun.z; gl_Position = projectionMatrix * viewMatrix * p; }`,
    fragmentShader: 'uniform float strength; void main() { gl_FragColor = vec4(0., 0., 0., strength); }'}));
}

const meshes_of = (robot) => {
  const found = [];
  robot.traverse((part) => { if (part.isMesh && !part.userData.label && !part.userData.skin && part.parent) found.push(part); });
  return found;
};

function wrapped(part, material, order, geometry = part.geometry) {
  const skin = new Mesh(geometry, material);
  skin.userData.skin = true;
  skin.renderOrder = order;
  skin.frustumCulled = false;
  part.add(skin);
  return skin;
}

/// Turns the parts themselves into the ghost.
export function make_ghost(robot, skin) {
  for (const part of meshes_of(robot)) {
    part.material = ghost_depth;
    part.castShadow = part.receiveShadow = false;
    part.renderOrder = 5;
    wrapped(part, skin, 6);
  }
  robot.traverse((part) => { if (part.userData.label) part.visible = false; });
}

/// Made when it is first to be seen: most flights never show it.
export class Halo {
  #skins = [];
  #shown = false;
  constructor(robot, count) {
    Object.assign(this, {robot, count});
  }
  set shown(value) {
    if (value === this.#shown) return;
    this.#shown = value;
    if (value && !this.#skins.length) {
      const materials = halo_skins(this.count);
      this.#skins = meshes_of(this.robot).flatMap((part) => materials.map((material) => wrapped(part, material, 3, part.userData.shown_once ?? part.geometry)));
    }
    for (const skin of this.#skins) skin.visible = value;
  }
}

const shadow_cell = 0.13;
/// What is smaller hides behind what is not.
const least_shadow_m = 0.045;
/// For pictures that are composed of a still one and a transparent one above it, which has no light of its own to be dimmed.
export function cast_on_plane(robot, sun, z) {
  const material = shadow_skin(new Vector3().copy(sun).normalize(), z, 0.42);
  for (const part of meshes_of(robot)) {
    // Dials and frames are drawn upon the picture: they stand nowhere.
    if (part.material.isMeshBasicMaterial) continue;
    part.geometry.computeBoundingSphere();
    const {radius} = part.geometry.boundingSphere;
    if (radius > least_shadow_m) wrapped(part, material, -2, coarse(part.geometry, radius * shadow_cell));
  }
}
