// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What stands for the links of arm.urdf and joystick.urdf, and what is around them: an arm on its module on a spacecraft's top, as ROKVISS
// was, with the rail and the springs that it works at. `kit` is what ground/web/page/scene/kit.js offers; lengths as in simulation/devices/robot/world.

const elbow_m = 0.25, plane_z_m = 0.075;

function mount(kit) {
  const M = kit.material, group = kit.group();
  group.add(kit.turned([[0, 0], [0.066, 0], [0.066, 0.009], [0.0645, 0.0105], [0.05, 0.0105], [0.05, 0.016], [0.046, 0.02], [0.046, 0.04], [0.048, 0.042], [0.048, 0.046], [0, 0.046]], M.joint),
    ...kit.flush(kit.bolts(12, 0.058, 0.0125, 0.0042, 0.005, M.steel)), kit.turned([[0.0485, 0.046], [0.0485, 0.0505], [0, 0.0505]], M.gold));
  for (let i = 0; i < 5; ++i) {
    const z = 0.0235 + i * 0.0034;
    group.add(...kit.flush(kit.turned([[0.0462, z], [0.0475, z + 0.0007], [0.0475, z + 0.0021], [0.0462, z + 0.0028]], M.dark, 40)));
  }
  group.add(kit.box([0.03, 0.022, 0.024], M.dark, [-0.058, 0.012, 0.026], [0, 0, -0.2]),
    kit.tube([[-0.072, 0.016, 0.026], [-0.1, 0.03, 0.022], [-0.125, 0.06, 0.012], [-0.15, 0.12, 0.006], [-0.155, 0.19, 0.005]], 0.0042, M.cable),
    kit.tube([[-0.07, 0.008, 0.02], [-0.095, 0.018, 0.014], [-0.125, 0.05, 0.008], [-0.141, 0.11, 0.005], [-0.146, 0.19, 0.005]], 0.003, M.gold));
  return group;
}

function upper(kit) {
  const M = kit.material, group = kit.group();
  group.add(kit.turned([[0, -0.0245], [0.0435, -0.0245], [0.045, -0.022], [0.045, 0.02], [0.0425, 0.0245], [0.036, 0.0245], [0.036, 0.029], [0.0335, 0.0315], [0, 0.0315]], M.white),
    kit.turned([[0.0455, -0.004], [0.0462, -0.003], [0.0462, 0.003], [0.0455, 0.004]], M.joint), kit.bolts(8, 0.0285, 0.0325, 0.0028, 0.003, M.steel), kit.cylinder(0.016, 0.003, M.joint, [0, 0, 0.0325]),
    kit.plate(kit.bone(0.038, 0.033, elbow_m, [0.068, 0.178, 0.0135, 0.0115]), 0.03, 0.0035, M.white), kit.plate(kit.bone(0.02, 0.0175, 0.12), 0.012, 0, M.dark, -0.006).translateX(0.063),
    kit.tube([[0.02, 0.008, 0.016], [0.055, 0.009, 0.012], [0.085, 0.003, 0.004], [0.123, -0.002, 0.003], [0.165, 0.003, 0.004], [0.2, 0.008, 0.013], [0.235, 0.006, 0.018]], 0.0036, M.cable),
    kit.tube([[0.02, -0.004, 0.016], [0.055, -0.001, 0.011], [0.09, -0.006, 0.003], [0.125, 0.005, 0.003], [0.165, -0.004, 0.004], [0.2, -0.001, 0.012], [0.235, -0.003, 0.018]], 0.0024, M.gold));
  for (const x of [0.058, 0.19]) group.add(kit.box([0.008, 0.024, 0.004], M.joint, [x, 0.002, 0.0158]));
  group.add(kit.turned([[0, -0.05], [0.026, -0.05], [0.0275, -0.048], [0.0275, -0.027], [0.0355, -0.025], [0.0355, -0.0185], [0, -0.0185]], M.joint).translateX(elbow_m));
  const mark = kit.decal('1', 0.02, 0.02, 190);
  mark.position.set(0.0005, 0, 0.0345);
  group.add(mark);
  return group;
}

