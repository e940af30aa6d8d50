// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The robot in 3D: where it is in orbit, what it touches, where it shall go. Draws only while a joint or the camera moves. With a graphics
// card all of it at each frame; a processor that draws by itself draws what stands still once for a camera, as a picture behind a transparent
// one of what moves. A chunk of its own: three.js is loaded by the views that show it. Realtime: none.
import {ACESFilmicToneMapping, Color, MeshBasicMaterial, PCFShadowMap, PerspectiveCamera, Scene, Vector2, Vector3, WebGLRenderer} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import {asset} from '../api.js';
import {fixed_text, state_text} from '../format.js';
import {mission_code} from '../mission_files.js';
import {state_name} from '../commanding.js';
import {commands, mission, replay, status_of, values} from '../store.js';
import {Goal, goal_of} from '../scene/goal.js';
import {Grips} from '../scene/grips.js';
import {Arrow, colours, contact_ring, Ribbon} from '../scene/instruments.js';
import {Kit, merged} from '../scene/kit.js';
import {affordable, RobotModel} from '../scene/robot_model.js';
import {cast_on_plane} from '../scene/skins.js';
import {environment, lights, mirrored_cube, sky, sun_from} from '../scene/space.js';
import {StillPicture} from '../scene/still.js';
import {Tags} from '../scene/tags.js';
import {module_of, module_places, usual_surroundings} from '../scene/usual.js';
import {surface_x_m} from './hand.js';
import {typed} from './typed.js';

const quick_ms = 10, software_period_ms = 47, calm_period_ms = 250, tick_ms = 1000 / 60;
/// Who asks his system for less motion gets four pictures a second.
const calm = matchMedia('(prefers-reduced-motion: reduce)');
const trail_points = 300, trail_step_m2 = 4e-6;
const least_force_n = 0.5;
const words_ms = 200, still_after_ms = 250;
const most_angles = 3;

function drawn_by_processor(context) {
  const about = context.getExtension('WEBGL_debug_renderer_info');
  const name = about ? String(context.getParameter(about.UNMASKED_RENDERER_WEBGL)) : '';
  return /swiftshader|llvmpipe|software/i.test(name);
}

/// Without a graphics card smooth edges cost as much as all the rest, and a second context a tenth of a second.
function new_renderer() {
  const first = new WebGLRenderer({antialias: false, alpha: true, powerPreference: 'high-performance'});
  if (drawn_by_processor(first.getContext())) return [first, true];
  first.dispose();
  first.forceContextLoss();
  return [new WebGLRenderer({antialias: true, powerPreference: 'high-performance'}), false];
}

export class RobotView {
  /// `nodes`: {stage, still, tags, leads, window}: where it draws, the canvas behind, what lies above; `window` may be missing.
  constructor(nodes, folder, description) {
    Object.assign(this, {nodes, folder, description, robots: [], springs: [], frames: 0, show: {goal: true, limits: true, force: true, trail: true, frames: false}});
    [this.renderer, this.software] = new_renderer();
    const {renderer} = this;
    renderer.toneMapping = ACESFilmicToneMapping;
    renderer.setPixelRatio(this.software ? 1 : Math.min(devicePixelRatio, 2));
    renderer.shadowMap.enabled = !this.software;
    renderer.shadowMap.type = PCFShadowMap;
    renderer.autoClear = false;
    this.canvas = renderer.domElement;
    this.canvas.setAttribute('aria-label', 'the robot in 3D');
    nodes.stage.appendChild(this.canvas);
    nodes.stage.dataset.tier = this.software ? 'software' : 'graphics card';
    this.scene = new Scene();
    this.far = this.software ? new Scene() : this.scene;
    if (!this.software) this.scene.background = new Color(0x04060a);
    this.still = this.software ? new StillPicture(renderer, this.far, nodes.still) : null;
    const {camera} = description;
    this.scale = new Vector3().fromArray(camera.from_m).distanceTo(new Vector3().fromArray(camera.to_m));
    // Lines are as thick as seen from a metre away.
    this.thick = this.scale > 0.75 ? Math.max(1, Math.round(this.scale)) : this.scale;
    this.camera = new PerspectiveCamera(camera.fov_deg ?? 34, 1, 0.05 * this.scale, 900 * this.scale);
    this.camera.up.set(0, 0, 1);
    this.camera.position.fromArray(camera.from_m);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.target.fromArray(camera.to_m);
    Object.assign(this.controls, {maxDistance: 4 * this.scale, minDistance: 0.15 * this.scale, maxPolarAngle: Math.PI / 2 - 0.02, zoomToCursor: true});
    this.controls.addEventListener('change', () => this.camera_moved());
    this.controls.update();
    this.size = new Vector2();
    this.make_inset();
    this.make_instruments();
    this.grips = new Grips(this);
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(nodes.stage);
    this.values = values;
  }

