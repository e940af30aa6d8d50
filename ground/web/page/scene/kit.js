// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Parts to build a spacecraft of, by code: no file is loaded. A mission's parts.js gets `Kit` and makes its links and surroundings with it.
// Lengths in metres, z is up.
import {
  BoxGeometry, BufferGeometry, CatmullRomCurve3, CircleGeometry, Color, CylinderGeometry, ExtrudeGeometry, Group, LatheGeometry, Mesh, MeshBasicMaterial, MeshPhongMaterial, MeshStandardMaterial, MultiplyOperation, Path, PlaneGeometry, Shape, SphereGeometry, TorusGeometry, TubeGeometry, Vector2, Vector3,
} from 'three';
import {RoundedBoxGeometry} from 'three/addons/geometries/RoundedBoxGeometry.js';
import {mergeGeometries, mergeVertices} from 'three/addons/utils/BufferGeometryUtils.js';
import {canvas_texture, foil_normals, Random, solar_cells} from './surfaces.js';

const half_turn = Math.PI, quarter_turn = Math.PI / 2;

/// The same surface as a processor can afford it: a metal is what it mirrors of one cube, in its own colour.
function phong({envMap, roughness = 0.5, metalness = 0, envMapIntensity = 1, color = 0xffffff, ...rest}) {
  const tint = new Color(color), metal = metalness > 0.6;
  return new MeshPhongMaterial({...rest, color: tint.clone().multiplyScalar(metal ? 1.15 * envMapIntensity : 1), envMap: metal ? envMap : null, combine: MultiplyOperation,
    reflectivity: metal ? 0.82 * metalness : 0, specular: tint.clone().multiplyScalar(0.05 + 0.35 * metalness * (1 - roughness)), shininess: 4 + 90 * (1 - roughness) ** 3});
}

/// Materials by name; `environment` is what metals mirror: filtered, or a cube for a processor, or null.
export function materials(environment, plain) {
  const M = plain ? (options) => phong({envMap: environment, ...options}) : (options) => new MeshStandardMaterial({envMap: environment, ...options});
  let foil = null;
  const blanket = (color, roughness, scale, repeat) => {
    const normalMap = (foil ??= foil_normals()).clone();
    normalMap.repeat.set(...repeat);
    normalMap.needsUpdate = true;
    return M({color, roughness, metalness: 0.93, normalMap, normalScale: new Vector2(scale, scale), envMapIntensity: 0.95});
  };
  return {
    white: M({color: 0xe6e8ea, roughness: 0.46, metalness: 0.05, envMapIntensity: 0.75}),
    joint: M({color: 0x50565f, roughness: 0.38, metalness: 0.75}),
    dark: M({color: 0x1a1d22, roughness: 0.6, metalness: 0.35}),
    black: M({color: 0x0c0d0f, roughness: 0.85, metalness: 0.1}),
    gold: M({color: 0xd9a95a, roughness: 0.3, metalness: 1}),
    steel: M({color: 0xdadee3, roughness: 0.2, metalness: 1}),
    aluminium: M({color: 0x8d939b, roughness: 0.5, metalness: 0.8}),
    cable: M({color: 0x24272c, roughness: 0.7, metalness: 0}),
    plastic: M({color: 0xb9b4a6, roughness: 0.55, metalness: 0.15}),
    grip: M({color: 0xb9a2ff, roughness: 0.45, metalness: 0.05, envMapIntensity: 0.6}),
    gold_foil: (across = 3, along = 3, scale = 0.26) => blanket(0xa47a40, 0.32, scale, [across * 1.7, along * 1.7]),
    silver_foil: (across = 2, along = 2, scale = 0.34) => blanket(0x8d939b, 0.4, scale, [across, along]),
    cells: (columns, rows) => M({map: solar_cells(columns, rows), roughness: 0.32, metalness: 0.25, envMapIntensity: 0.9}),
    painted: (width, height, draw, options = {}) => M({map: canvas_texture(width, height, draw), roughness: 0.55, metalness: 0.55, envMapIntensity: 0.8, ...options}),
  };
}