function lower(kit) {
  const M = kit.material, group = kit.group();
  group.add(kit.turned([[0, -0.0185], [0.0365, -0.0185], [0.038, -0.016], [0.038, 0.019], [0.0355, 0.0235], [0.03, 0.0235], [0.03, 0.028], [0.028, 0.03], [0, 0.03]], M.white),
    kit.turned([[0.0362, -0.0215], [0.0388, -0.0205], [0.0388, -0.0165], [0.0362, -0.0155]], M.gold), kit.bolts(8, 0.0235, 0.031, 0.0024, 0.003, M.steel), kit.cylinder(0.013, 0.003, M.joint, [0, 0, 0.031]),
    kit.plate(kit.bone(0.03, 0.0165, 0.158, [0.058, 0.125, 0.0092, 0.0066]), 0.025, 0.003, M.white), kit.plate(kit.bone(0.0125, 0.009, 0.075), 0.01, 0, M.dark, -0.005).translateX(0.054),
    kit.tube([[0.022, 0.005, 0.014], [0.05, 0.003, 0.006], [0.09, -0.001, 0.002], [0.125, 0.002, 0.008], [0.152, 0.001, 0.0135]], 0.003, M.cable),
    kit.lying(kit.turned([[0, 0], [0.0135, 0], [0.0145, 0.0015], [0.0145, 0.0115], [0.0135, 0.013], [0, 0.013]], M.joint), 0.166),
    kit.lying(kit.turned([[0, 0], [0.0125, 0], [0.0125, 0.0045], [0, 0.0045]], M.gold), 0.179),
    kit.lying(kit.turned([[0, 0], [0.0105, 0], [0.006, 0.012], [0.0052, 0.014], [0.0052, 0.03], [0, 0.03]], M.steel), 0.1835));
  const mark = kit.decal('2', 0.017, 0.017, 190);
  mark.position.set(0, 0, 0.0328);
  group.add(mark);
  return group;
}

function stick_base(kit) {
  const M = kit.material, group = kit.group(kit.box([0.12, 0.12, 0.03], M.dark, [0, 0, 0.015], undefined, 0.009),
    kit.turned([[0, 0.03], [0.05, 0.03], [0.05, 0.034], [0.046, 0.037], [0.04, 0.037], [0.036, 0.034], [0, 0.034]], M.joint));
  for (const x of [-0.048, 0.048]) for (const y of [-0.048, 0.048]) group.add(kit.cylinder(0.004, 0.002, M.steel, [x, y, 0.031], 0.004, 6));
  return group;
}

function stick_handle(kit) {
  const M = kit.material, group = kit.group();
  for (let i = 0; i < 4; ++i) group.add(kit.ring(0.034 - i * 0.0065, 0.0048, M.black, [0, 0, 0.001 + i * 0.0065]));
  group.add(kit.cylinder(0.0062, 0.06, M.steel, [0, 0, 0.04]),
    kit.turned([[0, 0.055], [0.01, 0.055], [0.0135, 0.06], [0.0155, 0.078], [0.015, 0.096], [0.0185, 0.112], [0.0205, 0.124], [0.0185, 0.138], [0.012, 0.147], [0, 0.15]], M.grip, 40),
    kit.turned([[0, 0.1495], [0.006, 0.1495], [0.006, 0.1525], [0, 0.1535]], M.dark, 20));
  return group;
}

export const links = {
  'arm.urdf': (kit) => ({mount: mount(kit), upper: upper(kit), lower: lower(kit), fingertip: kit.sphere(0.01, kit.material.steel)}),
  'joystick.urdf': (kit) => ({base: stick_base(kit), gimbal: kit.group(), handle: stick_handle(kit)}),
};