  make_inset() {
    const {inset} = this.description;
    if (!inset || !this.nodes.window) return;
    this.inset = {scene: new Scene(), camera: new PerspectiveCamera(28, 1, 0.02, 5), box: {left: 0, top: 0, width: 0, height: 0}};
    this.inset.camera.up.set(0, 0, 1);
    this.inset.camera.position.fromArray(inset.from_m);
    this.inset.camera.lookAt(...inset.to_m);
    this.inset.scene.add(...lights({target: new Vector3(), reach_m: 0.3, shadow: false}));
    this.felt = new Arrow(colours.felt, 0.0036);
    this.inset.scene.add(this.felt.group);
  }

  make_instruments() {
    this.force = new Arrow(colours.touched, 0.0046);
    this.contact = contact_ring(1);
    this.trail = new Ribbon(trail_points, 0.0022 * this.thick);
    this.scene.add(this.force.group, this.contact, this.trail.mesh);
    const target = new Vector3().fromArray(this.description.camera.to_m);
    this.scene.add(...lights({target, reach_m: 0.62 * this.scale, shadow: !this.software}));
  }

  async load() {
    const {description} = this;
    const [own, ...texts] = await Promise.all([description.parts ? mission_code(description.parts) : {}, ...description.robots.map(async ({urdf}) => (await asset(`${this.folder}/${urdf}`)).text())]);
    this.own = own;
    this.mirror = this.software ? null : environment(this.renderer, 128);
    const kit = new Kit(this.mirror, this.software ? 0.42 : 1);
    this.tags = new Tags(this.nodes.tags, this.nodes.leads);
    for (const [i, about] of description.robots.entries()) {
      const parts = () => own.links?.[about.urdf]?.(kit) ?? {};
      const robot = new RobotModel(about, texts[i], parts(), {environment: this.mirror, software: this.software});
      robot.make_goal = about.goal ? () => new Goal(robot, texts[i], parts(), {scale: this.thick, contour: description.contour}) : null;
      robot.angle_tags = about.inset ? [] : robot.names.map((name) => this.tags.add('', `${about.names?.[name] ?? name} `, robot.body.joints[name].jointType === 'prismatic' ? 'm' : 'rad'));
      if (robot.tip) robot.tip_tag = this.tags.add('', 'tip ', 'mm');
      if (about.goal) robot.goal_tag = this.tags.add('goal', 'goal ', '');
      if (about.force) robot.force_tag = this.tags.add('touched', Object.assign(document.createElement('span'), {className: 'unseen', textContent: 'force '}), 'N');
      this.nodes.stage.dataset.bones = robot.bones + Number(this.nodes.stage.dataset.bones ?? 0);
      this.scene_of(robot).add(robot.body);
      if (this.software && !about.inset) cast_on_plane(robot.body, sun_from, 0.0006);
      this.robots.push(robot);
    }
    if (own.obstacles) {
      this.obstacles = merged(own.obstacles(kit, {...description, surface_x_m}));
      this.obstacles.traverse((part) => { if (part.isMesh) part.castShadow = part.receiveShadow = true; });
      this.scene.add(this.obstacles);
    }
    for (const spring of description.springs ?? []) this.add_spring(kit, spring);
    if (this.software) this.obstacles?.traverse((part) => { if (part.isMesh) part.material = affordable(part.material, true); });
    this.resize();
    this.update();
    this.add_surroundings_later();
  }