export class Kit {
  /// `detail` 1 is for a graphics card, less for a processor that draws by itself.
  constructor(environment, detail) {
    // What the parts below do not offer. All of three.js would be twice as much to send.
    this.three = {BoxGeometry, BufferGeometry, Group, Mesh, MeshBasicMaterial, Path, Shape, Vector3};
    this.material = materials(environment, environment?.isCubeTexture ?? false);
    this.detail = detail;
    // Drawn again with each picture by a processor: what is a few points wide needs no roundness.
    this.sparing = detail < 0.5;
    this.random = new Random(7);
    this.Random = Random;
  }

  #segments(count) { return Math.max(Math.min(count, 8), Math.round(count * this.detail)); }

  group(...parts) {
    const group = new Group();
    if (parts.length) group.add(...parts);
    return group;
  }

  mesh(geometry, material, at = [0, 0, 0], turned = [0, 0, 0]) {
    const mesh = new Mesh(geometry, material);
    mesh.position.set(...at);
    mesh.rotation.set(...turned);
    return mesh;
  }

  /// What lies on or in another part: it hides nothing that the other does not.
  flush(...parts) {
    for (const part of parts) part.userData.flush = true;
    return parts;
  }

  box([x, y, z], material, at, turned, radius = Math.min(x, y, z) * 0.12) {
    return this.mesh(this.sparing ? new BoxGeometry(x, y, z) : new RoundedBoxGeometry(x, y, z, this.detail < 1 ? 1 : 2, radius), material, at, turned);
  }

