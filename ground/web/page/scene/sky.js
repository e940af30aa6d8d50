// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Where it all is: sun, stars, the Earth's limb, and what metals mirror of it.
import {
  AdditiveBlending, BackSide, BufferAttribute, BufferGeometry, Color, CubeTexture, DataTexture, DataUtils, DirectionalLight, DoubleSide, Group, HalfFloatType, HemisphereLight, LinearFilter, LinearSRGBColorSpace, Mesh, MeshBasicMaterial, PlaneGeometry,
  Points, PointsMaterial, RGBAFormat, Scene, ShaderMaterial, SphereGeometry, Vector3,
} from 'three';
import {cloud_tile, Random} from './surfaces.js';

export const sun_from = new Vector3(-0.85, -0.55, 1.15);

/// What metals mirror: [width, height, colour, strength, from] of planes at 12 m: a hard sun, a blue Earth below, faint strips.
const mirrored = [[9, 7, 0xfff1dc, 9, [-0.75, -0.5, 0.9]], [14, 3, 0xdfe9ff, 2.2, [0.9, -0.7, 0.5]], [3, 12, 0xffffff, 1.6, [0.2, 1, 0.55]],
  [16, 7, 0xcfd8e6, 0.55, [0.1, -1, -0.25]], [22, 16, 0x5d94d8, 0.9, [0.2, 0.5, -1]], [18, 2, 0xa9d2ff, 2, [0, 1, -0.1]]];
const mirrored_at_m = 12, void_colour = 0x0b0e13;

/// For a graphics card, by three.js' own `PMREMGenerator`: filtered for every roughness.
export function environment(renderer, size, PMREMGenerator) {
  const scene = new Scene();
  const lit = (colour, strength) => new MeshBasicMaterial({color: new Color(colour).multiplyScalar(strength), side: DoubleSide});
  scene.add(new Mesh(new SphereGeometry(30, 16, 12), new MeshBasicMaterial({color: void_colour, side: BackSide})));
  for (const [width, height, colour, strength, from] of mirrored) {
    const panel = new Mesh(new PlaneGeometry(width, height), lit(colour, strength));
    panel.position.set(...from).normalize().multiplyScalar(mirrored_at_m);
    panel.lookAt(0, 0, 0);
    scene.add(panel);
  }
  const generator = new PMREMGenerator(renderer);
  const {texture} = generator.fromScene(scene, 0.03, 0.1, 100, {size});
  generator.dispose();
  return texture;
}

/// The same for a processor that draws by itself, computed here: filtering for every roughness would take it seconds. Blurred once.
export function mirrored_cube(size = 16) {
  const panels = mirrored.map(([width, height, colour, strength, from]) => {
    const toward = new Vector3(...from).normalize(), across = new Vector3(0, 0, 1).cross(toward).normalize(), along = toward.clone().cross(across);
    return {toward, across, along, wide: width / 2 / mirrored_at_m, tall: height / 2 / mirrored_at_m, colour: new Color(colour).multiplyScalar(strength)};
  });
  const soft = (distance) => Math.max(0, Math.min(1, 0.5 - distance / 0.3));
  const seen = (direction, sum) => {
    sum.set(void_colour);
    for (const {toward, across, along, wide, tall, colour} of panels) {
      const depth = direction.dot(toward);
      if (depth < 0.1) continue;
      const part = soft(Math.abs(direction.dot(across)) / depth - wide) * soft(Math.abs(direction.dot(along)) / depth - tall);
      sum.r += part * colour.r;
      sum.g += part * colour.g;
      sum.b += part * colour.b;
    }
  };
  const faces = [(u, v) => [1, -v, -u], (u, v) => [-1, -v, u], (u, v) => [u, 1, v], (u, v) => [u, -1, -v], (u, v) => [u, -v, 1], (u, v) => [-u, -v, -1]];
  const direction = new Vector3(), sum = new Color();
  const images = faces.map((face) => {
    const data = new Uint16Array(4 * size * size);
    for (let j = 0; j < size; ++j) {
      for (let i = 0; i < size; ++i) {
        // A cube is sampled with its x turned.
        const [x, y, z] = face((i + 0.5) / size * 2 - 1, (j + 0.5) / size * 2 - 1);
        seen(direction.set(-x, y, z).normalize(), sum);
        data.set([sum.r, sum.g, sum.b, 1].map((value) => DataUtils.toHalfFloat(value)), 4 * (j * size + i));
      }
    }
    return new DataTexture(data, size, size, RGBAFormat, HalfFloatType);
  });
  const cube = new CubeTexture(images);
  Object.assign(cube, {format: RGBAFormat, type: HalfFloatType, minFilter: LinearFilter, magFilter: LinearFilter, generateMipmaps: false, colorSpace: LinearSRGBColorSpace, needsUpdate: true});
  return cube;
}