  add_spring(kit, {from_m, to_m}) {
    const coil = kit.coil(9, 0.0048, 0.0009, affordable(kit.material.steel, this.software));
    coil.position.set(from_m[0], from_m[1], this.description.plane_z_m);
    const reach = (x, y) => {
      coil.rotation.z = Math.atan2(y - from_m[1], x - from_m[0]);
      coil.scale.x = Math.hypot(x - from_m[0], y - from_m[1]);
    };
    const spring = {reach, rest: () => reach(to_m[0], to_m[1])};
    spring.rest();
    this.springs.push(spring);
    this.scene.add(coil);
  }

  /// The robot moves first; what is around it takes a second to make without a graphics card.
  add_surroundings_later() {
    const later = globalThis.requestIdleCallback ?? ((then) => setTimeout(then, 50));
    const steps = [
      () => this.far.add(...sky(this.scale), ...(this.software ? lights({target: this.controls.target, reach_m: 0.62 * this.scale, shadow: false}) : [])),
      () => {
        const kit = new Kit(this.software ? mirrored_cube() : this.mirror, this.software ? 0.7 : 1), around = this.own.surroundings?.(kit) ?? usual_surroundings(kit, this.robots.length > 0);
        if (this.description.modules) this.add_modules(kit, around);
        around.traverse((part) => { if (part.isMesh) part.castShadow = part.receiveShadow = !this.software; });
        this.far.add(around);
        if (this.software && this.own.obstacles) this.far.add(merged(this.own.obstacles(kit, {...this.description, surface_x_m})));
        if (this.software) this.hide_behind_obstacles();
      },
      () => this.still?.grown(),
    ];
    const next = () => {
      if (this.closed) return;
      steps.shift()();
      this.draw_soon();
      if (steps.length) later(next, {timeout: 300});
      else this.nodes.stage.dataset.surroundings = 'yes';
    };
    later(next, {timeout: 500});
  }

  /// A module for each subsystem: its name and state stand at it, its lamp tells whether it deviates.
  add_modules(kit, around) {
    const names = (mission.value?.subsystems ?? []).map((one) => one.name);
    this.modules = module_places(names.length).map(([x, y, wide], i) => {
      const {group, lamp, top} = module_of(kit, wide);
      group.position.set(x, y, -0.02);
      around.add(group);
      return {name: names[i], lamp, at: new Vector3(x, y, top + 0.02), tag: this.tags.add('', '', ''), told: ''};
    });
    this.look_at_modules();
  }

  look_at_modules() {
    for (const module of this.modules ?? []) {
      const now = status_of(module.name), state = state_name(now?.state), told = `${state} ${now?.inhibited?.length ?? 0}`;
      this.tags.tell(module.tag, module.name.slice(0, 24), {unit: state_text(state)});
      if (told === module.told) continue;
      module.told = told;
      module.lamp.material.color.set(state === 'ErrorOperational' || now?.inhibited?.length ? colours.wrong : state === 'Operational' ? colours.measured : 0x4b535e);
      this.still?.ask();
      this.draw_soon();
    }
  }

  /// What the still picture shows hides the robot where it stands before it.
  hide_behind_obstacles() {
    const hidden = new MeshBasicMaterial({colorWrite: false});
    this.obstacles?.traverse((part) => {
      if (!part.isMesh) return;
      part.material = hidden;
      part.renderOrder = -3;
    });
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.nodes.stage;
    if (!width || !height) return;
    this.size.set(width, height);
    this.renderer.setSize(width, height, false);
    const fov = this.description.camera.fov_deg ?? 34;
    this.camera.aspect = width / height;
    // The robot keeps its size in a narrow panel.
    this.camera.fov = this.camera.aspect < 1.4 ? fov * 1.4 / this.camera.aspect : fov;
    this.camera.updateProjectionMatrix();
    if (this.inset) {
      const stage = this.nodes.stage.getBoundingClientRect(), box = this.nodes.window.getBoundingClientRect();
      this.inset.box = {left: box.left - stage.left, top: box.top - stage.top, width: box.width, height: box.height};
      this.inset.camera.aspect = box.width / Math.max(1, box.height);
      this.inset.camera.updateProjectionMatrix();
    }
    this.camera_moved(true);
  }

