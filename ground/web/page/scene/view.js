// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The robot in 3D: where it is in orbit, what it touches, where it shall go. Draws only while a joint or the camera moves. With a graphics
// card all of it at each frame; a processor that draws by itself draws what moves (live.js) before a picture of what stands still, which is drawn
// once for a camera. It is made once: a view that is left leaves it behind, and finds it as it was. A chunk of its own: three.js is loaded by
// the views that show it. Realtime: none.
import {Color, Scene, Vector2, Vector3} from 'three';
import {clock_text, iso_text} from '../format.js';
import {mission_code, mission_text} from '../mission_files.js';
import {columns, mission, now_s, replay, values, with_picture} from '../store.js';
import {Surroundings} from './around.js';
import {Contact} from './contact.js';
import {Goal, show_goal} from './goal.js';
import {Grips} from './grips.js';
import {Inset} from './inset.js';
import {Kit, merged} from './kit.js';
import {LivePicture, live_canvas} from './live.js';
import {Pace} from './pace.js';
import {Picker} from './pick.js';
import {Readout} from './readout.js';
import {RobotModel} from './robot_model.js';
import {Sight} from './sight.js';
import {cast_on_plane} from './skins.js';
import {snapshot_of} from './snapshot.js';
import {lights, sun_from} from './sky.js';
import {StillPicture} from './still.js';
import {watch_taken} from './taken.js';
import {ViewCube} from './view_cube.js';
import {surface_x_m} from '../parts/hand.js';
import {plots_address, plots_of_link} from '../parts/joint_plots.js';
import {open} from '../parts/opening.js';
import {save} from '../parts/save.js';
import {goal_says} from '../parts/typed.js';

const still_after_ms = 250, resized_after_ms = 200;
/// What is beside the robot waits until so many of its poses were drawn, or it has stood there for as long.
const seen_poses = 5, unmoved_ms = 400;

/// A context of WebGL, or null where the browser has none, and whether a processor draws it by itself.
function probe() {
  const context = document.createElement('canvas').getContext('webgl2', {antialias: false, powerPreference: 'high-performance'});
  const about = context?.getExtension('WEBGL_debug_renderer_info'), name = about ? String(context.getParameter(about.UNMASKED_RENDERER_WEBGL)) : '';
  return [context, !context || /swiftshader|llvmpipe|software/i.test(name)];
}
const card_code = () => import('./card.js');

export class RobotView {
  /// `nodes`: {stage, still, tags, leads, cube}: where it draws, the canvas behind, what lies above; `window`, where the inset is, comes with each view.
  constructor(nodes, description) {
    Object.assign(this, {nodes, description, robots: [], frames: 0, poses: 0, show: {goal: true, limits: true, force: true, trail: true, frames: false}});
    [this.context, this.software] = probe();
    // A graphics card draws into it; a processor does not, and it is where the mouse is all the same.
    this.canvas = document.createElement('canvas');
    this.canvas.setAttribute('aria-label', 'the robot in 3D');
    nodes.stage.appendChild(this.canvas);
    if (this.software) this.live = new LivePicture(live_canvas(nodes.stage));
    nodes.stage.dataset.tier = this.software ? 'software' : 'graphics card';
    this.scene = new Scene();
    this.far = this.software ? new Scene() : this.scene;
    if (!this.software) this.scene.background = new Color(0x04060a);
    this.still = this.software && this.context ? new StillPicture(this.far, nodes.still) : null;
    this.sight = new Sight(description.camera);
    Object.assign(this, {scale: this.sight.scale, camera: this.sight.camera});
    // Lines are as thick as seen from a metre away.
    this.thick = this.scale > 0.75 ? Math.max(1, Math.round(this.scale)) : this.scale;
    this.size = new Vector2();
    this.pace = new Pace((now_ms) => this.draw(now_ms), this.software);
    // Until it is entered.
    this.pace.close();
    this.surroundings = new Surroundings(this, card_code);
    this.readout = new Readout(this, () => this.draw_soon());
    this.inset = description.inset ? new Inset(description.inset, this.software) : null;
    const target = new Vector3().fromArray(description.camera.to_m);
    this.scene.add(...lights({target, reach_m: 0.62 * this.scale, shadow: !this.software}));
    this.contact = new Contact(this.scene, description, this.thick);
    this.sight.be_led_on(this.canvas, () => this.camera_moved());
    this.controls = this.sight.controls;
    this.cube = new ViewCube(nodes.cube, (direction) => this.look_from(direction), () => this.view_from(description.camera.from_m));
    this.grips = new Grips(this);
    this.picker = new Picker(this, (robot, link) => {
      const groups = plots_of_link(link, {about: robot.about, links: robot.body.links}, columns.value);
      if (groups.length) location.hash = plots_address(groups);
    });
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(nodes.stage);
    this.values = values;
  }

