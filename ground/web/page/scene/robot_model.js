// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A robot of scene.json: its URDF with the parts that the mission gives for its links, posed by telemetry, with its dials, halo and tool frame.
import {Box3, Color, CylinderGeometry, Group, Mesh, MeshStandardMaterial, Quaternion, SphereGeometry, Vector3} from 'three';
import URDFLoader from 'urdf-loader';
import {merged} from './kit.js';
import {Dial, triad} from './instruments.js';
import {Motion} from './motion.js';
import {affordable, become_hider, joined} from './plain.js';
import {reach} from './reach.js';
import {Halo} from './skins.js';

const moved_rad = 1e-5;
const dial_of_size = 0.28;

/// Numbers as they are read strictly on board, whatever blanks stand between them. What would be fetched from elsewhere is left out: a mission
/// shows no file of meshes (adr 0100).
export function parsed_urdf(text) {
  const file = new DOMParser().parseFromString(text, 'text/xml');
  for (const [name, attribute] of [['axis', 'xyz'], ['color', 'rgba']]) {
    for (const node of file.querySelectorAll(`${name}[${attribute}]`)) node.setAttribute(attribute, node.getAttribute(attribute).trim().replace(/\s+/g, ' '));
  }
  for (const node of file.querySelectorAll('texture')) node.remove();
  const loader = new URDFLoader();
  loader.parseCollision = false;
  // Who asks says last whom to tell.
  loader.loadMeshCb = (...words) => words.at(-1)(null);
  return loader.parse(file);
}

const is_mesh = (visual) => visual.urdfNode.querySelector('geometry > mesh') !== null;
const visuals_of = (link) => link.children.filter((child) => child.isURDFVisual);
const bone_share = 0.028, ball_of_bone = 1.45, end_of_bone = 2.2;

/// How far the joints of a robot are from each other in all, along the longest way.
function length_of(link) {
  return Math.max(0, ...link.children.filter((child) => child.isURDFJoint).map((joint) => joint.position.length() + Math.max(0, ...joint.children.filter((one) => one.isURDFLink).map(length_of))));
}

/// In place of meshes: what a link carries is where its joints are. A bone to each, a ball at each joint that moves.
function bones(link, thick, material) {
  const group = new Group(), joints = link.children.filter((child) => child.isURDFJoint);
  const reach = Math.max(0, ...joints.map((joint) => joint.position.length()));
  if (link.parent?.isURDFJoint && link.parent.jointType !== 'fixed') group.add(new Mesh(new SphereGeometry(thick * ball_of_bone, 20, 14), material));
  for (const {position} of joints) {
    const long = position.length();
    if (long < thick / 2) continue;
    const bone = new Mesh(new CylinderGeometry(thick * 0.8, thick, long, 18), material);
    bone.position.copy(position).multiplyScalar(0.5);
    bone.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), position.clone().divideScalar(long));
    group.add(bone);
  }
  // What is at an end has nothing to reach: a stub along the axis that turns it.
  if (!joints.length && reach === 0 && link.parent?.isURDFJoint) {
    const stub = new Mesh(new CylinderGeometry(thick * 0.6, thick * 0.8, thick * end_of_bone, 18), material);
    stub.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), link.parent.axis.clone().normalize());
    group.add(stub);
  }
  return group;
}

/// The mission's parts in place of the URDF's own shapes, where it has them; each link's parts of one material are one mesh. How many parts of bones
/// it took for shapes that are nowhere.
export function dress(body, parts, environment, software) {
  const links = Object.values(body.links), bare = !links.some((link) => visuals_of(link).length);
  const plain_skin = (color) => affordable(new MeshStandardMaterial({color, roughness: 0.5, metalness: 0.15, envMap: environment}), software);
  let bone_skin = null, count = 0;
  for (const [name, link] of Object.entries(body.links)) {
    if (!parts[name]) {
      // Its own shapes only: below them are the links that it carries.
      for (const visual of visuals_of(link)) visual.traverse((part) => { if (part.isMesh) part.material = plain_skin(part.material.color); });
      if (bare || visuals_of(link).some(is_mesh)) {
        const group = bones(link, bone_share * length_of(body), bone_skin ??= plain_skin(new Color(0xd3d7dd)));
        group.userData.bones = true;
        count += group.children.length;
        link.add(group);
      }
      continue;
    }
    for (const child of [...link.children]) if (child.isURDFVisual) child.removeFromParent();
    const whole = software ? joined(merged(parts[name])) : merged(parts[name]);
    whole.traverse((part) => {
      if (!part.isMesh) return;
      part.material = affordable(part.material, software);
      part.castShadow = part.receiveShadow = !software && !part.userData.label;
    });
    whole.userData.dress = true;
    link.add(whole);
  }
  return count;
}

const is_fixed = (child) => child.isURDFJoint && child.jointType === 'fixed';
/// The links that no joint moves.
const still_links = (link) => [link, ...link.children.filter(is_fixed).flatMap((joint) => joint.children.filter((one) => one.isURDFLink).flatMap(still_links))];

export class RobotModel {
  #text;
  #reckoning;

