// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What is drawn into the scene to be read: limits as dials, force as an arrow, tool frame, trail, the path to a goal. Unlit and not toned: a
// colour here means the same as everywhere on the page.
import {
  BufferAttribute, BufferGeometry, Color, ConeGeometry, CylinderGeometry, DoubleSide, DynamicDrawUsage, Group, Mesh, MeshBasicMaterial, Quaternion, RingGeometry, SphereGeometry, Vector3,
} from 'three';
import {mergeGeometries} from 'three/addons/utils/BufferGeometryUtils.js';

export const colours = {measured: 0xffffff, goal: 0x6cb0ff, touched: 0x46d6c8, felt: 0xb9a2ff, limit: 0xb08d45, near: 0xf5b544, wrong: 0xff4f48};
const flat = (colour, more = {}) => new MeshBasicMaterial({color: colour, toneMapped: false, ...more});
// Flat things have one layer: drawn in two passes, as is usual for two sides, they would cost twice as much.
const painted = (more = {}) => new MeshBasicMaterial({vertexColors: true, transparent: true, toneMapped: false, side: DoubleSide, forceSinglePass: true, ...more});

function with_colour(geometry, colour, opacity) {
  const {r, g, b} = new Color(colour), count = geometry.attributes.position.count, list = new Float32Array(4 * count);
  for (let i = 0; i < count; ++i) list.set([r, g, b, opacity], 4 * i);
  geometry.setAttribute('color', new BufferAttribute(list, 4));
  geometry.deleteAttribute('uv');
  return geometry;
}

function sector(inner, outer, from, to, colour, opacity, z) {
  const geometry = with_colour(new RingGeometry(inner, outer, Math.max(2, Math.ceil((to - from) * 12)), 1, from, to - from), colour, opacity);
  geometry.translate(0, 0, z);
  return geometry;
}

/// The whole range of a joint around its axis, its ends ochre, amber where it comes within a twentieth of one.
export class Dial {
  constructor({lower, upper}, radius) {
    const wide = radius * 0.11, end = 0.05 * (upper - lower), step = radius * 0.003;
    this.limits = [lower + end, upper - end];
    const face = (colour) => {
      const parts = [sector(radius - wide * 0.35, radius + wide * 1.35, lower - 0.04, upper + 0.04, 0x05070a, 0.5, 0), sector(radius, radius + wide, lower, upper, 0xffffff, 0.2, step),
        sector(radius, radius + wide, lower, lower + end, colour, 0.9, 2 * step), sector(radius, radius + wide, upper - end, upper, colour, 0.9, 2 * step)];
      for (let tick = Math.ceil(lower / 0.5) * 0.5; tick <= upper; tick += 0.5) parts.push(sector(radius + wide, radius + wide * 1.9, tick - 0.008, tick + 0.008, 0xffffff, 0.5, step));
      return new Mesh(mergeGeometries(parts), painted({depthWrite: false}));
    };
    this.quiet = face(colours.limit);
    this.loud = face(colours.near);
    this.needle = new Mesh(mergeGeometries([sector(radius - wide, radius + 2 * wide, -0.05, 0.05, 0x05070a, 0.75, 3 * step), sector(radius - wide * 0.8, radius + wide * 1.8, -0.026, 0.026, 0xffffff, 1, 4 * step)]),
      painted({depthWrite: false}));
    this.group = new Group();
    this.group.add(this.quiet, this.loud, this.needle);
    this.group.traverse((part) => { part.renderOrder = 7; });
    this.needle.renderOrder = 8;
  }

  turn(angle) {
    this.needle.rotation.z = angle;
    this.loud.visible = angle < this.limits[0] || angle > this.limits[1];
    this.quiet.visible = !this.loud.visible;
  }
}

const up = new Vector3(0, 1, 0);

/// An arrow whose length changes and whose thickness stays.
export class Arrow {
  constructor(colour, radius) {
    this.radius = radius;
    const material = flat(colour, {transparent: true});
    this.shaft = new Mesh(new CylinderGeometry(radius, radius, 1, 14), material);
    this.head = new Mesh(new ConeGeometry(radius * 2.7, 1, 20), material);
    this.group = new Group();
    this.group.add(this.shaft, this.head);
    this.group.traverse((part) => { part.renderOrder = 9; part.frustumCulled = false; });
    this.group.visible = false;
  }

  /// From a point along a unit vector.
  point(from, direction, length) {
    const head = Math.min(this.radius * 7.5, length * 0.45);
    this.shaft.scale.y = Math.max(1e-6, length - head);
    this.shaft.position.y = (length - head) / 2;
    this.head.scale.y = head;
    this.head.position.y = length - head / 2;
    this.group.position.copy(from);
    this.group.quaternion.setFromUnitVectors(up, direction);
  }
}

