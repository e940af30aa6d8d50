// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What is shown of a mission that says nothing of itself: a spacecraft in orbit with a module for each subsystem on its deck, in the colour of
// its state and with its name and state beside it. And a spacecraft's top under a robot whose mission gives none.

const deck_m = [1.7, 1.3, 0.9];
const columns = (count) => Math.ceil(Math.sqrt(count * 1.6));

/// scene.json of a mission without one.
export const usual_description = {robots: [], modules: true, camera: {fov_deg: 33, from_m: [-0.55, -2.15, 1.35], to_m: [0.05, 0.05, -0.02], above_m: [0, 0, 2.6]}};

export function usual_surroundings(kit, below_robot) {
  const group = kit.group(), [x, y, z] = below_robot ? [1.4, 1.1, 0.9] : deck_m;
  const place = (part, ...at) => {
    part.position.set(...at);
    group.add(part);
    return part;
  };
  if (below_robot) place(kit.box([1.3, 1.0, 0.02], kit.material.aluminium), 0.15, 0, -0.0102);
  const middle = below_robot ? 0.15 : 0;
  place(kit.bus([x, y, z]), middle, 0, -0.021);
  place(kit.wings(x, [0.9, 0.7], 3), middle, 0.2, -0.25).rotation.x = 0.5;
  if (below_robot) return group;
  place(kit.docking_ring(0.16), -0.6, 0.45, -0.02);
  place(kit.star_tracker(), 0.68, 0.5, -0.02);
  place(kit.mast(0.3), 0.5, 0.56, -0.02);
  place(kit.radiator(0.7, 0.35), 0, -y / 2 - 0.002, -0.35).rotation.x = Math.PI / 2;
  return group;
}

/// Where the module of each of `count` subsystems stands, and how large: [x, y, width].
export function module_places(count) {
  const across = columns(count), rows = Math.ceil(count / across), wide = Math.min(0.3, 0.95 * 1.2 / across, 0.9 / rows);
  return Array.from({length: count}, (_, i) => {
    const row = Math.floor(i / across), in_row = Math.min(across, count - row * across);
    return [(i % across - (in_row - 1) / 2) * wide * 1.25 + 0.05, ((rows - 1) / 2 - row) * wide * 1.25 - 0.08, wide];
  });
}

/// A module: a box with a lid, bolts and a connector; `lamp` is the strip that tells its state.
export function module_of(kit, wide) {
  const M = kit.material, tall = wide * 0.42, half = wide / 2;
  const lamp = kit.mesh(new kit.three.BoxGeometry(wide * 0.7, wide * 0.05, wide * 0.02), new kit.three.MeshBasicMaterial({color: 0xdfe4ea, toneMapped: false}), [0, -half * 0.98, tall * 0.72]);
  const group = kit.group(kit.box([wide * 0.92, wide * 0.92, tall], M.white, [0, 0, tall / 2], undefined, wide * 0.03), kit.box([wide, wide, wide * 0.05], M.joint, [0, 0, wide * 0.02], undefined, wide * 0.01),
    kit.bolts(12, half * 1.02, wide * 0.05, wide * 0.018, wide * 0.02, M.steel), kit.box([wide * 0.5, wide * 0.5, wide * 0.03], M.gold, [0, 0, tall + wide * 0.01], undefined, wide * 0.01),
    kit.cylinder(wide * 0.07, wide * 0.08, M.dark, [half * 0.55, half * 0.55, tall + wide * 0.03]));
  group.add(lamp);
  return {group, lamp, top: tall};
}
