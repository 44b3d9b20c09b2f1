// The bodies in space. Draws only when something has changed.

import {
  AmbientLight, Box3, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, DynamicDrawUsage, LineBasicMaterial,
  LineSegments, Mesh, MeshLambertMaterial, PerspectiveCamera, Plane, Raycaster, Scene, Vector2, Vector3, WebGLRenderer, WebGLRenderTarget,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { bodyOf, boxAround, cornersOf, partOf } from './data.js';
import { colour, element } from './dom.js';
import { SIZE, areHidden, directions, fit } from './views.js';

// Where a picture of pliant's looks from, too.
const TOWARDS_EYE = new Vector3(0.55, 0.45, 1).normalize();
// The edges of a box between its corners; bit k of a corner is its side along axis k.
const EDGES = [0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7];

export class Stage {
  /** Throws where the browser has no WebGL. `picked` is told what is clicked: a body and a triangle, or null. */
  constructor(canvas, { hit, near }, picked, told) {
    this.canvas = canvas;
    this.told = told;
    this.ring = element('div', { className: 'ring', hidden: true });
    this.markers = element('div', { className: 'markers', 'aria-hidden': 'true' });
    this.spot = element('i');
    this.overview = element('div', { className: 'overview', hidden: true, 'aria-hidden': 'true' }, this.spot);
    canvas.after(this.markers, this.ring, this.overview);
    this.far = new PerspectiveCamera(28, 1, 0.01, 100);
    /** Numbers of parts of bodies that are not shown. */
    this.hidden = new Set();
    this.focus = null;
    this.chosenGlass = null;
    this.autoGlass = false;
    this.wireframe = false;
    Object.assign(this, { red: hit, near });
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
    this.controls.addEventListener('start', () => this.takenOver());
    this.controls.addEventListener('end', () => this.seeWhatHides());
    // Scrolling is the page's until somebody has chosen the picture.
    this.controls.enableZoom = false;
    canvas.addEventListener('focus', () => (this.controls.enableZoom = true));
    canvas.addEventListener('blur', () => (this.controls.enableZoom = false));
    this.made = lines(0.6);
    this.notMade = lines(0.28);
    // From a triangle to another that is close to it, whatever is in front.
    this.gaps = lines(0.9);
    this.gaps.material.depthTest = false;
    this.outline = lines(1);
    this.outline.material.depthTest = false;
    this.outline.renderOrder = 3;
    this.bodies = [];
    this.scene.add(this.made, this.notMade, this.gaps, this.outline);
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
    this.hidden = new Set();
    this.focus = null;
    this.autoGlass = false;
    this.frame = this.view = null;
    this.follows = true;
    this.applySeeThrough();
  }

  /** Whether bodies are glass: as somebody has chosen, or because they hide what is looked at. */
  get seeThrough() {
    return this.chosenGlass ?? this.autoGlass;
  }

  /** Whether any part of a body is. */
  isShown(number) {
    return Boolean(this.frame?.shapes[number]) && this.bodies[number].body.parts.some((part) => !this.hidden.has(part.number));
  }

  /** Whether a triangle of a body is, if the body is. */
  isTriangleShown(body, triangle) {
    return this.hidden.size === 0 || !this.hidden.has(partOf(body, triangle).number);
  }

  /** Shows these parts of bodies and no others. */
  hide(numbers) {
    this.hidden = numbers;
    this.bodies.forEach((each) => this.drawShown(each));
    if (this.frame) this.drawHits();
    this.boxesOf(this.level);
    this.showGaps();
    this.seeWhatHides();
    this.draw();
  }

  /** Takes the triangles that are shown of a body. */
  drawShown({ body, mesh, drawn }) {
    const all = [...Array(body.triangles).keys()];
    const shown = all.filter((triangle) => this.isTriangleShown(body, triangle));
    mesh.userData.triangles = shown;
    const { index } = mesh.geometry;
    shown.forEach((triangle, i) => index.array.set(drawn.subarray(3 * triangle, 3 * triangle + 3), 3 * i));
    index.needsUpdate = true;
    mesh.geometry.setDrawRange(0, 3 * shown.length);
  }

  /** Lines between triangles that are shown: of gaps, and where they meet. */
  showGaps() {
    const { bodies } = this.motion;
    const end = (triangles, { part, ...end }) => {
      const { body, vertices } = cornersOf(end, triangles, bodies);
      const { array } = this.bodies[body].position;
      return [0, 1, 2].map((axis) => (1 - part) * array[3 * vertices[0] + axis] + part * array[3 * vertices[1] + axis]);
    };
    const isShown = ({ triangles }) => triangles.every((row) => {
      const { body, triangle } = bodyOf(bodies, row);
      return this.isShown(body) && this.isTriangleShown(bodies[body], triangle);
    });
    const { gaps, lines } = this.frame ?? { gaps: [], lines: [] };
    const met = lines.filter(isShown).flatMap(({ triangles, ends }) => ends.flatMap((each) => end(triangles, each)));
    setLines(this.gaps, new Float32Array([...gaps.filter(isShown).flatMap(({ points }) => points), ...met]));
  }

  body(body) {
    const { drawn, copies, colours } = apart(body);
    const position = new BufferAttribute(new Float32Array(3 * (body.vertices + copies.length)), 3).setUsage(DynamicDrawUsage);
    const make = (corners, ...properties) => {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', position);
      geometry.setIndex(new BufferAttribute(corners, 1));
      const materials = properties.map((each) => new MeshLambertMaterial({ flatShading: true, side: DoubleSide, ...each }));
      const mesh = new Mesh(geometry, materials.length > 1 ? materials : materials[0]);
      mesh.frustumCulled = false;
      this.scene.add(mesh);
      return mesh;
    };
    const mesh = make(drawn.slice(), colours ? { vertexColors: true } : { color: body.parts[0].colour });
    if (colours) mesh.geometry.setAttribute('color', new BufferAttribute(colours, 3));
    // Red triangles are the same triangles once more, in front of themselves.
    // Those that are close and intersect none have a colour of their own.
    const inFront = (hue) => ({
      color: hue, emissive: hue, emissiveIntensity: 0.12,
      polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1,
    });
    // Those of places with a depth have the colour of that. Places share no vertices.
    const deep = this.motion.depths ? [{ ...inFront(0xffffff), emissive: 0, vertexColors: true }] : [];
    const hits = make(new Uint32Array(body.corners.length), inFront(this.red), inFront(this.near), ...deep);
    if (deep.length > 0) hits.geometry.setAttribute('color', new BufferAttribute(new Float32Array(position.array.length), 3));
    hits.renderOrder = 1;
    const made = { body, mesh, hits, position, drawn, copies };
    this.drawShown(made);
    return made;
  }

  /** Brings a frame on stage. */
  set(frame) {
    const before = this.place(this.focus);
    const isSameMoment = frame.moment && frame.moment.contacts === this.frame?.moment?.contacts;
    this.frame = frame;
    this.bodies.forEach(({ body, mesh, position, copies }, number) => {
      if (!frame.shapes[number]) return;
      const { lower, steps } = frame.shapes[number];
      const [out, n] = [position.array, body.vertices];
      for (let i = 0; i < n; i++) {
        for (let axis = 0; axis < 3; axis++) out[3 * i + axis] = lower[axis] + steps[axis * n + i] * body.step;
      }
      copies.forEach((vertex, i) => out.copyWithin(3 * (n + i), 3 * vertex, 3 * vertex + 3));
      position.needsUpdate = true;
      mesh.geometry.boundingSphere = null;
    });
    const red = this.drawHits();
    this.showMarkers();
    this.showGaps();
    const now = this.place(this.focus);
    if (before && now) {
      // The place stays where it is in the picture, wherever its body goes.
      const moved = middle(now).sub(middle(before));
      this.controls.target.add(moved);
      this.camera.position.add(moved);
      this.reach(this.camera, this.controls.target);
      this.controls.update();
    } else if (this.focus !== null && !isSameMoment) {
      // Nothing is left of it, and what was round it may be anywhere.
      this.look();
    } else if (this.focus === null) this.keepInView();
    clearTimeout(this.soon);
    this.soon = setTimeout(() => this.seeWhatHides(), 150);
    this.boxesOf(this.level);
    this.mark(this.marked ?? []);
    return red;
  }

  /** Takes what is red in this frame, and close; says how many triangles are red, shown or not. */
  drawHits() {
    const { frame } = this;
    let [at, red] = [0, 0];
    const near = new Set(frame.near);
    // Numbers of materials.
    const kind = (row) => (near.has(row) ? 1 : frame.deep.has(row) ? 2 : 0);
    this.bodies.forEach(({ body, mesh, hits }, number) => {
      mesh.visible = this.isShown(number);
      const own = [];
      for (; at < frame.red.length && frame.red[at] < body.first + body.triangles; at++) own.push(frame.red[at]);
      red += own.filter((row) => !near.has(row)).length;
      const shown = own.filter((row) => this.isTriangleShown(body, row - body.first));
      const drawn = [0, 1, 2].map((material) => shown.filter((row) => kind(row) === material));
      hits.userData.triangles = drawn.flat().map((row) => row - body.first);
      const { index } = hits.geometry;
      hits.userData.triangles.forEach((triangle, i) => index.array.set(body.corners.subarray(3 * triangle, 3 * triangle + 3), 3 * i));
      index.needsUpdate = true;
      hits.geometry.setDrawRange(0, 3 * shown.length);
      hits.visible = mesh.visible && shown.length > 0;
      hits.geometry.clearGroups();
      let start = 0;
      drawn.forEach((rows, material) => {
        if (rows.length > 0) hits.geometry.addGroup(start, 3 * rows.length, material);
        start += 3 * rows.length;
      });
      this.paint(body, hits.geometry.getAttribute('color'), drawn[2]);
    });
    return red;
  }

  /** Gives triangles the colours of their depths. */
  paint(body, colours, rows) {
    for (const row of rows) {
      const colour = new Color(this.motion.depths.colour(this.frame.deep.get(row)));
      const triangle = 3 * (row - body.first);
      body.corners.subarray(triangle, triangle + 3).forEach((vertex) => colour.toArray(colours.array, 3 * vertex));
    }
    if (rows.length > 0) colours.needsUpdate = true;
  }

  /** The box of all that is shown. */
  bounds() {
    const box = new Box3();
    const one = new Box3();
    this.shownPositions().forEach((positions) => positions.length > 0 && box.union(one.setFromArray(positions)));
    if (box.isEmpty()) box.set(new Vector3(-1, -1, -1), new Vector3(1, 1, 1));
    return box;
  }

  /** The positions of all that is shown. */
  shownPositions() {
    const shown = this.bodies.filter((_, number) => this.isShown(number));
    return shown.map(({ body, mesh, position }) => {
      const { triangles } = mesh.userData;
      if (triangles.length === body.triangles) return position.array;
      const own = triangles.flatMap((triangle) => [...body.corners.subarray(3 * triangle, 3 * triangle + 3)]);
      return own.flatMap((vertex) => [...position.array.subarray(3 * vertex, 3 * vertex + 3)]);
    });
  }

  /** A place of this frame, by its number. */
  place(number) {
    return number === null ? undefined : this.frame?.places.find((place) => place.number === number);
  }

  /** Somebody takes the view into their own hands. */
  takenOver() {
    this.follows = this.isWhole = false;
    cancelAnimationFrame(this.flight);
    this.flight = null;
  }

  /** Goes back where bodies leave the picture, until somebody takes the view into their own hands. Never comes nearer: bodies that grow are seen to grow. */
  keepInView() {
    const now = this.bounds();
    if (!this.view) return this.look();
    const roomy = this.view.clone().expandByScalar(0.06 * this.view.getSize(new Vector3()).length());
    if (!this.follows || roomy.containsBox(now)) return;
    this.view = now.union(this.view);
    this.moveTo(fit([corners(this.view)], TOWARDS_EYE, this.camera), false);
  }

  /** Looks at a place from where most of it is seen; its surroundings fill the rest of the picture. */
  flyTo(number, animated = true) {
    const place = this.place(number);
    if (!place) return;
    this.focus = number;
    this.follows = true;
    const whole = this.bounds().getSize(new Vector3()).length() / 2;
    const at = middle(place);
    const radius = Math.max(1.7 * new Vector3(...place.upper).distanceTo(at), 0.03 * whole, 1e-6);
    const distance = radius / Math.sin(((this.camera.fov * Math.PI) / 360) * Math.min(1, this.camera.aspect));
    const towards = this.bestDirection(place, at, distance);
    // A place as large as everything needs no more room than that.
    const all = fit(this.shownPositions(), towards, this.camera);
    const isNearer = all.position.clone().sub(at).dot(towards) < distance;
    this.isWhole = isNearer;
    this.moveTo(isNearer ? all : { target: at, position: towards.clone().multiplyScalar(distance).add(at) }, animated);
    if (!animated) this.seeWhatHides();
    this.told();
  }

  /** From the usual side, unless more of the place is seen from another. */
  bestDirection(place, at, distance) {
    let [best, most] = [TOWARDS_EYE, 0];
    for (const towards of directions(TOWARDS_EYE)) {
      const eye = this.camera.clone();
      eye.position.copy(towards).multiplyScalar(distance).add(at);
      eye.lookAt(at);
      this.reach(eye, at);
      const { all, seen } = this.visible(place, eye);
      if (towards === TOWARDS_EYE && seen > 0.5 * all) return towards;
      if (seen > 1.2 * most) [best, most] = [towards, seen];
    }
    return best;
  }

  /** How many pixels of a small picture the hits of a place have, and how many of them nothing hides. */
  visible(place, eye) {
    this.small ??= new WebGLRenderTarget(SIZE, SIZE);
    const [low, high] = [place.lower, place.upper].map((corner) => new Vector3(...corner));
    const planes = ['x', 'y', 'z'].flatMap((axis) => {
      const normal = new Vector3();
      normal[axis] = 1;
      const room = 1e-4 + 1e-3 * (high[axis] - low[axis]);
      return [new Plane(normal, room - low[axis]), new Plane(normal.clone().negate(), high[axis] + room)];
    });
    const others = [this.made, this.notMade, this.gaps, this.outline].filter((object) => object.visible);
    others.forEach((object) => (object.visible = false));
    const count = (withBodies) => {
      this.bodies.forEach(({ mesh, hits }, number) => {
        mesh.visible = withBodies && this.isShown(number);
        Object.assign(mesh.material, { transparent: false, opacity: 1, depthWrite: true, colorWrite: false, wireframe: false });
        hits.material.forEach((material) => (material.clippingPlanes = planes));
      });
      this.renderer.localClippingEnabled = true;
      this.renderer.setRenderTarget(this.small);
      this.renderer.render(this.scene, eye);
      const pixels = new Uint8Array(4 * SIZE * SIZE);
      this.renderer.readRenderTargetPixels(this.small, 0, 0, SIZE, SIZE, pixels);
      this.renderer.setRenderTarget(null);
      let met = 0;
      for (let i = 3; i < pixels.length; i += 4) met += pixels[i] > 0;
      return met;
    };
    const [all, seen] = [count(false), count(true)];
    this.renderer.localClippingEnabled = false;
    this.bodies.forEach(({ mesh, hits }, number) => {
      mesh.visible = this.isShown(number);
      mesh.material.colorWrite = true;
      hits.material.forEach((material) => (material.clippingPlanes = null));
    });
    others.forEach((object) => (object.visible = true));
    this.applySeeThrough();
    return { all, seen };
  }

  /** Bodies turn to glass where they hide the place that is looked at. */
  seeWhatHides() {
    if (!this.frame) return;
    const place = this.place(this.focus);
    const before = this.autoGlass;
    if (place && !this.flight) {
      this.reach(this.camera, this.controls.target);
      this.autoGlass = areHidden(this.visible(place, this.camera));
    } else if (this.focus === null) this.autoGlass = false;
    if (before !== this.autoGlass) this.applySeeThrough();
    this.told();
    this.draw();
  }

  /** Brings the eye somewhere, by and by unless somebody wants less motion. */
  moveTo({ target, position }, animated = true) {
    cancelAnimationFrame(this.flight);
    this.flight = null;
    const [from, at] = [this.camera.position.clone().sub(this.controls.target), this.controls.target.clone()];
    const to = position.clone().sub(target);
    const arrive = (part) => {
      const distance = from.length() ** (1 - part) * to.length() ** part;
      const towards = from.clone().normalize().lerp(to.clone().normalize(), part);
      if (towards.lengthSq() < 1e-6) towards.copy(to);
      this.controls.target.copy(at).lerp(target, part);
      this.camera.position.copy(towards.setLength(distance)).add(this.controls.target);
      this.reach(this.camera, this.controls.target);
      this.controls.update();
      this.draw();
    };
    if (!animated || from.lengthSq() === 0 || matchMedia('(prefers-reduced-motion: reduce)').matches) {
      arrive(1);
      return;
    }
    const begun = performance.now();
    const go = () => {
      const part = Math.min(1, (performance.now() - begun) / 450);
      arrive(part * part * (3 - 2 * part));
      this.flight = part < 1 ? requestAnimationFrame(go) : null;
      if (part === 1) this.seeWhatHides();
    };
    this.flight = requestAnimationFrame(go);
  }

  /** What is near and far enough to be drawn. */
  reach(eye, target) {
    const distance = eye.position.distanceTo(target);
    const whole = this.bounds();
    const far = whole.getCenter(new Vector3()).distanceTo(eye.position) + whole.getSize(new Vector3()).length();
    Object.assign(eye, { near: Math.max(distance / 40, far / 20000), far: Math.max(2 * distance, far) });
    eye.updateProjectionMatrix();
    eye.updateMatrixWorld();
  }

  /** Shows the boxes of a level, or none; says how many there are and how many were made. */
  boxesOf(level) {
    this.level = level;
    const [made, notMade] = [[], []];
    if (level !== null && level !== undefined && this.frame) {
      let bit = 0;
      this.bodies.forEach(({ body, position }, number) => {
        body.starts.forEach((starts, of) => {
          const shown = this.isShown(number) && of === Math.min(level, body.starts.length - 1);
          for (let part = 0; part < starts.length; part++, bit++) {
            if (!shown) continue;
            const isMade = (this.frame.made[bit >> 3] >> (bit & 7)) & 1;
            const end = part + 1 < starts.length ? starts[part + 1] : body.triangles;
            (isMade ? made : notMade).push(boxAround(body, position.array, starts[part], end));
          }
        });
      });
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
    this.chosenGlass = !this.seeThrough;
    this.applySeeThrough();
    this.draw();
    this.told();
  }

  toggleWireframe() {
    this.wireframe = !this.wireframe;
    this.applySeeThrough();
    this.draw();
    return this.wireframe;
  }

  applySeeThrough() {
    for (const { mesh } of this.bodies) {
      const glass = this.seeThrough;
      Object.assign(mesh.material, { transparent: glass, opacity: glass ? 0.22 : 1, depthWrite: !glass, wireframe: this.wireframe });
      mesh.material.needsUpdate = true;
    }
  }

  /** Looks at all of this frame that is shown, from where a picture does. */
  look() {
    this.view = this.bounds();
    this.follows = true;
    this.focus = null;
    this.autoGlass = false;
    this.applySeeThrough();
    this.moveTo(fit(this.shownPositions(), TOWARDS_EYE, this.camera), false);
    this.told();
  }

  /** Turns round the middle, by angles; comes nearer by a factor. */
  turn(around, up, nearer = 1) {
    this.takenOver();
    const from = this.camera.position.clone().sub(this.controls.target);
    const distance = from.length() / nearer;
    const azimuth = Math.atan2(from.x, from.z) + around;
    const height = Math.max(-1.5, Math.min(1.5, Math.asin(from.y / from.length()) + up));
    from.set(Math.sin(azimuth) * Math.cos(height), Math.sin(height), Math.cos(azimuth) * Math.cos(height));
    this.camera.position.copy(from.multiplyScalar(distance).add(this.controls.target));
    this.reach(this.camera, this.controls.target);
    this.controls.update();
    clearTimeout(this.soon);
    this.soon = setTimeout(() => this.seeWhatHides(), 150);
  }

  recolour() {
    this.made.material.color.set(colour('box-made'));
    this.notMade.material.color.set(colour('box'));
    this.gaps.material.color.set(colour('ink'));
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
    if (this.follows && this.view && this.focus === null) this.moveTo(fit(this.shownPositions(), TOWARDS_EYE, this.camera), false);
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
    this.placeMarkers();
    this.renderOverview();
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

  /** Everything, small in a corner, with the place that is looked at; nothing where everything is in the picture anyway. */
  renderOverview() {
    const place = this.place(this.focus);
    this.overview.hidden = !place || this.isWhole;
    if (this.overview.hidden) return;
    const { offsetLeft: left, clientWidth: width, clientHeight: height } = this.overview;
    const bottom = this.canvas.clientHeight - this.overview.offsetTop - height - 1;
    // From the side that the place is seen from, a little from above.
    const towards = this.camera.position.clone().sub(this.controls.target).setY(0).normalize().add(new Vector3(0, 0.3, 0)).normalize();
    this.far.aspect = width / height;
    const { target, position } = fit(this.shownPositions(), towards, this.far);
    this.far.position.copy(position);
    this.far.lookAt(target);
    this.reach(this.far, target);
    const lines = [this.made, this.notMade, this.gaps, this.outline].filter((object) => object.visible);
    lines.forEach((object) => (object.visible = false));
    this.renderer.setScissorTest(true);
    this.renderer.setScissor(left + 1, bottom, width, height);
    this.renderer.setViewport(left + 1, bottom, width, height);
    this.renderer.render(this.scene, this.far);
    this.renderer.setScissorTest(false);
    this.renderer.setViewport(0, 0, this.canvas.clientWidth, this.canvas.clientHeight);
    lines.forEach((object) => (object.visible = true));
    const seen = middle(place).project(this.far);
    this.spot.style.transform = `translate(${(0.5 + 0.5 * seen.x) * width}px, ${(0.5 - 0.5 * seen.y) * height}px)`;
  }

  /** A marker for each place of the frame. */
  showMarkers() {
    this.markers.replaceChildren(...this.frame.places.map(({ depth }) => {
      const marker = element('i');
      if (depth !== null) marker.style.setProperty('--hue', this.motion.depths.colour(depth));
      return marker;
    }));
  }

  /** Markers have the same size on the screen, and are there for places that are too small to be seen at once. */
  placeMarkers() {
    if (!this.frame) return;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.marks = this.frame.places.map((place, i) => {
      const at = middle(place);
      const radius = new Vector3(...place.upper).distanceTo(at);
      const seen = at.clone().project(this.camera);
      const depth = at.distanceTo(this.camera.position);
      const size = (radius / depth / Math.tan((this.camera.fov * Math.PI) / 360)) * height;
      const marker = this.markers.children[i];
      marker.hidden = size > 44 || Math.abs(seen.z) > 1 || Math.abs(seen.x) > 1 || Math.abs(seen.y) > 1;
      const [x, y] = [(0.5 + 0.5 * seen.x) * width, (0.5 - 0.5 * seen.y) * height];
      marker.style.transform = `translate(${x}px, ${y}px)`;
      marker.classList.toggle('focus', place.number === this.focus);
      return marker.hidden ? null : { x, y, number: place.number };
    });
  }

  /** The place whose marker is there. */
  markerAt(x, y) {
    const near = (this.marks ?? []).filter((mark) => mark && Math.hypot(mark.x - x, mark.y - y) < 12);
    return near.length > 0 ? near[0].number : null;
  }

  listen(picked) {
    this.canvas.addEventListener('dblclick', (event) => {
      const nearest = this.nearest(this.pointed(event));
      if (!nearest) return;
      const from = this.camera.position.clone().sub(this.controls.target);
      this.takenOver();
      this.moveTo({ target: nearest.point, position: from.add(nearest.point) });
    });
    let down = null;
    this.canvas.addEventListener('pointerdown', (event) => {
      down = [event.clientX, event.clientY];
      this.canvas.focus({ preventScroll: true });
    });
    this.canvas.addEventListener('pointerup', (event) => {
      // A click, not the end of a turn.
      if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
      picked(this.at(this.pointed(event)));
      const box = this.canvas.getBoundingClientRect();
      const number = this.markerAt(event.clientX - box.left, event.clientY - box.top);
      if (number !== null) this.flyTo(number);
    });
  }

  /** Where the pointer is, from -1 to 1. */
  pointed(event) {
    const box = this.canvas.getBoundingClientRect();
    return new Vector2((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height);
  }

  nearest(point) {
    const ray = new Raycaster();
    ray.setFromCamera(point, this.camera);
    // Through what one sees through, only red triangles are met.
    const meshes = this.bodies.map(({ mesh, hits }) => (this.seeThrough ? hits : mesh)).filter((mesh) => mesh.visible);
    for (const mesh of meshes) mesh.geometry.boundingSphere = null;
    return ray.intersectObjects(meshes, false)[0];
  }

  at(point) {
    const nearest = this.nearest(point);
    if (!nearest) return null;
    const body = this.bodies.findIndex(({ mesh, hits }) => nearest.object === mesh || nearest.object === hits);
    return { body, triangle: nearest.object.userData.triangles[nearest.faceIndex] };
  }
}

/**
 * Corners as they are drawn, and the colours of vertices, of a body in several parts. A vertex of several parts is there once for
 * each: behind all vertices are `copies` of some.
 */
function apart(body) {
  if (body.parts.length === 1) return { drawn: body.corners, copies: [], colours: null };
  const [drawn, copies, copyOf] = [body.corners.slice(), [], new Map()];
  const own = new Int32Array(body.vertices).fill(-1);
  const parts = [];
  drawn.forEach((vertex, corner) => {
    const part = body.partOf[Math.floor(corner / 3)];
    if (own[vertex] < 0) own[vertex] = part;
    if (own[vertex] === part) return;
    const key = part * body.vertices + vertex;
    if (!copyOf.has(key)) {
      copyOf.set(key, body.vertices + copies.length);
      copies.push(vertex);
      parts.push(part);
    }
    drawn[corner] = copyOf.get(key);
  });
  const colours = new Float32Array(3 * (body.vertices + copies.length));
  const hues = body.parts.map(({ colour }) => new Color(colour));
  [...own, ...parts].forEach((part, vertex) => part >= 0 && hues[part].toArray(colours, 3 * vertex));
  return { drawn, copies, colours };
}

function middle({ lower, upper }) {
  return new Vector3(...lower).add(new Vector3(...upper)).multiplyScalar(0.5);
}

/** The corners of a box, as positions. */
function corners({ min, max }) {
  const all = [];
  for (let corner = 0; corner < 8; corner++) {
    for (let axis = 0; axis < 3; axis++) all.push(((corner >> axis) & 1 ? max : min).getComponent(axis));
  }
  return all;
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
