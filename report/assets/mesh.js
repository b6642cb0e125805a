// Turns a motion into a line of vertices with a time, a place and values to colour it by.
'use strict';

const VALUES = 4; // speed, acceleration, jerk, deviation

class Mesh {
  constructor() {
    this.xyz = [];
    this.values = [];
    this.time = [];
    this.largest = [0, 0, 0, 0];
  }
  // A vertex; a rapid has no values, and no part in their scale.
  add(time, place, values, rapid) {
    this.time.push(time);
    this.xyz.push(place[0], place[1], place[2]);
    for (let k = 0; k < VALUES; k++) {
      this.values.push(rapid ? -1 : values[k]);
      if (!rapid && values[k] > this.largest[k]) this.largest[k] = values[k];
    }
  }
  close() {
    this.xyz = new Float32Array(this.xyz);
    this.values = new Float32Array(this.values);
    this.time = new Float64Array(this.time);
    this.count = this.time.length;
    return this;
  }
}

// X, Y and Z of a motion or path, where the machine has them.
function spatial(axes) {
  const index = 'XYZ'.split('').map(letter => axes.findIndex(axis => axis.name === letter));
  return index.some(k => k >= 0) ? index : [0, 1, 2].map(k => (k < axes.length ? k : -1));
}

// The motion within a sagitta, mm; with `sees`, only pieces that it says are in view.
function meshOf(motion, sagitta, sees, most = 400000) {
  const mesh = new Mesh(), index = spatial(motion.axes);
  const at = state => index.map(k => (k < 0 ? 0 : state.p[k]));
  const values = state => [state.speed, Math.hypot(...state.a), Math.hypot(...state.j), state.deviation];
  if (motion instanceof EnvelopeMotion) {
    for (let i = 0; i < motion.n; i++) {
      const state = motion.state(i * motion.width);
      mesh.add(i * motion.width, at(state), values(state), motion.programmed.isRapid(state.move));
    }
    return mesh.close();
  }
  let gap = true;
  for (let i = 0; i < motion.n && mesh.time.length < most; i++) {
    const place = end => index.map(k => (k < 0 ? 0 : motion.p[k][i + end]));
    const from = place(0), to = place(1);
    const long = Math.hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
    if (sees && !sees(from, to, long)) {
      gap = true;
      continue;
    }
    const bend = Math.hypot(...motion.axes.map((_, k) =>
      Math.abs(motion.a[k][i]) + Math.abs(motion.j[k][i]) * motion.dt[i]));
    const steps = Math.min(24, Math.max(1, Math.ceil(Math.sqrt(bend * motion.dt[i] ** 2 / (8 * sagitta)))));
    const rapid = motion.programmed.isRapid(motion.move[i]);
    const end = motion.t[i + 1];
    if (gap && sees) {
      // A vertex without values separates what is not joined.
      mesh.add(motion.t[i], from, null, true);
    }
    gap = false;
    for (let s = mesh.time.length && !sees ? 1 : 0; s <= steps; s++) {
      if (s === 0 || s === steps || steps > 1) {
        const time = s === steps ? end - 1e-12 : motion.t[i] + motion.dt[i] * s / steps;
        const state = motion.state(time);
        mesh.add(time, at(state), values(state), rapid);
      }
    }
  }
  return mesh.close();
}

// The programmed path as a line of vertices.
function programmedMesh(programmed, axes) {
  const index = spatial(axes), mesh = new Mesh();
  const count = programmed.points[0]?.length ?? 0;
  for (let i = 0; i < count; i++) {
    mesh.add(0, index.map(k => (k < 0 ? 0 : programmed.points[k][i])), null, true);
  }
  return mesh.close();
}

// The box around vertices.
function boundsOf(meshes) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const mesh of meshes) {
    for (let i = 0; i < mesh.xyz.length; i++) {
      const k = i % 3, x = mesh.xyz[i];
      if (x < low[k]) low[k] = x;
      if (x > high[k]) high[k] = x;
    }
  }
  return low[0] > high[0] ? { low: [0, 0, 0], high: [0, 0, 0] } : { low, high };
}