  camera_moved(at_once = false) {
    this.moved_at = at_once ? -Infinity : performance.now();
    this.still?.ask();
    this.trail_turned = true;
    this.draw_soon();
    if (at_once) return;
    clearTimeout(this.still_timer);
    this.still_timer = setTimeout(() => this.draw_soon(), still_after_ms);
  }

  scene_of(robot) { return robot.about.inset && this.inset ? this.inset.scene : this.scene; }
  may() { return !replay.value && this.hand_allowed; }

  /// Takes the newest joints; draws when something moved.
  update() {
    const now_ms = performance.now();
    for (const robot of this.robots) robot.take(values, now_ms);
    const forces = this.robots.map((robot) => (robot.about.force ?? []).map((name) => values.get(name)?.v)).flat();
    const changed = forces.some((value, i) => Math.abs(value - (this.forces?.[i] ?? Infinity)) > 0.05);
    if (changed) this.forces = forces;
    if (changed || this.robots.some((robot) => robot.motion.moving() || !robot.body.visible)) this.draw_soon();
  }

  /// Once the words beside may have changed: who is stopped, what is typed.
  look_again(stopped) {
    for (const robot of this.robots) robot.halo.shown = stopped.includes(robot.about.subsystem);
    this.look_at_modules();
    this.draw_soon();
  }