/// x red, y green, z blue, as everybody draws a frame.
export function triad(length, radius) {
  const axis = (colour, direction) => {
    const head = length * 0.2, turn = new Quaternion().setFromUnitVectors(up, direction);
    const shaft = new CylinderGeometry(radius, radius, length - head, 8).translate(0, (length - head) / 2, 0), cone = new ConeGeometry(radius * 2.7, head, 10).translate(0, length - head / 2, 0);
    return [shaft, cone].map((geometry) => with_colour(geometry.applyQuaternion(turn), colour, 1));
  };
  const mesh = new Mesh(mergeGeometries([...axis(0xe8756e, new Vector3(1, 0, 0)), ...axis(0x86c97a, new Vector3(0, 1, 0)), ...axis(0x6aa5f2, new Vector3(0, 0, 1))]), painted());
  mesh.renderOrder = 8;
  return mesh;
}

/// A line with a width, facing the camera: points with a colour and an opacity each.
export class Ribbon {
  constructor(most, width, more = {}) {
    this.most = most;
    this.width = width;
    this.points = [];
    const geometry = new BufferGeometry();
    this.position = new BufferAttribute(new Float32Array(6 * most), 3).setUsage(DynamicDrawUsage);
    this.colour = new BufferAttribute(new Float32Array(8 * most), 4).setUsage(DynamicDrawUsage);
    geometry.setAttribute('position', this.position);
    geometry.setAttribute('color', this.colour);
    const index = new Uint16Array(6 * (most - 1));
    for (let i = 0; i < most - 1; ++i) index.set([2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 1, 2 * i + 3, 2 * i + 2], 6 * i);
    geometry.setIndex(new BufferAttribute(index, 1));
    this.mesh = new Mesh(geometry, painted({depthWrite: false, ...more}));
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 8;
  }

  clear() {
    this.points.length = 0;
    this.mesh.geometry.setDrawRange(0, 0);
  }

  add(at, colour) {
    this.points.push({at: at.clone(), colour: new Color(colour)});
    if (this.points.length > this.most) this.points.shift();
  }

  /// `opacity(i, count)` of each point.
  lay(camera, opacity) {
    const {points, position, colour, width} = this, count = points.length;
    const along = new Vector3(), side = new Vector3(), view = camera.position;
    for (let i = 0; i < count; ++i) {
      along.subVectors(points[Math.min(count - 1, i + 1)].at, points[Math.max(0, i - 1)].at);
      side.subVectors(view, points[i].at).cross(along).normalize().multiplyScalar(width / 2);
      const {x, y, z} = points[i].at, {r, g, b} = points[i].colour, a = opacity(i, count);
      position.setXYZ(2 * i, x + side.x, y + side.y, z + side.z);
      position.setXYZ(2 * i + 1, x - side.x, y - side.y, z - side.z);
      colour.setXYZW(2 * i, r, g, b, a);
      colour.setXYZW(2 * i + 1, r, g, b, a);
    }
    position.needsUpdate = colour.needsUpdate = true;
    this.mesh.geometry.setDrawRange(0, Math.max(0, 6 * (count - 1)));
  }
}

/// The path of a tip to its goal, a dot each half second; what lies beyond a limit is red.
export class GoalPath {
  constructor(scale) {
    this.ribbon = new Ribbon(96, 0.003 * scale, {depthTest: false});
    this.dots = Array.from({length: 16}, () => new Mesh(new SphereGeometry(0.0036 * scale, 12, 8), flat(colours.goal, {depthTest: false, transparent: true})));
    this.group = new Group();
    this.group.add(this.ribbon.mesh, ...this.dots);
    for (const dot of this.dots) dot.renderOrder = 9;
    this.group.visible = false;
  }

  /// `path`: [{at, wrong}] over equal times of a motion of `duration_s`.
  lay(path, duration_s, camera) {
    this.ribbon.clear();
    for (const {at, wrong} of path) this.ribbon.add(at, wrong ? colours.wrong : colours.goal);
    this.ribbon.lay(camera, () => 0.95);
    const spacing_s = Math.max(0.5, duration_s / this.dots.length);
    this.dots.forEach((dot, i) => {
      const part = (i + 1) * spacing_s / duration_s, point = path[Math.round(part * (path.length - 1))];
      dot.visible = part <= 1 + 1e-9 && Boolean(point);
      if (!dot.visible) return;
      dot.position.copy(point.at);
      dot.material.color.set(point.wrong ? colours.wrong : colours.goal);
    });
  }
}

/// A ring where something is touched.
export function contact_ring(scale) {
  const ring = new Mesh(new RingGeometry(0.006 * scale, 0.0105 * scale, 28), flat(colours.touched, {transparent: true, opacity: 0.9, side: DoubleSide, forceSinglePass: true}));
  ring.visible = false;
  ring.renderOrder = 8;
  return ring;
}