/// The module's plate: holes each 25 mm, brushed, a ruler in mm along its front edge whose zero is the arm's axis.
function draw_plate(kit) {
  const random = new kit.Random(9), px_per_mm = 1.6;
  return (context, width, height) => {
    context.fillStyle = '#6b7179';
    context.fillRect(0, 0, width, height);
    for (let i = 0; i < 2600; ++i) {
      context.fillStyle = `rgba(${random.next() < 0.5 ? '255, 255, 255' : '0, 0, 0'}, ${0.012 + 0.02 * random.next()})`;
      context.fillRect(0, random.next() * height, width, 1 + random.next());
    }
    context.strokeStyle = 'rgba(20, 23, 28, .55)';
    context.lineWidth = 2;
    context.strokeRect(14, 14, width - 28, height - 28);
    for (let y = 40; y < height - 20; y += 40) {
      for (let x = 40; x < width - 20; x += 40) {
        for (const [radius, colour] of [[7.5, '#3d424a'], [5.6, '#14171b']]) {
          context.fillStyle = colour;
          context.beginPath();
          context.arc(x, y, radius, 0, 7);
          context.fill();
        }
      }
    }
    const zero = 160 * px_per_mm, edge = height - 6;
    context.fillStyle = 'rgba(235, 240, 246, .85)';
    context.font = '600 17px Inter, sans-serif';
    context.textAlign = 'center';
    for (let mm = -150; mm <= 450; mm += 10) {
      const x = zero + mm * px_per_mm, long = mm % 100 === 0 ? 20 : mm % 50 === 0 ? 14 : 9;
      context.fillRect(x - 0.8, edge - long, 1.6, long);
      if (mm % 100 === 0) context.fillText(String(mm), x, edge - 24);
    }
    context.textAlign = 'left';
    context.fillText('mm', zero + 455 * px_per_mm, edge - 4);
  };
}

/// All that stands still.
export function surroundings(kit) {
  const M = kit.material, top = -0.043, group = kit.group();
  group.add(kit.plane(0.64, 0.48, M.painted(1024, 768, draw_plate(kit)), [0.16, 0.02, 0.0003]), kit.box([0.646, 0.486, 0.016], M.aluminium, [0.16, 0.02, -0.0082], undefined, 0.003),
    kit.box([0.6, 0.44, 0.03], M.dark, [0.16, 0.02, -0.028], undefined, 0.004));
  const place = (part, x, y, z = top) => {
    part.position.set(x, y, z);
    group.add(part);
    return part;
  };
  place(kit.bus([1.02, 0.92, 0.78]), 0.14, 0.1);
  place(kit.docking_ring(0.134), -0.2, 0.395);
  place(kit.star_tracker(), 0.56, 0.46);
  place(kit.mast(0.15), 0.46, 0.53);
  place(kit.wings(1.02, [0.8, 0.62], 3), 0.14, 0.22, -0.2).rotation.x = 0.62;
  place(kit.radiator(0.5, 0.3), 0.14, -0.3615, -0.3).rotation.x = Math.PI / 2;
  return group;
}

/// What the fingertip slides along and what it is hooked to: it hides the finger, so it is drawn with the arm as well.
export function obstacles(kit, {contour, surface_x_m, springs}) {
  const M = kit.material, group = kit.group(), {from_y_m: from, to_y_m: to, rail_x_m: rail, depth_m: depth} = contour;
  const steps = kit.detail < 1 ? 32 : 72, along = Array.from({length: steps + 1}, (_, i) => from + (to - from) * i / steps);
  group.add(kit.plate(kit.outline([[rail + depth, from], ...along.map((y) => [surface_x_m(contour, y), y]), [rail + depth, to]]), 0.05, 0.0018, M.plastic, 0.081),
    ...kit.flush(kit.plate(kit.outline([...along.map((y) => [surface_x_m(contour, y) - 0.0008, y]), ...along.toReversed().map((y) => [surface_x_m(contour, y) + 0.002, y])]), 0.014, 0, M.gold, plane_z_m)));
  for (let i = 0; i <= 30; ++i) {
    const long = i % 5 ? 0.006 : 0.011;
    group.add(kit.mesh(new kit.three.BoxGeometry(long, 0.0009, 0.0006), M.dark, [0.38 - long / 2, from + 0.005 + i * 0.00967, 0.1063]));
  }
  for (const y of [-0.1, 0.02, 0.14]) {
    group.add(kit.box([0.026, 0.03, 0.056], M.joint, [0.368, y, 0.028], undefined, 0.003), kit.box([0.046, 0.044, 0.008], M.joint, [0.37, y, 0.004], undefined, 0.002));
    for (const side of [-0.016, 0.016]) group.add(kit.cylinder(0.003, 0.004, M.steel, [0.387, y + side, 0.009], 0.003, 6));
  }
  for (const {from_m: [x, y]} of springs) {
    const post = kit.turned([[0, 0], [0.012, 0], [0.012, 0.004], [0.005, 0.007], [0.0042, 0.01], [0.0042, 0.078], [0.006, 0.08], [0.006, 0.083], [0, 0.084]], M.joint, 28);
    post.position.set(x, y, 0);
    group.add(post);
  }
  return group;
}
