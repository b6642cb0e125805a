// Shows the path in 3-D: pans, turns, zooms, and finds the place under the pointer.
'use strict';

const METHOD_COLOURS = [[23, 87, 194], [196, 77, 22], [20, 130, 90], [140, 70, 170], [150, 120, 20], [200, 50, 110], [70, 90, 110]];
const DETAIL_AFTER = 120; // ms after the last change of view
const NEAR = 14; // pixels within which a click finds the path

class Camera {
  constructor() {
    this.yaw = 0;
    this.pitch = 0;
    this.scale = 1;
    this.middle = [0, 0, 0];
    this.size = [1, 1];
  }
  rows() {
    const a = Math.cos(this.yaw), b = Math.sin(this.yaw), c = Math.cos(this.pitch), d = Math.sin(this.pitch);
    return [[a, -b, 0], [b * c, a * c, -d], [b * d, a * d, c]];
  }
  columns() {
    const r = this.rows();
    return [r[0][0], r[1][0], r[2][0], r[0][1], r[1][1], r[2][1], r[0][2], r[1][2], r[2][2]];
  }
  // Pixels of a place.
  project(place) {
    const r = this.rows(), d = place.map((x, k) => x - this.middle[k]);
    const dot = row => row[0] * d[0] + row[1] * d[1] + row[2] * d[2];
    return [this.size[0] / 2 + dot(r[0]) * this.scale, this.size[1] / 2 - dot(r[1]) * this.scale];
  }
  pan(dx, dy) {
    const r = this.rows();
    for (let k = 0; k < 3; k++) this.middle[k] -= (r[0][k] * dx - r[1][k] * dy) / this.scale;
  }
  zoom(factor, x, y) {
    const dx = x - this.size[0] / 2, dy = y - this.size[1] / 2;
    this.pan(-dx, -dy);
    this.scale = Math.min(1e7, Math.max(1e-4, this.scale * factor));
    this.pan(dx, dy);
  }
  fit(bounds) {
    for (let k = 0; k < 3; k++) this.middle[k] = (bounds.low[k] + bounds.high[k]) / 2;
    this.scale = 1;
    let wide = 1e-9, high = 1e-9;
    for (let corner = 0; corner < 8; corner++) {
      const place = [0, 1, 2].map(k => (corner >> k & 1 ? bounds.high[k] : bounds.low[k]));
      const [x, y] = this.project(place);
      wide = Math.max(wide, Math.abs(x - this.size[0] / 2));
      high = Math.max(high, Math.abs(y - this.size[1] / 2));
    }
    this.scale = 0.86 * Math.min(this.size[0] / 2 / wide, this.size[1] / 2 / high);
  }
}