  async load() {
    const {description} = this;
    const [own, card, ...texts] = await Promise.all([description.parts ? mission_code(description.parts) : {}, this.software ? null : card_code(), ...description.robots.map(({urdf}) => mission_text(urdf))]);
    this.own = own;
    if (card) this.take_card(card.card_renderer(this.canvas));
    const kit = new Kit(this.mirror ?? null, this.software ? 0.3 : 1);
    for (const [i, about] of description.robots.entries()) {
      const parts = () => own.links?.[about.urdf]?.(kit) ?? {};
      const robot = new RobotModel(about, texts[i], parts(), {environment: this.mirror ?? null, software: this.software});
      robot.make_goal = about.goal ? () => new Goal(robot, texts[i], parts(), {scale: this.thick, contour: description.contour}) : null;
      this.readout.add_robot(robot);
      this.nodes.stage.dataset.bones = robot.bones + Number(this.nodes.stage.dataset.bones ?? 0);
      this.scene_of(robot).add(robot.body);
      robot.show_labels(!this.software);
      this.robots.push(robot);
    }
    this.kit = kit;
    if (!this.software) {
      const obstacles = merged(own.obstacles?.(kit, {...description, surface_x_m}) ?? kit.group());
      obstacles.traverse((part) => { if (part.isMesh) part.castShadow = part.receiveShadow = true; });
      this.scene.add(obstacles);
      this.finish();
    }
    this.resize();
    this.update();
    this.pace.anew();
    setTimeout(open, unmoved_ms);
    this.surroundings.begin();
  }

  take_card({renderer, mirror}) {
    // The context that was looked at has no edges that are smooth.
    this.context.getExtension('WEBGL_lose_context')?.loseContext();
    Object.assign(this, {renderer, mirror, context: null});
    // Its place may have been measured before it came.
    if (this.size.x) renderer.setSize(this.size.x, this.size.y, false);
  }

  /// What a processor that draws by itself makes after the first pictures: each kind of it takes a program of its own.
  finish() {
    for (const spring of this.description.springs ?? []) this.contact.add_spring(this.kit, spring, this.software);
    for (const robot of this.software ? this.robots : []) {
      robot.show_labels(true);
      if (!robot.about.inset) cast_on_plane(robot.body, sun_from, 0.0006);
    }
    this.finished = true;
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.nodes.stage;
    if (!width || !height) return;
    const same = this.size.x === width && this.size.y === height;
    this.size.set(width, height);
    if (!same) this.renderer?.setSize(width, height, false);
    this.sight.fit(width / height);
    const inset_same = !this.inset || !this.window || this.inset.lay(this.nodes.stage, this.window);
    // Back in its place: what stands still does so in its picture, too.
    if (same && inset_same) return this.draw_soon();
    // The picture of before is stretched meanwhile: a window that is dragged has many sizes.
    if (!this.still?.whole) return this.camera_moved(true);
    this.still.hold();
    delete this.nodes.stage.dataset.still;
    this.draw_soon();
    clearTimeout(this.size_timer);
    this.size_timer = setTimeout(() => this.camera_moved(true), resized_after_ms);
  }

  camera_moved(at_once = false) {
    this.moved_at = at_once ? -Infinity : performance.now();
    this.still?.ask();
    delete this.nodes.stage.dataset.still;
    this.contact.turned();
    this.draw_soon();
    if (at_once) return;
    clearTimeout(this.still_timer);
    this.still_timer = setTimeout(() => this.draw_soon(), still_after_ms);
  }