  follow_force(robot) {
    const [x, y, z = 0] = (robot.about.force ?? []).map((name) => values.get(name)?.v ?? 0), size = Math.hypot(x, y, z);
    robot.force_n = size;
    const shown = this.show.force && size > least_force_n && robot.body.visible;
    this.force.group.visible = this.contact.visible = shown;
    if (!shown) return;
    const along = new Vector3(x, y, z).divideScalar(size), length = Math.min(0.35, Math.max(0.03, size * robot.about.metres_per_newton));
    const from = robot.tip.clone().addScaledVector(along, 0.006);
    this.force.point(from, along, length);
    robot.force_end = from.addScaledVector(along, length);
    this.contact.position.copy(robot.tip).addScaledVector(along, -0.0095);
    this.contact.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), along);
  }

  follow_tip(robot, moved) {
    const last = this.trail.points.at(-1);
    if (moved && (!last || last.at.distanceToSquared(robot.tip) > trail_step_m2)) {
      this.trail.add(robot.tip, robot.force_n > least_force_n ? colours.touched : 0xdfe5ee);
      this.trail_turned = true;
    }
    if (this.trail_turned) this.trail.lay(this.camera, (i, count) => 0.85 * (i / count) ** 1.6);
    this.trail_turned = false;
    this.trail.mesh.visible = this.show.trail;
    const hooked = values.get(this.description.hooked)?.v ?? 0;
    this.springs.forEach((spring, i) => hooked === i + 1 ? spring.reach(robot.tip.x, robot.tip.y) : spring.rest());
  }

  follow_goal(robot) {
    const wanted = this.show.goal ? goal_of(robot.about, typed.value, commands.value) : null;
    if (!wanted && !robot.goal) return;
    if (!robot.goal) {
      robot.goal = robot.make_goal();
      this.scene.add(robot.goal.group);
    }
    robot.goal_told = robot.goal.show(wanted, this.camera);
    robot.goal_wanted = wanted;
  }

  follow_stick(robot) {
    if (!this.felt || !robot.about.torque) return;
    const [x, y] = robot.about.torque.map((name) => values.get(name)?.v ?? 0), size = Math.hypot(x, y);
    this.felt.group.visible = this.show.force && size > 0.004;
    if (this.felt.group.visible) this.felt.point(new Vector3(0, 0, 0.19), new Vector3(x / size, y / size, 0), Math.min(0.1, 0.03 + 0.5 * size));
  }

  draw_soon() {
    if (this.closed) return;
    if (this.resting) this.wanted_again = true;
    else this.waiting ||= requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.waiting = 0;
    const began_ms = performance.now();
    let moved = false;
    for (const robot of this.robots) {
      const posed = robot.pose(began_ms);
      moved = posed || moved;
      robot.show_limits(this.show.limits);
      if (robot.frame) robot.frame.visible = this.show.frames || !robot.about.inset && this.show.limits;
      if (!robot.tip || !robot.body.visible) { this.follow_stick(robot); continue; }
      this.follow_force(robot);
      this.follow_tip(robot, posed);
      if (robot.make_goal) this.follow_goal(robot);
    }
    this.grips.stretch();
    ++this.frames;
    this.nodes.stage.dataset.frames = this.frames;
    this.nodes.stage.dataset.moving = this.robots.some((robot) => robot.motion.moving()) ? 'yes' : 'no';
    this.nodes.stage.dataset.pose = this.robots.map((robot) => robot.last.map((angle) => angle?.toFixed(6))).join();
    let more = this.still?.draw(this.camera, this.size, began_ms - this.moved_at < still_after_ms - 20) ?? false;
    this.period_ms = calm.matches && !more ? calm_period_ms : this.software ? software_period_ms : 0;
    if (this.still?.whole && !this.still.wanted) this.nodes.stage.dataset.still = 'whole';
    this.draw_live();
    this.lay_tags(began_ms);
    if (this.robots.some((robot) => robot.motion.moving())) more = true;
    // Told when the browser is through with the picture: without a graphics card the page waits until the processor has drawn it.
    this.resting = true;
    const through = new MessageChannel();
    through.port1.onmessage = () => {
      through.port1.close();
      this.rest(performance.now() - began_ms);
    };
    through.port2.postMessage(null);
    if (more) this.draw_soon();
  }

  draw_live() {
    const {renderer, inset} = this, {x: width, y: height} = this.size;
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, width, height);
    renderer.setClearColor(0, this.software ? 0 : 1);
    renderer.clear();
    renderer.render(this.scene, this.camera);
    if (!inset || !inset.box.width) return;
    const {left, top, width: wide, height: tall} = inset.box, bottom = height - top - tall;
    renderer.setScissorTest(true);
    renderer.setScissor(left, bottom, wide, tall);
    renderer.setViewport(left, bottom, wide, tall);
    renderer.setClearColor(0x14171b, 1);
    renderer.clear();
    renderer.render(inset.scene, inset.camera);
    renderer.setScissorTest(false);
  }

  /// For half as long as a picture took, the page is everybody else's, and without a graphics card half of a processor is.
  rest(took_ms) {
    if (this.closed) return;
    const pause_ms = this.period_ms ? this.pause_to_period(took_ms) : took_ms < quick_ms ? 0 : took_ms / 2;
    this.pause = setTimeout(() => {
      this.resting = false;
      if (!this.wanted_again) return;
      this.wanted_again = false;
      this.draw_soon();
    }, pause_ms);
  }

  /// A browser begins a picture at its next tick only, half a tick after a pause in the mean: without that in the count, pictures of
  /// 47 ms would come each 50 or 66. What one came late, the next one comes earlier.
  pause_to_period(took_ms) {
    const now_ms = performance.now();
    const {period_ms} = this;
    this.due_ms = Math.max(now_ms + took_ms / 2, (this.due_ms ?? now_ms) + period_ms);
    if (this.due_ms > now_ms + period_ms) this.due_ms = now_ms + Math.max(took_ms / 2, period_ms - took_ms);
    return Math.max(0, this.due_ms - now_ms - tick_ms / 2);
  }

  at_px(point) {
    const seen = point.clone().project(this.camera);
    return seen.z > 1 ? null : [(seen.x + 1) / 2 * this.size.x, (1 - seen.y) / 2 * this.size.y];
  }

  lay_tags(now_ms) {
    if (!this.tags) return;
    const telling = now_ms - (this.told_ms ?? -Infinity) > words_ms;
    if (telling) this.told_ms = now_ms;
    for (const robot of this.robots) {
      const {body} = robot, seen = body.visible, stale = this.stale ?? false;
      robot.angle_tags.forEach((tag, i) => {
        tag.at = this.at_px(body.joints[robot.names[i]].getWorldPosition(new Vector3()));
        if (telling) this.tags.tell(tag, fixed_text(robot.last[i], 3), {shown: seen, stale});
      });
      if (robot.tip_tag) {
        robot.tip_tag.at = this.at_px(robot.tip);
        // A robot that works in a plane says where in it.
        const {x, y, z} = robot.tip, place = this.description.plane_z_m === undefined ? [x, y, z] : [x, y];
        if (telling) this.tags.tell(robot.tip_tag, place.map((metres) => fixed_text(metres * 1000, 1)).join(', '), {shown: seen, stale});
      }
      if (robot.goal_tag) {
        const told = robot.goal_wanted ? robot.goal_told : null;
        robot.goal_tag.at = told?.tip ? this.at_px(told.tip) : null;
        if (telling || !told) {
          const angles = told ? Object.values(robot.goal_wanted.angles) : [];
          // More of them would be wider than the picture; the form has them.
          const words = angles.length > most_angles ? `${angles.length} joints` : angles.map((angle) => fixed_text(angle, 3)).join(', ');
          this.tags.tell(robot.goal_tag, words, {shown: Boolean(told), look: told?.wrong ? 'wrong' : 'goal', unit: told ? told.wrong || told.pace : ''});
        }
      }
      if (robot.force_tag) {
        const pressing = (robot.force_n ?? 0) > least_force_n && this.show.force;
        robot.force_tag.at = pressing && robot.force_end ? this.at_px(robot.force_end) : null;
        if (telling) this.tags.tell(robot.force_tag, fixed_text(robot.force_n ?? 0, 1), {shown: pressing && seen, stale});
      }
    }
    for (const module of this.modules ?? []) module.tag.at = this.at_px(module.at);
    this.tags.lay(this.size.x, this.size.y, this.taken ?? [], telling);
    clearTimeout(this.words_timer);
    // The last words are told also when nothing moves any more.
    if (!telling) this.words_timer = setTimeout(() => this.draw_soon(), words_ms);
  }

  is_in_inset(event) {
    if (!this.inset) return false;
    const stage = this.canvas.getBoundingClientRect(), {left, top, width, height} = this.inset.box;
    const x = event.clientX - stage.left - left, y = event.clientY - stage.top - top;
    return x >= 0 && y >= 0 && x <= width && y <= height;
  }

  /// Where a pointer is in the picture of one camera: [x, y, camera], both from -1 to 1.
  eye_at(event, inset) {
    const stage = this.canvas.getBoundingClientRect(), box = inset ? this.inset.box : {left: 0, top: 0, width: stage.width, height: stage.height};
    return [(event.clientX - stage.left - box.left) / box.width * 2 - 1, 1 - (event.clientY - stage.top - box.top) / box.height * 2, inset ? this.inset.camera : this.camera];
  }

  forget() {
    this.trail?.clear();
    for (const robot of this.robots) robot.motion.forget();
  }

  /// From above, x to the right; or from where the mission looks.
  view_from(from_m, to_m = this.description.camera.to_m) {
    this.camera.position.fromArray(from_m);
    this.controls.target.fromArray(to_m);
    // Straight above, the azimuth of before would turn the picture.
    if (Math.hypot(from_m[0] - to_m[0], from_m[1] - to_m[1]) < 0.05 * this.scale) this.camera.position.set(to_m[0], to_m[1] - 1e-3, from_m[2]);
    this.controls.update();
    this.camera_moved(true);
  }

  view_tip() {
    const robot = this.robots.find((one) => one.tip), from = this.description.camera.tip_from_m;
    if (robot?.body.visible && from) this.view_from(new Vector3().fromArray(from).sub(new Vector3().fromArray(this.description.camera.to_m)).add(robot.tip).toArray(), robot.tip.toArray());
  }

  close() {
    cancelAnimationFrame(this.waiting);
    clearTimeout(this.pause);
    clearTimeout(this.still_timer);
    clearTimeout(this.words_timer);
    this.closed = true;
    this.observer.disconnect();
    this.controls.dispose();
    for (const scene of new Set([this.scene, this.far, this.inset?.scene])) {
      scene?.traverse((part) => {
        part.geometry?.dispose();
        for (const material of [part.material].flat()) material?.dispose?.();
      });
    }
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.canvas.remove();
    this.nodes.tags.replaceChildren();
    this.nodes.leads.replaceChildren();
  }
}