class View {
  constructor(element, motions, programmed, axes, pick) {
    this.element = element;
    this.motions = motions;
    this.programmed = programmed;
    this.drawn = canvasFor(element);
    this.camera = new Camera();
    this.colour = 0;
    this.chosen = 0;
    this.time = 0;
    const path = programmedMesh(programmed, axes);
    const bounds = boundsOf([path]);
    const extent = Math.max(1e-6, ...bounds.high.map((x, k) => x - bounds.low[k]));
    this.meshes = motions.map(motion => meshOf(motion, extent / 4000));
    this.bounds = boundsOf([path, ...this.meshes]);
    this.path = this.drawn.load(path);
    this.lines = this.meshes.map(mesh => this.drawn.load(mesh));
    this.detail = null;
    this.largest = [0, 1, 2, 3].map(k => Math.max(...this.meshes.map(mesh => mesh.largest[k])));
    this.listen(pick);
    this.resize();
    this.show(false);
  }
  show(turned) {
    this.touched = false;
    [this.camera.yaw, this.camera.pitch] = turned ? [0.6, 0.95] : [0, 0];
    this.camera.fit(this.bounds);
    this.changed();
  }
  fit() { this.touched = false; this.camera.fit(this.bounds); this.changed(); }
  resize() {
    const { element } = this, ratio = devicePixelRatio;
    const before = this.camera.size;
    this.camera.size = [element.clientWidth, element.clientHeight];
    element.width = Math.max(1, Math.round(element.clientWidth * ratio));
    element.height = Math.max(1, Math.round(element.clientHeight * ratio));
    if (!this.touched) this.camera.fit(this.bounds);
    else if (before[0] > 1 && this.camera.size[0] > 1) this.camera.scale *= this.camera.size[0] / before[0];
    this.changed();
  }
  // Draws soon; what is in view is refined when it has stood still.
  changed() {
    this.redraw();
    clearTimeout(this.later);
    this.later = setTimeout(() => this.refine(), DETAIL_AFTER);
  }
  redraw() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => { this.asked = false; this.draw(); });
  }
  draw() {
    const dark = matchMedia('(prefers-color-scheme: dark)').matches;
    this.drawn.begin(this.camera, dark);
    this.drawn.line(this.path, 0, 1, dark ? [110, 120, 135] : [165, 172, 182]);
    if (this.colour === 4) {
      this.lines.forEach((line, i) => this.drawn.line(line, 0, 1, METHOD_COLOURS[i % METHOD_COLOURS.length]));
    } else {
      this.drawn.line(this.detail ?? this.lines[this.chosen], this.colour, this.largest[this.colour]);
    }
    const motion = this.motions[this.chosen], index = spatial(motion.axes), { p } = motion.state(this.time);
    this.drawn.dot(index.map(k => (k < 0 ? 0 : p[k])), [214, 40, 40]);
  }
  // Replaces the vertices of what is in view by finer ones, where zoom shows more than they hold.
  refine() {
    if (this.detail) { this.drawn.drop(this.detail); this.detail = null; }
    const { camera } = this, motion = this.motions[this.chosen];
    const extent = Math.max(1e-6, ...this.bounds.high.map((x, k) => x - this.bounds.low[k]));
    const pixel = 1 / camera.scale;
    if (0.4 * pixel < extent / 4000 && motion instanceof PieceMotion) {
      const [w, h] = camera.size;
      const sees = (from, to, long) => {
        const reach = (long + 2 * pixel) * camera.scale;
        return [from, to].some(place => {
          const [x, y] = camera.project(place);
          return x > -reach && x < w + reach && y > -reach && y < h + reach;
        });
      };
      this.detail = this.drawn.load(meshOf(motion, 0.3 * pixel, sees));
    }
    this.redraw();
  }
  choose(index) { this.chosen = index; this.changed(); }
  // The time of the vertex nearest to a pixel.
  timeAt(x, y) {
    const mesh = this.detail?.mesh ?? this.meshes[this.chosen];
    let best = NEAR * NEAR, time = null;
    for (let i = 0; i < mesh.count; i++) {
      const [a, b] = this.camera.project([mesh.xyz[3 * i], mesh.xyz[3 * i + 1], mesh.xyz[3 * i + 2]]);
      const d = (a - x) ** 2 + (b - y) ** 2;
      if (d < best) { best = d; time = mesh.time[i]; }
    }
    return time;
  }
  listen(pick) {
    const { element, camera } = this;
    let drag = null;
    element.addEventListener('contextmenu', event => event.preventDefault());
    element.addEventListener('pointerdown', event => {
      drag = { x: event.clientX, y: event.clientY, far: 0 };
      element.setPointerCapture(event.pointerId);
    });
    element.addEventListener('pointermove', event => {
      if (!drag) return;
      const dx = event.clientX - drag.x, dy = event.clientY - drag.y;
      drag.x = event.clientX; drag.y = event.clientY; drag.far += Math.abs(dx) + Math.abs(dy);
      this.touched = true;
      if (event.buttons & 2 || event.shiftKey) { camera.yaw += dx * 0.008; camera.pitch += dy * 0.008; } else camera.pan(dx, dy);
      this.changed();
    });
    element.addEventListener('pointerup', event => {
      const click = drag && drag.far < 4;
      drag = null;
      if (!click) return;
      const box = element.getBoundingClientRect();
      const time = this.timeAt(event.clientX - box.left, event.clientY - box.top);
      if (time !== null) pick(time);
    });
    element.addEventListener('wheel', event => {
      event.preventDefault();
      this.touched = true;
      const box = element.getBoundingClientRect();
      camera.zoom(Math.exp(-event.deltaY * 0.0015), event.clientX - box.left, event.clientY - box.top);
      this.changed();
    }, { passive: false });
    element.addEventListener('keydown', event => {
      const step = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      const [w, h] = camera.size;
      if (step && event.shiftKey) { camera.yaw -= 0.1 * step[0]; camera.pitch -= 0.1 * step[1]; }
      else if (step) camera.pan(40 * step[0], 40 * step[1]);
      else if (event.key === '+' || event.key === '=') camera.zoom(1.25, w / 2, h / 2);
      else if (event.key === '-') camera.zoom(0.8, w / 2, h / 2);
      else return;
      event.preventDefault();
      this.touched = true;
      this.changed();
    });
  }
}
