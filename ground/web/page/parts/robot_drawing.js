// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The robot in 3D: measured solid, commanded as a ghost, with what it touches. Draws only when a joint or the camera has
// moved. A chunk of its own: three.js is loaded by the views that show it. Realtime: none.
import {
  AmbientLight, ArrowHelper, BufferAttribute, BufferGeometry, Color, DirectionalLight, EdgesGeometry,
  ExtrudeGeometry, GridHelper, Group, HemisphereLight, Line, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial,
  PerspectiveCamera, Plane, Raycaster, Scene, Shape, SphereGeometry, Vector2, Vector3, WebGLRenderer, Box3,
} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import URDFLoader from 'urdf-loader';
import {asset} from '../api.js';
import {fault} from '../commanding.js';
import {replay, values} from '../store.js';
import {angles_of_offset, before_wall, surface_x_m, target_line, within_range} from './hand.js';

const moved_rad = 1e-5;
const quick_ms = 10;
const trail_points = 400;
const hand_period_ms = 60;
const near_limit = 0.08;
const lever_m = 0.109;
const band_from_m = 0.006;

const colour_ok = new Color(0x5b6880), colour_near = new Color(0xf2a93b), colour_at = new Color(0xf05d5e);

function parsed_urdf(text) {
  const loader = new URDFLoader();
  loader.parseCollision = false;
  return loader.parse(text);
}

function dress(robot, ghost) {
  robot.traverse((part) => {
    if (!part.isMesh) return;
    const colour = ghost ? new Color(0x3f8cff) : part.material.color.clone();
    part.material = new MeshLambertMaterial(ghost ?
      {color: colour, transparent: true, opacity: 0.3, depthWrite: false,
        polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 4} :
      {color: colour});
    part.renderOrder = ghost ? 1 : 0;
  });
}

/// Rings of the joints by name, to be coloured near their limits.
function rings_of(robot) {
  const rings = {};
  robot.traverse((part) => {
    const match = /^(.*)_ring$/.exec(part.urdfName ?? part.name ?? '');
    if (match) part.traverse((mesh) => { if (mesh.isMesh) rings[match[1]] = mesh; });
  });
  return rings;
}

function contour_mesh(contour) {
  const shape = new Shape();
  const steps = 96;
  shape.moveTo(contour.rail_x_m + contour.depth_m, contour.from_y_m);
  for (let i = 0; i <= steps; ++i) {
    const y = contour.from_y_m + (contour.to_y_m - contour.from_y_m) * i / steps;
    shape.lineTo(surface_x_m(contour, y), y);
  }
  shape.lineTo(contour.rail_x_m + contour.depth_m, contour.to_y_m);
  const geometry = new ExtrudeGeometry(shape, {depth: contour.height_m, bevelEnabled: false});
  const mesh = new Mesh(geometry, new MeshLambertMaterial({color: 0x8a6f45,
    // Its edges lie in its own faces: without a distance they would be dashed.
    polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2}));
  mesh.add(new LineSegments(new EdgesGeometry(geometry, 40), new LineBasicMaterial({color: 0xd9b06a})));
  return mesh;
}

/// A coil along x from the origin, of unit length; stretched and turned by its group.
function spring_mesh({from_m, to_m}, z) {
  const points = [];
  const turns = 9, radius_m = 0.0045;
  for (let i = 0; i <= turns * 12; ++i) {
    const angle = i / 12 * 2 * Math.PI, part = i / (turns * 12);
    const inner = part < 0.06 || part > 0.94 ? 0 : radius_m;
    points.push(new Vector3(part, inner * Math.cos(angle), inner * Math.sin(angle)));
  }
  const steel = new MeshLambertMaterial({color: 0x9fd8c0});
  const coil = new Group();
  const wire = new Line(new BufferGeometry().setFromPoints(points), new LineBasicMaterial({color: 0x9fd8c0}));
  coil.add(wire);
  const group = new Group();
  const post = new Mesh(new SphereGeometry(0.005, 12, 8), steel);
  group.add(coil, post);
  group.position.set(from_m[0], from_m[1], z);
  group.reach = (x, y) => {
    const dx = x - from_m[0], dy = y - from_m[1];
    coil.rotation.z = Math.atan2(dy, dx);
    coil.scale.x = Math.hypot(dx, dy);
  };
  group.rest = () => group.reach(to_m[0], to_m[1]);
  group.rest();
  return group;
}

function drawn_by_processor(context) {
  const about = context.getExtension('WEBGL_debug_renderer_info');
  const name = about ? String(context.getParameter(about.UNMASKED_RENDERER_WEBGL)) : '';
  return /swiftshader|llvmpipe|software/i.test(name);
}

