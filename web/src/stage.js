// The bodies in space. Draws only when something has changed.

import {
  AmbientLight, Box3, BufferAttribute, BufferGeometry, DirectionalLight, DoubleSide, DynamicDrawUsage, LineBasicMaterial,
  LineSegments, Mesh, MeshLambertMaterial, PerspectiveCamera, Raycaster, Scene, Vector2, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { boxAround } from './data.js';
import { colour, element } from './dom.js';

// Where a picture of pliant's looks from, too.
const TOWARDS_EYE = new Vector3(0.55, 0.45, 1).normalize();
// The edges of a box between its corners; bit k of a corner is its side along axis k.
const EDGES = [0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7];

export class Stage {
  /** Throws where the browser has no WebGL. `picked` is told what is clicked: a body and a triangle, or null. */
  constructor(canvas, red, picked) {
    this.canvas = canvas;
    this.ring = element('div', { className: 'ring', hidden: true });
    canvas.after(this.ring);
    this.red = red;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(28, 1, 0.01, 100);
    this.scene.add(this.camera, new AmbientLight(0xffffff, 1.3));
    // The light comes with the eye, a little from its upper left.
    const light = new DirectionalLight(0xffffff, 2.2);
    light.position.set(-0.3, 0.4, 1);
    this.camera.add(light);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.controls.addEventListener('start', () => (this.follows = false));
    // Scrolling is the page's until somebody has chosen the picture.
    this.controls.enableZoom = false;
    canvas.addEventListener('focus', () => (this.controls.enableZoom = true));
    canvas.addEventListener('blur', () => (this.controls.enableZoom = false));
    this.made = lines(0.6);
    this.notMade = lines(0.28);
    this.outline = lines(1);
    this.outline.material.depthTest = false;
    this.outline.renderOrder = 3;
    this.bodies = [];
    this.seeThrough = false;
    this.scene.add(this.made, this.notMade, this.outline);
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.listen(picked);
    this.recolour();
  }

  /** Replaces what is on stage. */
  show(motion) {
    for (const { mesh, hits } of this.bodies) {
      this.scene.remove(mesh, hits);
      mesh.geometry.dispose();
      hits.geometry.dispose();
    }
    this.motion = motion;
    this.bodies = motion.bodies.map((body) => this.body(body));
    this.applySeeThrough();
    this.frame = this.view = null;
    this.follows = true;
  }

  body(body) {
    const position = new BufferAttribute(new Float32Array(3 * body.vertices), 3).setUsage(DynamicDrawUsage);
    const make = (corners, properties) => {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', position);
      geometry.setIndex(new BufferAttribute(corners, 1));
      const mesh = new Mesh(geometry, new MeshLambertMaterial({ flatShading: true, side: DoubleSide, ...properties }));
      mesh.frustumCulled = false;
      this.scene.add(mesh);
      return mesh;
    };
    const mesh = make(body.corners, { color: body.colour });
    // Red triangles are the same triangles once more, in front of themselves.
    const hits = make(new Uint32Array(body.corners.length), {
      color: this.red, emissive: this.red, emissiveIntensity: 0.12,
      polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1,
    });
    hits.renderOrder = 1;
    return { body, mesh, hits, position };
  }

  /** Brings a frame on stage. */
  set(frame) {
    this.frame = frame;
    let [at, red] = [0, 0];
    this.bodies.forEach(({ body, mesh, hits, position }, number) => {
      const { lower, steps } = frame.shapes[number];
      const [out, n] = [position.array, body.vertices];
      for (let i = 0; i < n; i++) {
        for (let axis = 0; axis < 3; axis++) out[3 * i + axis] = lower[axis] + steps[axis * n + i] * body.step;
      }
      position.needsUpdate = true;
      mesh.geometry.boundingSphere = null;
      const index = hits.geometry.index;
      let length = 0;
      for (; at < frame.red.length && frame.red[at] < body.first + body.triangles; at++) {
        const triangle = frame.red[at] - body.first;
        for (let corner = 0; corner < 3; corner++) index.array[length++] = body.corners[3 * triangle + corner];
      }
      index.needsUpdate = true;
      hits.geometry.setDrawRange(0, length);
      hits.visible = length > 0;
      red += length / 3;
    });
    this.keepInView();
    this.boxesOf(this.level);
    this.mark(this.marked ?? []);
    return red;
  }

  /** The box of all bodies. */
  bounds() {
    const box = new Box3();
    for (const { position } of this.bodies) box.union(new Box3().setFromBufferAttribute(position));
    return box;
  }

  /** Goes back where bodies leave the picture, until somebody takes the view into their own hands. Never comes nearer: bodies that grow are seen to grow. */
  keepInView() {
    const now = this.bounds();
    if (!this.view) return this.look();
    const roomy = this.view.clone().expandByScalar(0.06 * this.view.getSize(new Vector3()).length());
    if (!this.follows || roomy.containsBox(now)) return;
    this.look(now.union(this.view));
  }

  /** Shows the boxes of a level, or none; says how many there are and how many were made. */
  boxesOf(level) {
    this.level = level;
    const [made, notMade] = [[], []];
    if (level !== null && level !== undefined && this.frame) {
      let bit = 0;
      for (const { body, position } of this.bodies) {
        body.starts.forEach((starts, of) => {
          const shown = of === Math.min(level, body.starts.length - 1);
          for (let part = 0; part < starts.length; part++, bit++) {
            if (!shown) continue;
            const isMade = (this.frame.made[bit >> 3] >> (bit & 7)) & 1;
            const end = part + 1 < starts.length ? starts[part + 1] : body.triangles;
            (isMade ? made : notMade).push(boxAround(body, position.array, starts[part], end));
          }
        });
      }
    }
    setBoxes(this.made, made);
    setBoxes(this.notMade, notMade);
    this.draw();
    return { all: made.length + notMade.length, made: made.length };
  }

  /** Outlines triangles: each a body and a triangle of it. */
  mark(triangles) {
    this.marked = triangles;
    const points = triangles.flatMap(({ body, triangle }) => {
      const { body: facts, position } = this.bodies[body];
      const corners = [0, 1, 2].map((corner) => {
        const vertex = facts.corners[3 * triangle + corner];
        return [...position.array.subarray(3 * vertex, 3 * vertex + 3)];
      });
      return [corners[0], corners[1], corners[1], corners[2], corners[2], corners[0]].flat();
    });
    setLines(this.outline, new Float32Array(points));
    this.draw();
  }

  toggleSeeThrough() {
    this.seeThrough = !this.seeThrough;
    this.applySeeThrough();
    this.draw();
    return this.seeThrough;
  }

  applySeeThrough() {
    for (const { mesh } of this.bodies) {
      Object.assign(mesh.material, { transparent: this.seeThrough, opacity: this.seeThrough ? 0.22 : 1, depthWrite: !this.seeThrough });
      mesh.material.needsUpdate = true;
    }
  }

  /** Looks at all of this frame, or of a box, from where a picture does. */
  look(box = this.bounds()) {
    this.view = box;
    this.follows = true;
    const radius = Math.max(box.getSize(new Vector3()).length() / 2, 1e-6);
    box.getCenter(this.controls.target);
    // As near as the corners of the box allow.
    const up = Math.tan((this.camera.fov * Math.PI) / 360);
    const across = up * this.camera.aspect;
    const right = new Vector3(0, 1, 0).cross(TOWARDS_EYE).normalize();
    const above = TOWARDS_EYE.clone().cross(right);
    let distance = 0;
    for (let corner = 0; corner < 8; corner++) {
      const at = new Vector3(...[0, 1, 2].map((axis) => ((corner >> axis) & 1 ? box.max : box.min).getComponent(axis))).sub(this.controls.target);
      const aside = Math.max(Math.abs(at.dot(right)) / across, Math.abs(at.dot(above)) / up);
      distance = Math.max(distance, at.dot(TOWARDS_EYE) + aside);
    }
    this.camera.position.copy(TOWARDS_EYE).multiplyScalar(Math.max(distance, 1e-6)).add(this.controls.target);
    Object.assign(this.camera, { near: radius / 50, far: radius * 60 });
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  /** Turns round the middle, by angles; comes nearer by a factor. */
  turn(around, up, nearer = 1) {
    this.follows = false;
    const from = this.camera.position.clone().sub(this.controls.target);
    const distance = from.length() / nearer;
    const azimuth = Math.atan2(from.x, from.z) + around;
    const height = Math.max(-1.5, Math.min(1.5, Math.asin(from.y / from.length()) + up));
    from.set(Math.sin(azimuth) * Math.cos(height), Math.sin(height), Math.cos(azimuth) * Math.cos(height));
    this.camera.position.copy(from.multiplyScalar(distance).add(this.controls.target));
    this.controls.update();
  }

  recolour() {
    this.made.material.color.set(colour('box-made'));
    this.notMade.material.color.set(colour('box'));
    this.outline.material.color.set(colour('ink'));
    this.draw();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.follows && this.view) this.look(this.view);
    this.render();
  }

  /** At the next opportunity. */
  draw() {
    this.due ??= requestAnimationFrame(() => {
      this.due = null;
      this.render();
    });
  }

  render() {
    this.renderer.render(this.scene, this.camera);
    // A ring where the chosen triangle is: it may be too small to be seen, or behind others.
    const points = this.outline.geometry.getAttribute('position');
    this.ring.hidden = !this.outline.visible;
    if (this.ring.hidden) return;
    const middle = new Vector3();
    for (const corner of [0, 2, 4]) middle.add(new Vector3().fromBufferAttribute(points, corner));
    middle.divideScalar(3).project(this.camera);
    this.ring.style.left = `${50 + 50 * middle.x}%`;
    this.ring.style.top = `${50 - 50 * middle.y}%`;
  }

  listen(picked) {
    let down = null;
    this.canvas.addEventListener('pointerdown', (event) => {
      down = [event.clientX, event.clientY];
      this.canvas.focus({ preventScroll: true });
    });
    this.canvas.addEventListener('pointerup', (event) => {
      // A click, not the end of a turn.
      if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
      const box = this.canvas.getBoundingClientRect();
      const at = new Vector2(
        (2 * (event.clientX - box.left)) / box.width - 1,
        1 - (2 * (event.clientY - box.top)) / box.height,
      );
      picked(this.at(at));
    });
  }

  at(point) {
    const ray = new Raycaster();
    ray.setFromCamera(point, this.camera);
    // Through what one sees through, only red triangles are met.
    const meshes = this.bodies.map(({ mesh, hits }) => (this.seeThrough ? hits : mesh)).filter((mesh) => mesh.visible);
    for (const mesh of meshes) mesh.geometry.boundingSphere = null;
    const [nearest] = ray.intersectObjects(meshes, false);
    if (!nearest) return null;
    const body = this.bodies.findIndex(({ mesh, hits }) => nearest.object === mesh || nearest.object === hits);
    if (!this.seeThrough) return { body, triangle: nearest.faceIndex };
    const { first, triangles } = this.bodies[body].body;
    const own = this.frame.red.filter((triangle) => triangle >= first && triangle < first + triangles);
    return { body, triangle: own[nearest.faceIndex] - first };
  }
}

function lines(opacity) {
  const made = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ transparent: true, opacity }));
  made.frustumCulled = false;
  made.renderOrder = 2;
  return made;
}

function setLines(object, points) {
  object.geometry.dispose();
  object.geometry = new BufferGeometry();
  object.geometry.setAttribute('position', new BufferAttribute(points, 3));
  object.visible = points.length > 0;
}

function setBoxes(object, boxes) {
  const points = new Float32Array(boxes.length * EDGES.length * 3);
  let at = 0;
  for (const box of boxes) {
    for (const corner of EDGES) {
      for (let axis = 0; axis < 3; axis++) points[at++] = box[axis + 3 * ((corner >> axis) & 1)];
    }
  }
  setLines(object, points);
}