  constructor(about, text, parts, {environment, software}) {
    this.about = about;
    this.#text = text;
    this.parts = parts;
    this.body = parsed_urdf(text);
    this.bones = dress(this.body, parts, environment, software);
    // Unseen until the first telemetry says how it stands.
    this.body.visible = false;
    this.body.position.fromArray(about.at_m ?? [0, 0, 0]);
    this.names = Object.keys(about.joints);
    this.velocities = this.names.map((name) => Number.parseFloat(this.body.joints[name].urdfNode.querySelector('limit')?.getAttribute('velocity') ?? ''));
    this.motion = new Motion();
    this.last = [];
    this.size = new Box3().setFromObject(this.body).getSize(new Vector3()).length();
    this.halo = new Halo(this.body, software ? 2 : 3);
    this.dials = about.inset ? [] : this.names.map((name) => this.#dial(name));
    this.tip = about.tip ? new Vector3() : null;
    if (about.tip) {
      this.frame = triad(0.06 * this.size, 0.0016 * this.size);
      this.body.links[about.tip].add(this.frame);
    }
  }

  #dial(name) {
    const joint = this.body.joints[name], {lower, upper} = joint.limit;
    if (!(upper > lower)) return null;
    const [radius, lift] = this.about.dials?.[name] ?? [dial_of_size * this.size * 0.4, 0];
    const dial = new Dial({lower, upper}, radius);
    // It stands still while the joint turns.
    dial.group.position.copy(joint.position);
    dial.group.quaternion.copy(joint.quaternion).multiply(new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), joint.axis));
    dial.group.translateZ(lift);
    joint.parent.add(dial.group);
    return dial;
  }

  /// As telemetry has it; `now_ms` is the browser's time.
  take(values, now_ms) {
    const sample = this.names.map((name) => values.get(this.about.joints[name])?.v);
    if (sample.some((angle) => Number.isFinite(angle))) this.motion.take(sample, now_ms);
  }

  /// Whether it is drawn otherwise than before.
  pose(now_ms) {
    const angles = this.motion.at(now_ms);
    let moved = false;
    angles.forEach((angle, i) => {
      if (!Number.isFinite(angle) || Math.abs((this.last[i] ?? Infinity) - angle) < moved_rad) return;
      this.last[i] = angle;
      const joint = this.body.joints[this.names[i]];
      joint.ignoreLimits = true;
      joint.setJointValue(angle);
      this.dials[i]?.turn(angle);
      moved = true;
    });
    if (!moved) return false;
    this.body.visible = true;
    this.body.updateMatrixWorld(true);
    if (this.tip) this.body.links[this.about.tip].getWorldPosition(this.tip);
    return true;
  }

  /// Where what stands still is a picture: the links that do are in it, of `parts`, and only hide what is behind them. What is to be added to it.
  stand_still(parts, scale) {
    this.body.updateMatrixWorld(true);
    const still = still_links(this.body);
    return Object.entries(this.body.links).filter(([name, link]) => parts[name] && still.includes(link)).map(([name, link]) => {
      become_hider(link.children.find((child) => child.userData.dress), this.parts[name], scale);
      const whole = merged(parts[name]);
      whole.applyMatrix4(link.matrixWorld);
      return whole;
    });
  }

  /// Numbers and words on its parts: another program, which the first picture does not wait for.
  show_labels(shown) {
    this.body.traverse((part) => { if (part.userData.label) part.visible = shown; });
  }

  show_limits(shown) {
    for (const dial of this.dials) if (dial) dial.group.visible = shown;
  }

  /// Another one that nobody sees, to reckon with.
  get reckoning() { return this.#reckoning ??= new Phantom(this.about, this.#text, null); }
}

/// Another one of the same robot that stands where it is told to: for goals that are typed, and, without `parts`, unseen.
export class Phantom {
  constructor(about, text, parts) {
    this.body = parsed_urdf(text);
    this.body.position.fromArray(about.at_m ?? [0, 0, 0]);
    if (parts) dress(this.body, parts, null, true);
    // What no joint moves stands where the robot's does.
    for (const link of still_links(this.body)) for (const child of link.children) if (child.userData.dress) child.visible = false;
    this.tip = about.tip;
    this.tip_link = this.body.links[about.tip];
    for (const joint of Object.values(this.body.joints)) joint.ignoreLimits = true;
  }

  /// Joint name -> angle; where its tip is then.
  stand(angles) {
    for (const [name, angle] of Object.entries(angles)) this.body.setJointValue(name, angle);
    this.body.updateMatrixWorld(true);
    return this.tip ? this.body.links[this.tip].getWorldPosition(new Vector3()) : null;
  }

  /// {joint: angle} at which the point `local` of `link` is at `place`, or as near as the joints `free` of `robot` bring it; from `angles` on.
  reached({link, local}, place, angles, robot, free = robot.names) {
    const {names} = robot, named = (list) => Object.fromEntries(names.map((name, i) => [name, list[i]]));
    const place_of = (list) => {
      this.stand(named(list));
      return link.localToWorld(local.clone()).toArray();
    };
    const joints = names.map((name) => ({lower: robot.body.joints[name].limit.lower, upper: robot.body.joints[name].limit.upper, free: free.includes(name)}));
    return named(reach(place_of, joints, names.map((name) => angles[name]), place.toArray(), robot.size));
  }
}