/// Without a graphics card smooth edges cost as much as all the rest, and a second context a tenth of a second.
function new_renderer() {
  const plain = new WebGLRenderer({antialias: false, powerPreference: 'low-power'});
  if (devicePixelRatio >= 1.5 || drawn_by_processor(plain.getContext())) return plain;
  plain.dispose();
  plain.forceContextLoss();
  return new WebGLRenderer({antialias: true, powerPreference: 'low-power'});
}

export class RobotView {
  constructor(node, folder, description) {
    this.node = node;
    this.folder = folder;
    this.description = description;
    this.scene = new Scene();
    this.scene.background = new Color(0x0a0e17);
    this.renderer = new_renderer();
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 1.5));
    this.renderer.domElement.setAttribute('aria-label', 'the robot in 3D');
    node.appendChild(this.renderer.domElement);
    this.camera = new PerspectiveCamera(34, 1, 0.02, 10);
    this.camera.up.set(0, 0, 1);
    this.camera.position.fromArray(description.camera.from_m);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.target.fromArray(description.camera.to_m);
    this.controls.maxDistance = 3;
    this.controls.minDistance = 0.15;
    this.controls.maxPolarAngle = Math.PI / 2 - 0.02;
    this.controls.addEventListener('change', () => this.draw_soon());
    this.controls.update();
    this.robots = [];
    this.springs = [];
    this.show = {ghost: true, trail: true, force: true};
    this.frames = 0;
    this.light();
    this.make_traces();
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(node);
    this.listen();
  }

  async load() {
    const {description} = this;
    const texts = await Promise.all(description.robots.map(async ({urdf}) => (await asset(`${this.folder}/${urdf}`)).text()));
    for (const [i, one] of description.robots.entries()) {
      const entry = {...one, body: parsed_urdf(texts[i]), rings: {}, last: {}};
      dress(entry.body, false);
      entry.rings = rings_of(entry.body);
      // Unseen until the first telemetry says how it stands.
      entry.body.visible = false;
      entry.body.position.fromArray(one.at_m ?? [0, 0, 0]);
      this.scene.add(entry.body);
      if (one.ghost) {
        entry.shadow = parsed_urdf(texts[i]);
        dress(entry.shadow, true);
        entry.shadow.visible = false;
        entry.shadow.position.copy(entry.body.position);
        this.scene.add(entry.shadow);
      }
      this.robots.push(entry);
    }
    if (description.contour) this.scene.add(contour_mesh(description.contour));
    this.springs = (description.springs ?? []).map((spring) => spring_mesh(spring, description.plane_z_m));
    this.scene.add(...this.springs);
    this.resize();
    this.update();
  }

  light() {
    this.scene.add(new HemisphereLight(0xdfe8ff, 0x1a2030, 1.5), new AmbientLight(0xffffff, 0.25));
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(0.6, -0.8, 1.4);
    this.scene.add(sun);
    const grid = new GridHelper(1.6, 32, 0x2a3a58, 0x182136);
    grid.rotation.x = Math.PI / 2;
    grid.position.set(0.2, 0.05, -0.001);
    this.scene.add(grid);
  }

  make_traces() {
    this.force = new ArrowHelper(new Vector3(-1, 0, 0), new Vector3(), 0.1, 0xff5f5f, 0.022, 0.014);
    this.force.visible = false;
    this.scene.add(this.force);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(3 * trail_points), 3));
    geometry.setDrawRange(0, 0);
    this.trail = new Line(geometry, new LineBasicMaterial({color: 0x41d18f, transparent: true, opacity: 0.55}));
    this.trail.frustumCulled = false;
    this.trail_list = [];
    this.scene.add(this.trail);
  }

  resize() {
    const width = this.node.clientWidth, height = this.node.clientHeight;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // The robot keeps its size in a narrow panel.
    this.camera.fov = this.camera.aspect < 1.4 ? 34 * 1.4 / this.camera.aspect : 34;
    this.camera.updateProjectionMatrix();
    this.draw_soon();
  }

  /// Takes the newest joints; draws when something moved.
  update() {
    let moved = false;
    for (const robot of this.robots) {
      moved = this.pose(robot, robot.body, robot.joints, 'body') || moved;
      if (robot.shadow) moved = this.pose(robot, robot.shadow, robot.ghost, 'shadow') || moved;
      if (robot.shadow && !this.show.ghost) robot.shadow.visible = false;
      if (moved && robot.tip) this.follow_tip(robot);
    }
    if (moved) {
      this.stretch();
      this.draw_soon();
    }
  }

  pose(robot, body, joints, which) {
    let moved = false;
    for (const [joint, parameter] of Object.entries(joints)) {
      const angle = values.get(parameter)?.v;
      if (!Number.isFinite(angle)) continue;
      const key = `${which}/${joint}`;
      if (Math.abs((robot.last[key] ?? Infinity) - angle) < moved_rad) continue;
      robot.last[key] = angle;
      body.visible = true;
      body.joints[joint].ignoreLimits = true;
      body.setJointValue(joint, angle);
      if (which === 'body') this.colour(robot, joint, angle);
      moved = true;
    }
    return moved;
  }

  colour(robot, joint, angle) {
    const ring = robot.rings[joint];
    const {lower, upper} = robot.body.joints[joint].limit;
    if (!ring || !(upper > lower)) return;
    const left = Math.min(angle - lower, upper - angle);
    ring.material.color.copy(left < 0.005 ? colour_at : left < near_limit * (upper - lower) ? colour_near : colour_ok);
  }

  follow_tip(robot) {
    robot.body.updateMatrixWorld(true);
    const tip = new Vector3();
    robot.body.links[robot.tip].getWorldPosition(tip);
    this.tip = tip;
    const last = this.trail_list[this.trail_list.length - 1];
    if (!last || last.distanceToSquared(tip) > 1e-7) {
      this.trail_list.push(tip.clone());
      if (this.trail_list.length > trail_points) this.trail_list.shift();
      const position = this.trail.geometry.attributes.position;
      this.trail_list.forEach((point, i) => position.setXYZ(i, point.x, point.y, point.z));
      position.needsUpdate = true;
      this.trail.geometry.setDrawRange(0, this.trail_list.length);
    }
    this.trail.visible = this.show.trail;
    const hooked = values.get(this.description.hooked)?.v ?? 0;
    this.springs.forEach((spring, i) => hooked === i + 1 ? spring.reach(tip.x, tip.y) : spring.rest());
    const [fx, fy] = (robot.force ?? []).map((name) => values.get(name)?.v ?? 0);
    const size = Math.hypot(fx, fy);
    this.force.visible = this.show.force && size > 0.5;
    if (this.force.visible) {
      const length = Math.min(0.35, Math.max(0.03, size * robot.metres_per_newton));
      this.force.position.copy(tip);
      this.force.setDirection(new Vector3(fx / size, fy / size, 0));
      this.force.setLength(length, 0.022, 0.014);
    }
  }

  draw_soon() {
    if (this.resting) this.wanted_again = true;
    else this.waiting ||= requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.waiting = 0;
    ++this.frames;
    this.node.dataset.frames = this.frames;
    const began_ms = performance.now();
    this.renderer.render(this.scene, this.camera);
    // Told when the browser is through with the picture: without a graphics card the page waits until the processor has drawn it.
    this.resting = true;
    const through = new MessageChannel();
    through.port1.onmessage = () => {
      through.port1.close();
      this.rest(performance.now() - began_ms);
    };
    through.port2.postMessage(null);
  }

  /// For half as long as a picture took, the page is everybody else's: no slow computer keeps an operator from the rest of it.
  rest(took_ms) {
    if (this.closed) return;
    this.pause = setTimeout(() => {
      this.resting = false;
      if (!this.wanted_again) return;
      this.wanted_again = false;
      this.draw_soon();
    }, took_ms < quick_ms ? 0 : took_ms / 2);
  }

  forget() {
    if (this.trail_list) this.trail_list.length = 0;
    this.trail?.geometry.setDrawRange(0, 0);
  }

  // The visitor's mouse leads the operator's hand, by the handle or by the fingertip. What counts is how far it went since the grab,
  // wherever on the part that was.
  listen() {
    const canvas = this.renderer.domElement;
    this.ray = new Raycaster();
    this.band = new Line(new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(6), 3)),
      new LineBasicMaterial({color: 0xb9a2ff, depthTest: false}));
    this.band.frustumCulled = false;
    this.band.visible = false;
    this.band.renderOrder = 2;
    this.scene.add(this.band);
    canvas.addEventListener('pointerdown', (event) => {
      const grip = this.grip_at(event);
      if (!grip) return;
      event.stopImmediatePropagation();
      this.dragging = grip;
      this.controls.enabled = false;
      canvas.style.cursor = 'grabbing';
      canvas.setPointerCapture(event.pointerId);
    }, {capture: true});
    canvas.addEventListener('pointermove', (event) => {
      if (this.dragging) this.drag(event);
      else canvas.style.cursor = event.buttons === 0 && this.grip_at(event) ? 'grab' : '';
    });
    const end = () => {
      if (!this.dragging) return;
      this.dragging = null;
      this.band.visible = false;
      canvas.style.cursor = '';
      this.controls.enabled = true;
      this.lead([0, 0], true);
      this.draw_soon();
    };
    canvas.addEventListener('pointerup', end);
    canvas.addEventListener('pointercancel', end);
  }

  aim(event) {
    const box = this.renderer.domElement.getBoundingClientRect();
    this.ray.setFromCamera(new Vector2((event.clientX - box.left) / box.width * 2 - 1,
      1 - (event.clientY - box.top) / box.height * 2), this.camera);
  }

  /// What is under the pointer and can be led: where it was touched, in its own and in the world's frame, and how the handle stood.
  grip_at(event) {
    if (!this.description.hand || replay.value || !this.hand_allowed) return null;
    this.aim(event);
    for (const robot of this.robots) {
      const what = robot.handle ? 'handle' : robot.tip ? 'tip' : null;
      if (!what) continue;
      const link = robot.body.links[robot[what]];
      // Once for each picture, not for each move of a mouse.
      if (robot.grip_of !== this.frames) {
        robot.grip_of = this.frames;
        robot.grip = new Box3().setFromObject(link).expandByScalar(what === 'tip' ? 0.012 : 0.004);
      }
      const box = robot.grip;
      const touched = this.ray.ray.intersectBox(box, new Vector3());
      if (!touched) continue;
      return {what, robot, link, held: link.worldToLocal(touched.clone()), from: touched, angles: this.handle_angles()};
    }
    return null;
  }

  drag(event) {
    this.aim(event);
    const {what, robot, from, angles} = this.dragging;
    const at = new Vector3();
    if (!this.ray.ray.intersectPlane(new Plane(new Vector3(0, 0, 1), -from.z), at)) return;
    const {hand, contour} = this.description;
    this.dragging.at = at;
    let turned;
    if (what === 'tip') {
      const {tip} = this;
      this.dragging.tip ??= tip.clone();
      const start = this.dragging.tip;
      const [x, y] = before_wall(contour, [start.x + at.x - from.x, start.y + at.y - from.y]);
      turned = angles_of_offset(hand, [x - start.x, y - start.y]);
    } else {
      const pivot = robot.body.position;
      const angle = (x) => Math.atan2(x, lever_m);
      turned = [angle(at.x - pivot.x) - angle(from.x - pivot.x), angle(at.y - pivot.y) - angle(from.y - pivot.y)];
    }
    this.lead(within_range(hand, [angles[0] + turned[0], angles[1] + turned[1]]));
    this.stretch();
  }

  /// The band from what is held to the pointer: the hand goes slower than a mouse, and gives way at the rail.
  stretch() {
    if (!this.dragging?.at) return;
    const {link, held, at} = this.dragging;
    const from = link.localToWorld(held.clone());
    this.band.visible = from.distanceTo(at) > band_from_m;
    const position = this.band.geometry.attributes.position;
    position.setXYZ(0, from.x, from.y, from.z);
    position.setXYZ(1, at.x, at.y, at.z);
    position.needsUpdate = true;
    this.draw_soon();
  }

  /// At most one line in 60 ms, the last one always.
  lead(angles, now = false) {
    this.wanted = angles;
    const send = () => {
      this.hand_timer = 0;
      if (!this.wanted) return;
      fault(this.description.hand.device, target_line(this.wanted), {quiet: true}).catch(() => {});
      this.wanted = null;
    };
    if (now) {
      clearTimeout(this.hand_timer);
      return send();
    }
    this.hand_timer ||= setTimeout(send, hand_period_ms);
  }

  /// How the handle stands, as measured.
  handle_angles() {
    const handle = this.robots.find((robot) => robot.handle);
    return Object.values(handle?.joints ?? {x: '', y: ''}).map((name) => values.get(name)?.v ?? 0);
  }

  view_from(from_m) {
    this.camera.position.fromArray(from_m);
    this.controls.target.fromArray(this.description.camera.to_m);
    this.controls.update();
    this.draw_soon();
  }

  close() {
    cancelAnimationFrame(this.waiting);
    clearTimeout(this.pause);
    this.closed = true;
    this.observer.disconnect();
    this.controls.dispose();
    this.scene.traverse((part) => {
      part.geometry?.dispose();
      part.material?.dispose?.();
    });
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.renderer.domElement.remove();
  }
}