  /// Along z, its middle at `at`.
  cylinder(radius, height, material, at, top = radius, segments = 48) {
    const geometry = new CylinderGeometry(top, radius, height, this.#segments(segments));
    geometry.rotateX(quarter_turn);
    return this.mesh(geometry, material, at);
  }

  sphere(radius, material, at) {
    return this.mesh(new SphereGeometry(radius, this.#segments(32), this.#segments(20)), material, at);
  }

  plane(width, height, material, at, turned) {
    return this.mesh(new PlaneGeometry(width, height), material, at, turned);
  }

  /// Turned on a lathe around z: [[radius, z], ...] from below to above.
  turned(profile, material, segments = 56) {
    const geometry = new LatheGeometry(profile.map(([r, z]) => new Vector2(Math.max(r, 1e-4), z)), this.#segments(segments));
    geometry.rotateX(quarter_turn);
    return new Mesh(geometry, material);
  }

  ring(radius, thickness, material, at) {
    return this.mesh(new TorusGeometry(radius, thickness, this.sparing ? 5 : this.#segments(10), this.#segments(40)), material, at);
  }

  bolts(count, radius, z, size, height, material) {
    const all = Array.from({length: count}, (_, i) => {
      // Nobody sees one from below.
      const geometry = this.sparing ? mergeGeometries([new CylinderGeometry(size, size, height, 5, 1, true), new CircleGeometry(size, 5).rotateX(-quarter_turn).translate(0, height / 2, 0)]) :
        new CylinderGeometry(size, size, height, 6);
      geometry.rotateX(quarter_turn);
      geometry.translate(radius * Math.cos(i / count * 2 * half_turn), radius * Math.sin(i / count * 2 * half_turn), z);
      return geometry;
    });
    return new Mesh(mergeGeometries(all), material);
  }

  /// The outline of a link: two circles, `length` apart along x, and their tangents; `pocket` [x1, x2, r1, r2] is cut out.
  bone(first, second, length, pocket) {
    const shape = new Shape(), lean = quarter_turn - Math.asin((first - second) / length);
    shape.absarc(0, 0, first, lean, 2 * half_turn - lean, false);
    shape.absarc(length, 0, second, -lean, lean, false);
    shape.closePath();
    if (pocket) {
      const [x1, x2, r1, r2] = pocket, hole = new Path();
      hole.absarc(x1, 0, r1, quarter_turn, 3 * quarter_turn, false);
      hole.absarc(x2, 0, r2, -quarter_turn, quarter_turn, false);
      hole.closePath();
      shape.holes.push(hole);
    }
    return shape;
  }

  /// An outline in x and y as a plate of `depth` with its middle at z.
  plate(shape, depth, bevel, material, z = 0) {
    const geometry = new ExtrudeGeometry(shape, {depth: depth - 2 * bevel, bevelEnabled: bevel > 0, bevelSize: bevel, bevelThickness: bevel,
      bevelSegments: this.detail < 1 ? 1 : 3, curveSegments: this.#segments(36), bevelOffset: -bevel});
    geometry.translate(0, 0, z - depth / 2 + bevel);
    return new Mesh(geometry, material);
  }

  outline(points) {
    const shape = new Shape();
    points.forEach(([x, y], i) => i ? shape.lineTo(x, y) : shape.moveTo(x, y));
    shape.closePath();
    return shape;
  }

  tube(points, radius, material, segments = 48) {
    const curve = new CatmullRomCurve3(points.map((point) => new Vector3(...point)));
    return new Mesh(new TubeGeometry(curve, this.#segments(segments), radius, this.sparing ? 4 : this.detail < 1 ? 5 : 8), material);
  }

  /// Along +x instead of +z.
  lying(part, x) {
    part.rotation.y = quarter_turn;
    part.position.x = x;
    return part;
  }

  /// A number or a word on a surface, seen from +z.
  decal(text, width, height, size, color = '#3b4048') {
    const map = canvas_texture(256, Math.round(256 * height / width), (context, w, h) => {
      context.clearRect(0, 0, w, h);
      context.fillStyle = color;
      context.font = `600 ${size}px Inter, sans-serif`;
      context.textAlign = 'center';
      context.textBaseline = 'middle';
      context.fillText(text, w / 2, h / 2);
    });
    const mesh = this.plane(width, height, new MeshStandardMaterial({map, transparent: true, roughness: 0.6, polygonOffset: true, polygonOffsetFactor: -2}));
    mesh.userData.label = true;
    return mesh;
  }

  /// A bus under foil, its top at z = 0 of the group: size [x, y, z].
  bus([x, y, z]) {
    const M = this.material, group = this.group();
    const geometry = new RoundedBoxGeometry(x, y, z, 2, Math.min(x, y, z) * 0.02);
    const side = M.gold_foil(3 * x, 3 * z), front = M.gold_foil(3.2 * x, 3 * z);
    group.add(this.mesh(geometry, [side, side, front, front, M.gold_foil(4.4 * x, 4.4 * y, 0.21), front], [0, 0, -z / 2]));
    const edge = 0.018 * Math.max(x, y), rim = 0.004;
    for (const i of [-1, 1]) {
      for (const j of [-1, 1]) group.add(this.box([edge * 1.2, edge * 1.2, z + rim], M.aluminium, [i * x / 2, j * y / 2, -z / 2]));
      group.add(this.box([x + rim, edge, edge], M.aluminium, [0, i * y / 2, -edge / 3]), this.box([edge, y + rim, edge], M.aluminium, [i * x / 2, 0, -edge / 3]));
    }
    return group;
  }

  /// Two wings of panels on yokes, along +x and -x of a bus `across` wide; `panel` [length, width] of each of `count`.
  wings(across, [length, width], count, columns = 8, rows = 5) {
    const M = this.material, group = this.group(), cells = M.cells(columns, rows);
    for (const side of [-1, 1]) {
      const wing = this.group(), arm = length * 0.25;
      wing.position.x = side * across / 2;
      const drive = this.turned([[0, 0], [0.022, 0], [0.022, 0.05], [0, 0.05]], M.joint);
      drive.rotation.y = side * quarter_turn;
      wing.add(drive);
      for (const way of [-1, 1]) wing.add(this.tube([[side * 0.04, 0, 0], [side * arm * 0.5, 0, 0], [side * arm, way * width * 0.33, 0]], 0.008, M.white, 16));
      for (let i = 0; i < count; ++i) {
        const x = side * (arm + length / 2 + i * length * 1.035);
        wing.add(this.box([length, width, 0.014], M.aluminium, [x, 0, -0.008]), this.plane(length * 0.982, width * 0.976, cells, [x, 0, 0.0002]));
        for (const way of [-1, 1]) wing.add(this.box([0.03, 0.03, 0.02], M.dark, [x - side * length * 0.518, way * width * 0.33, -0.008]));
      }
      group.add(wing);
    }
    return group;
  }

  /// A docking ring with its guide petals, standing on z = 0.
  docking_ring(radius) {
    const M = this.material, k = radius / 0.134, ring = this.group();
    const scaled = (profile) => profile.map(([r, z]) => [r * k, z * k]);
    ring.add(this.turned(scaled([[0.112, 0], [0.128, 0], [0.128, 0.04], [0.134, 0.046], [0.134, 0.056], [0.112, 0.056], [0.106, 0.05], [0.106, 0.01], [0.112, 0]]), M.aluminium, 72),
      this.turned(scaled([[0.1345, 0.0475], [0.136, 0.049], [0.136, 0.053], [0.1345, 0.0545]]), M.gold, 72), this.bolts(24, 0.123 * k, 0.0575 * k, 0.0034 * k, 0.003 * k, M.steel),
      this.cylinder(0.105 * k, 0.012 * k, M.black, [0, 0, 0.008 * k]), this.turned(scaled([[0, 0.012], [0.05, 0.012], [0.05, 0.02], [0.02, 0.036], [0, 0.038]]), M.dark));
    for (let i = 0; i < 3; ++i) {
      const angle = i * 2 * half_turn / 3;
      const petal = this.plate(this.outline([[-0.034, 0], [0.034, 0], [0.017, 0.06], [-0.017, 0.06]].map(([x, y]) => [x * k, y * k])), 0.007 * k, 0.0014 * k, M.white);
      petal.rotation.x = quarter_turn - 0.42;
      const holder = this.group(petal);
      holder.position.set(0.1 * k * Math.sin(angle), 0.1 * k * Math.cos(angle), 0.05 * k);
      holder.rotation.z = -angle;
      ring.add(holder);
    }
    return ring;
  }

  radiator(width, height) {
    const random = new Random(3);
    return this.plane(width, height, this.material.painted(512, 320, (context) => {
      for (let j = 0; j < 8; ++j) {
        for (let i = 0; i < 13; ++i) {
          context.fillStyle = `hsl(212, ${8 + 8 * random.next()}%, ${58 + 14 * random.next()}%)`;
          context.fillRect(i * 39.4, j * 40, 38, 38.4);
        }
      }
    }, {metalness: 1, roughness: 0.12}));
  }

  star_tracker() {
    const M = this.material, baffle = this.turned([[0.022, 0], [0.036, 0.085], [0.033, 0.085], [0.019, 0]], M.black);
    baffle.rotation.set(-0.5, 0.35, 0);
    baffle.position.z = 0.045;
    return this.group(this.box([0.07, 0.07, 0.05], M.black, [0, 0, 0.025]), baffle);
  }

  mast(height) {
    return this.group(this.cylinder(0.005, height, this.material.white, [0, 0, height / 2]),
      this.turned([[0, 0], [0.014, 0.002], [0.016, 0.01], [0.01, 0.018], [0, 0.02]], this.material.white, 28).translateZ(height));
  }

  /// A coil along x, of unit length, from the origin: scaled to where it is hooked.
  coil(turns, radius, wire, material) {
    const [steps, sides] = this.detail < 1 ? [8, 3] : [12, 4];
    const points = Array.from({length: turns * steps + 1}, (_, i) => {
      const part = i / (turns * steps), angle = i / steps * 2 * half_turn, wide = part < 0.05 || part > 0.95 ? 0 : radius;
      return [part, wide * Math.cos(angle), wide * Math.sin(angle)];
    });
    const curve = new CatmullRomCurve3(points.map((point) => new Vector3(...point)));
    return new Mesh(new TubeGeometry(curve, turns * steps, wire, sides), material);
  }
}

/// All meshes of a group that have the same material as one: a processor that draws pays for each call.
export function merged(group) {
  group.updateMatrixWorld(true);
  const home = group.matrixWorld.clone().invert(), by_material = new Map(), rest = [];
  group.traverse((part) => {
    if (!part.isMesh) return;
    if (Array.isArray(part.material) || part.userData.label) return void rest.push(part);
    const mapped = Boolean(part.material.map ?? part.material.normalMap);
    let geometry = part.geometry.clone().applyMatrix4(home.clone().multiply(part.matrixWorld));
    for (const name of Object.keys(geometry.attributes)) if (!['position', 'normal', ...(mapped ? ['uv'] : [])].includes(name)) geometry.deleteAttribute(name);
    // Each corner once: a processor that draws pays for every one.
    if (!geometry.index) geometry = mergeVertices(geometry, 1e-6);
    by_material.set(part.material, [...(by_material.get(part.material) ?? []), geometry]);
  });
  const whole = new Group();
  for (const [material, geometries] of by_material) whole.add(new Mesh(mergeGeometries(geometries), material));
  for (const part of rest) {
    const matrix = home.clone().multiply(part.matrixWorld);
    part.removeFromParent();
    matrix.decompose(part.position, part.quaternion, part.scale);
    whole.add(part);
  }
  return whole;
}
