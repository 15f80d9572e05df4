// The picture in three dimensions. The sensor's frame (x right, y down, z forward) is turned so that y is up.
import * as THREE from "./three.module.js";
import { OrbitControls } from "./OrbitControls.js";

const POINT_VERTEX = `
  attribute vec3 tint;
  uniform float size;
  varying vec3 colour;
  void main() {
    vec4 place = modelViewMatrix * vec4(position, 1.0);
    vec3 facing = normalize(normalMatrix * normal);
    float light = 0.45 + 0.55 * abs(dot(facing, normalize(place.xyz)));
    colour = tint * light;
    gl_Position = projectionMatrix * place;
    gl_PointSize = clamp(size / -place.z, 1.5, 60.0);
  }`;
// Readings are hidden behind the model's points that lie up to `behind` metres deeper: they measure the same surface.
const DEPTH_VERTEX = `
  attribute float shade;
  uniform float size, behind;
  varying vec3 colour;
  void main() {
    vec4 place = modelViewMatrix * vec4(position, 1.0);
    colour = vec3(shade);
    gl_Position = projectionMatrix * place;
    vec4 pushed = projectionMatrix * vec4(place.xy, place.z - behind, 1.0);
    gl_Position.z = pushed.z / pushed.w * gl_Position.w;
    gl_PointSize = clamp(size * position.z / -place.z, 1.0, 40.0);
  }`;
const FRAGMENT = `
  varying vec3 colour;
  uniform bool discs;
  void main() {
    if (discs && length(gl_PointCoord - 0.5) > 0.5) discard;
    gl_FragColor = vec4(colour, 1.0);
  }`;

function material(vertexShader, discs) {
  return new THREE.ShaderMaterial({ vertexShader, fragmentShader: FRAGMENT,
    uniforms: { size: { value: 1 }, behind: { value: 0 }, discs: { value: discs } } });
}

function rotation([w, x, y, z]) {
  return [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
    2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
    2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)];
}

/** Three bars of length 1 in x, y, z, seen through everything: lines are one pixel wide in most browsers. */
function makeAxes() {
  const axes = new THREE.Group();
  [0xff5050, 0x50d060, 0x60a0ff].forEach((color, k) => {
    const size = [0, 1, 2].map((i) => (i === k ? 1 : 0.025));
    const bar = new THREE.Mesh(new THREE.BoxGeometry(...size), new THREE.MeshBasicMaterial({ color, depthTest: false,
      transparent: true }));
    bar.position.setComponent(k, 0.5);
    bar.renderOrder = 2;
    axes.add(bar);
  });
  return axes;
}