/// Sun and sky light; with `shadow` a soft one over `reach_m` around `target`.
export function lights({target, reach_m, shadow}) {
  const sun = new DirectionalLight(0xfff3e2, 3.4);
  sun.position.copy(sun_from).multiplyScalar(2.3 * reach_m).add(target);
  sun.target.position.copy(target);
  if (shadow) {
    sun.castShadow = true;
    sun.shadow.mapSize.set(2048, 2048);
    Object.assign(sun.shadow.camera, {left: -reach_m, right: reach_m, top: reach_m, bottom: -reach_m, near: 0.5 * reach_m, far: 7 * reach_m});
    sun.shadow.bias = -0.0004;
    sun.shadow.normalBias = 0.0026 * reach_m;
    sun.shadow.radius = 3.5;
  }
  return [sun, sun.target, new HemisphereLight(0x8fb4e8, 0x2a2014, 0.42)];
}

const globe_vertex = 'varying vec3 n, w; void main() { n = normalize(normal); vec4 p = modelMatrix * vec4(position, 1.); w = p.xyz; gl_Position = projectionMatrix * viewMatrix * p; }';
const ground_fragment = `uniform sampler2D tile; uniform vec3 sun; uniform float dim; varying vec3 n, w;
  void main() {
    vec3 a = normalize(n), v = normalize(cameraPosition - w);
    float day = smoothstep(-.12, .42, dot(a, sun)), rim = pow(1. - max(dot(a, v), 0.), 3.2);
    vec2 q = a.xy * 3.1 + a.z * vec2(1.3, -.8);
    vec4 t = texture2D(tile, q), u = texture2D(tile, q * 4.3 + t.xy * .35), s = texture2D(tile, q * 13.);
    float cloud = smoothstep(.50, .78, t.x * .62 + u.y * .34 + s.z * .12), land = smoothstep(.52, .6, texture2D(tile, q * .55 + .3).w);
    vec3 sea = mix(vec3(.010, .034, .085), vec3(.02, .08, .15), t.z), soil = mix(vec3(.040, .055, .036), vec3(.095, .082, .055), u.w);
    vec3 c = mix(mix(sea, soil, land * .8), vec3(.62, .68, .76), cloud * .82) * day;
    c = mix(c, vec3(.16, .36, .72) * (day * .95 + .04), clamp(rim * .9, 0., 1.));
    gl_FragColor = vec4(c * dim, 1.);
    #include <tonemapping_fragment>
    #include <colorspace_fragment>
  }`;
const air_fragment = `uniform vec3 sun; uniform float dim; varying vec3 n, w;
  void main() {
    vec3 a = normalize(n), v = normalize(cameraPosition - w);
    float k = clamp(-dot(a, v), 0., 1.) * 4.6, day = smoothstep(-.25, .35, dot(a, sun)), g = pow(clamp(k, 0., 1.), 2.6);
    gl_FragColor = vec4(mix(vec3(.05, .16, .5), vec3(.45, .72, 1.), g) * g * day * dim * 1.15, 1.);
    #include <colorspace_fragment>
  }`;

/// Darker than what is in front of it: `dim` 0.6 to 0.8.
function earth({centre, radius, dim}) {
  const uniforms = {tile: {value: cloud_tile()}, sun: {value: new Vector3(-0.55, 0.55, 0.62).normalize()}, dim: {value: dim}};
  const group = new Group();
  group.add(new Mesh(new SphereGeometry(radius, 128, 96), new ShaderMaterial({uniforms, vertexShader: globe_vertex, fragmentShader: ground_fragment})),
    new Mesh(new SphereGeometry(radius * 1.022, 128, 96), new ShaderMaterial({uniforms, vertexShader: globe_vertex, fragmentShader: air_fragment, transparent: true, depthWrite: false,
      side: BackSide, blending: AdditiveBlending})));
  group.position.copy(centre);
  group.traverse((part) => { part.frustumCulled = false; part.renderOrder = -5; });
  return group;
}

function stars(count, distance) {
  const random = new Random(21), position = new Float32Array(3 * count), colour = new Float32Array(3 * count);
  for (let i = 0; i < count; ++i) {
    const z = random.next() * 2 - 1, angle = random.next() * 2 * Math.PI, across = Math.sqrt(1 - z * z), bright = 0.22 + 0.78 * random.next() ** 4, warm = random.next();
    position.set([distance * across * Math.cos(angle), distance * across * Math.sin(angle), distance * z], 3 * i);
    colour.set([bright * (0.85 + 0.15 * warm), bright * 0.93, bright * (1 - 0.16 * warm)], 3 * i);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(position, 3));
  geometry.setAttribute('color', new BufferAttribute(colour, 3));
  const points = new Points(geometry, new PointsMaterial({size: 1.7, sizeAttenuation: false, vertexColors: true, toneMapped: false}));
  points.renderOrder = -9;
  points.frustumCulled = false;
  return points;
}

/// Stars and Earth around a scene that is `scale` times as large as an arm's reach of half a metre.
export function sky(scale) {
  return [stars(1500, 400 * scale), earth({centre: new Vector3(-12, 27, -72).multiplyScalar(scale), radius: 60 * scale, dim: 0.8})];
}