  scene_of(robot) { return robot.about.inset && this.inset ? this.inset.scene : this.scene; }
  may() { return !replay.value && this.hand_allowed; }
  may_set_goal() { return !replay.value && this.goal_allowed && this.show.goal; }

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
    this.modules?.look();
    this.draw_soon();
  }

  follow_stick(robot) {
    if (robot.about.torque) this.inset?.feel(robot.about.torque.map((name) => values.get(name)?.v ?? 0), this.show.force);
  }

  /// Nothing is drawn before there is something.
  draw_soon() { if (this.kit) this.pace.soon(); }

  draw(began_ms) {
    with_picture();
    let moved = false;
    for (const robot of this.robots) {
      const posed = robot.pose(began_ms);
      moved ||= posed;
      const limits = this.finished && this.show.limits;
      robot.show_limits(limits);
      if (robot.frame) robot.frame.visible = this.show.frames || !robot.about.inset && limits;
      if (!robot.tip || !robot.body.visible) { this.follow_stick(robot); continue; }
      this.contact.follow(robot, posed, this.camera, this.show);
      if (robot.make_goal) show_goal(robot, this);
    }
    this.grips.stretch();
    this.cube.follow(this.camera);
    ++this.frames;
    this.nodes.stage.dataset.frames = this.frames;
    this.nodes.stage.dataset.moving = this.robots.some((robot) => robot.motion.moving()) ? 'yes' : 'no';
    this.nodes.stage.dataset.pose = this.robots.map((robot) => robot.last.map((angle) => angle?.toFixed(6))).join();
    const unfinished = this.still?.draw(this.camera, this.size, began_ms - this.moved_at < still_after_ms - 20) ?? false;
    if (this.still?.whole && !this.still.wanted && !this.still.held) this.nodes.stage.dataset.still = 'whole';
    this.camera.updateMatrixWorld();
    this.readout.lay(began_ms);
    this.draw_live(this.readout.leads.all?.());
    const moving = this.robots.some((robot) => robot.motion.moving());
    if (moved) ++this.poses;
    if (this.poses >= seen_poses) open();
    this.surroundings.drawn(this.poses);
    return {unfinished, moving};
  }

  /// `leads` of numbers are drawn where a processor draws.
  draw_live(leads = []) {
    const {renderer, inset, live} = this, {x: width, y: height} = this.size;
    if (live) {
      live.draw(this.scene, this.camera, width, height, {leads});
      inset?.draw();
      return;
    }
    if (!renderer) return;
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, width, height);
    renderer.setClearColor(0, 1);
    renderer.clear();
    renderer.render(this.scene, this.camera);
    inset?.draw(renderer, height);
  }

  is_in_inset(event) {
    if (!this.inset) return false;
    const stage = this.canvas.getBoundingClientRect();
    return this.inset.has(event.clientX - stage.left, event.clientY - stage.top);
  }

  /// Where a pointer is in the picture of one camera: [x, y, camera], both from -1 to 1.
  eye_at(event, inset) {
    const stage = this.canvas.getBoundingClientRect(), box = inset ? this.inset.box : {left: 0, top: 0, width: stage.width, height: stage.height};
    return [(event.clientX - stage.left - box.left) / box.width * 2 - 1, 1 - (event.clientY - stage.top - box.top) / box.height * 2, inset ? this.inset.camera : this.camera];
  }

  forget() {
    this.contact.forget();
    for (const robot of this.robots) robot.motion.forget();
  }

  /// The scene alone, as a file.
  save_picture() {
    const t = now_s(), when = iso_text(t) || clock_text(t, 3), {name} = mission.value;
    snapshot_of(this, `${name}, ${when}`).toBlob((blob) => save(`${name}-${when}.png`.replaceAll(/[^\w.-]/g, '-'), blob));
  }

  /// From above, x to the right; or from where the mission looks.
  view_from(from_m) {
    this.sight.from(from_m);
    this.camera_moved(true);
  }

  /// From the side where `direction`, a unit vector, points, as far away as before.
  look_from(direction) {
    this.sight.along(direction);
    this.camera_moved(true);
  }

  view_tip() {
    const robot = this.robots.find((one) => one.tip);
    if (!robot?.body.visible || !this.description.camera.tip_from_m) return;
    this.sight.near(robot.tip);
    this.camera_moved(true);
  }

  /// Stands in the place of a view, whose picture of the hand is in `window`.
  enter(window) {
    this.window = window;
    if (window && this.inset?.canvas) window.append(this.inset.canvas);
    this.forget_taken = watch_taken(this.nodes.stage.closest('.robot'), (boxes) => {
      this.taken = boxes;
      this.draw_soon();
    });
    this.pace.open();
    this.forget();
    this.resize();
    if (this.still?.held) this.camera_moved(true);
    this.update();
  }

  /// Draws nothing until it is entered again.
  leave() {
    goal_says.value = null;
    this.pace.close();
    clearTimeout(this.still_timer);
    clearTimeout(this.size_timer);
    this.readout.close();
    this.forget_taken?.();
    this.window = null;
  }

  close() {
    this.leave();
    this.closed = true;
    this.observer.disconnect();
    this.controls.dispose();
    for (const scene of new Set([this.scene, this.far, this.inset?.scene])) {
      scene?.traverse((part) => {
        part.geometry?.dispose();
        for (const material of [part.material].flat()) material?.dispose?.();
      });
    }
    this.renderer?.dispose();
    (this.context ?? this.renderer?.getContext())?.getExtension('WEBGL_lose_context')?.loseContext();
    this.nodes.stage.replaceChildren();
    this.inset?.canvas?.remove();
    this.nodes.tags.replaceChildren();
    this.nodes.leads.replaceChildren();
    this.nodes.cube.replaceChildren();
  }
}