export class Scene {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.renderer.setClearColor(0x14171a);
    this.camera = new THREE.PerspectiveCamera(45, 1, 0.01, 50);
    this.root = new THREE.Group();
    this.root.rotation.x = Math.PI;
    this.world = new THREE.Scene();
    this.world.add(this.root);
    this.points = new THREE.Points(new THREE.BufferGeometry(), material(POINT_VERTEX, true));
    this.depth = new THREE.Points(new THREE.BufferGeometry(), material(DEPTH_VERTEX, false));
    this.points.frustumCulled = this.depth.frustumCulled = false;
    this.points.visible = this.depth.visible = false;
    this.axes = [];
    this.showAxes = this.showHidden = this.showDepth = true;
    this.root.add(this.depth, this.points);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => { this.dirty = true; });
    this.controls.addEventListener("start", () => { this.touched = true; });
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.centre = new THREE.Vector3(0, 0, 0.8);
    this.radius = 0.2;
    this.resize();
    this.reset();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.updateSizes();
  }

  /** As the sensor sees it, the object in the middle. */
  reset() {
    this.touched = false;
    const target = this.root.localToWorld(this.centre.clone());
    const distance = this.radius / Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2)) * 1.25;
    const far = distance / Math.min(1, this.camera.aspect);
    const towards = target.clone().normalize().negate();
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(towards.lengthSq() > 0 ? towards : new THREE.Vector3(0, 0, 1), far);
    this.controls.update();
    this.dirty = true;
  }

  orbit(aside, up) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const place = new THREE.Spherical().setFromVector3(offset);
    place.theta += aside;
    place.phi = THREE.MathUtils.clamp(place.phi + up, 0.05, Math.PI - 0.05);
    this.camera.position.copy(this.controls.target).add(offset.setFromSpherical(place));
    this.touched = true;
    this.controls.update();
    this.dirty = true;
  }

  zoom(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.touched = true;
    this.controls.update();
    this.dirty = true;
  }

  setModel(model) {
    this.model = model;
    this.radius = model.radius;
    const geometry = new THREE.BufferGeometry();
    const dynamic = (size) =>
      new THREE.BufferAttribute(new Float32Array(size * model.points), size).setUsage(THREE.DynamicDrawUsage);
    geometry.setAttribute("position", dynamic(3));
    geometry.setAttribute("normal", dynamic(3));
    geometry.setAttribute("tint", dynamic(3));
    this.points.geometry.dispose();
    this.points.geometry = geometry;
    this.points.visible = false;
    this.updateSizes();
  }

  updateSizes() {
    const pixels = this.renderer.domElement.height / (2 * Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2)));
    this.points.material.uniforms.size.value = pixels * (this.model?.spacing ?? 0.005) * 1.5; // overlapping
    this.depth.material.uniforms.size.value = pixels * (this.cell ?? 0.005) * 1.15;
    // Half the distance between two points, as far as a disc reaches aslant, and the sensor's noise.
    this.depth.material.uniforms.behind.value = (this.model?.spacing ?? 0.005) + 0.005;
    this.dirty = true;
  }

  /** False where the frame's model is not known. */
  setFrame(frame) {
    this.dirty = true;
    const model = this.model;
    const fits = model && frame.state === "tracking" && frame.model_id === model.model_id &&
      frame.points === model.points && frame.regions.length > 0;
    this.points.visible = Boolean(fits);
    this.setAxes(fits ? frame.regions : []);
    if (!fits) return frame.state !== "tracking";
    this.frame = frame;
    this.fill();
    if (!this.touched) this.follow(frame.regions[0]);
    return true;
  }

  fill() {
    const { model, frame } = this;
    const motions = new Map(frame.regions.map((r) => [r.id, { m: rotation(r.quat), t: r.trans }]));
    const first = motions.get(frame.regions[0].id);
    const { position, normal, tint } = this.points.geometry.attributes;
    const p = position.array, n = normal.array, c = tint.array;
    for (let i = 0; i < model.points; ++i) {
      const label = frame.labels[i];
      const { m, t } = motions.get(label) ?? first;
      const at = 3 * i;
      const x = model.positions[at], y = model.positions[at + 1], z = model.positions[at + 2];
      const u = model.normals[at], v = model.normals[at + 1], w = model.normals[at + 2];
      for (let k = 0; k < 3; ++k) {
        p[at + k] = m[3 * k] * x + m[3 * k + 1] * y + m[3 * k + 2] * z + t[k];
        n[at + k] = m[3 * k] * u + m[3 * k + 1] * v + m[3 * k + 2] * w;
      }
      if (label === -2 && !this.showHidden) p[at] = p[at + 1] = p[at + 2] = NaN;
      const colour = model.palette[label + 2] ?? model.palette[2];
      const dim = label === -2 ? 0.7 : 1;
      for (let k = 0; k < 3; ++k) c[at + k] = colour[k] / 255 * dim;
    }
    const last = model.displacement.length - 1;
    for (let d = 0; d < frame.deformed; ++d) {
      const at = 3 * frame.indices[d];
      if (at >= p.length) continue;
      for (let k = 0; k < 3; ++k) p[at + k] = frame.moved[4 * d + k];
      const step = Math.min(last, Math.round(frame.moved[4 * d + 3] / frame.scale * last));
      for (let k = 0; k < 3; ++k) c[at + k] = model.displacement[step][k] / 255;
    }
    position.needsUpdate = normal.needsUpdate = tint.needsUpdate = true;
  }

  /** Keeps the object in the middle until somebody moves the view. */
  follow(base) {
    const m = rotation(base.quat), [x, y, z] = this.model.centre;
    const now = new THREE.Vector3(...[0, 1, 2].map((k) =>
      m[3 * k] * x + m[3 * k + 1] * y + m[3 * k + 2] * z + base.trans[k]));
    if (this.framed && now.distanceTo(this.centre) < 0.6 * this.radius) return;
    this.framed = true;
    this.centre.copy(now);
    this.reset();
  }

  setAxes(regions) {
    while (this.axes.length < regions.length) {
      this.axes.push(makeAxes());
      this.root.add(this.axes.at(-1));
    }
    this.axes.forEach((helper, i) => {
      const region = regions[i];
      helper.visible = Boolean(region) && this.showAxes;
      if (!region) return;
      const [w, x, y, z] = region.quat;
      helper.quaternion.set(x, y, z, w);
      helper.position.set(...region.trans);
      helper.scale.setScalar(this.radius * (region.id === 0 ? 0.8 : 0.45));
    });
    this.shownRegions = regions;
  }

  setDepth(picture) {
    const { columns, rows, step, fx, fy, cx, cy, near, far, readings } = picture;
    const place = new Float32Array(3 * columns * rows), shade = new Float32Array(columns * rows);
    let count = 0;
    for (let r = 0, i = 0; r < rows; ++r) {
      for (let c = 0; c < columns; ++c, ++i) {
        if (readings[i] === 0) continue;
        const z = readings[i] / picture.depth_scale;
        place[3 * count] = (c * step - cx) / fx * z;
        place[3 * count + 1] = (r * step - cy) / fy * z;
        place[3 * count + 2] = z;
        shade[count++] = 0.1 + 0.35 * Math.min(1, Math.max(0, (far - z) / Math.max(far - near, 1e-6)));
      }
    }
    const geometry = this.depth.geometry;
    geometry.setAttribute("position", new THREE.BufferAttribute(place, 3));
    geometry.setAttribute("shade", new THREE.BufferAttribute(shade, 1));
    geometry.setDrawRange(0, count);
    this.depth.visible = this.showDepth;
    this.hasDepth = true;
    this.cell = step / fx;
    this.updateSizes();
  }

  /** No picture came for long. */
  forgetDepth() {
    if (!this.hasDepth) return;
    this.hasDepth = this.depth.visible = false;
    this.dirty = true;
  }

  applyToggles() {
    this.depth.visible = this.showDepth && Boolean(this.hasDepth);
    this.setAxes(this.shownRegions ?? []);
    if (this.points.visible) this.fill();
    this.dirty = true;
  }

  render() {
    if (!this.dirty) return;
    this.dirty = false;
    this.renderer.render(this.world, this.camera);
  }
}
