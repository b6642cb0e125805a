// Decodes the packed columns and evaluates the motion at any time.
'use strict';

const AT_ONCE = 64; // pieces of a block whose extremes are kept

async function unpack() {
  const meta = JSON.parse(document.getElementById('meta').textContent);
  const text = document.getElementById('data').textContent.trim();
  const packed = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const columns = {};
  let at = 0;
  for (const column of meta.columns) {
    columns[column.name] = decode(column, bytes.subarray(at, at + column.bytes));
    at += column.bytes;
  }
  meta.program = new TextDecoder('utf-8').decode(bytes.subarray(at, at + meta.text));
  document.getElementById('data').textContent = '';
  return { meta, columns };
}

function decode(column, bytes) {
  const n = column.count;
  if (column.kind === 'delta') {
    const out = new Float64Array(n), step = column.step ?? 1;
    let at = 0, value = 0;
    for (let i = 0; i < n; i++) {
      let zigzag = 0, scale = 1, byte;
      do {
        byte = bytes[at++];
        zigzag += (byte & 127) * scale;
        scale *= 128;
      } while (byte & 128);
      value += zigzag % 2 ? -(zigzag + 1) / 2 : zigzag / 2;
      out[i] = value;
    }
    if (step !== 1) {
      const inverse = Math.round(1 / step); // dividing by a whole number rounds once
      for (let i = 0; i < n; i++) out[i] /= inverse;
    }
    return out;
  }
  const raw = new Uint8Array(4 * n);
  for (let plane = 0; plane < 4; plane++) {
    for (let i = 0, from = plane * n, to = plane; i < n; i++, to += 4) raw[to] = bytes[from + i];
  }
  return new Float32Array(raw.buffer);
}

// What the page knows of the path: lines, feedrates and tolerances of moves, and points to draw.
class Programmed {
  constructor(columns, axes) {
    this.line = columns.line;
    this.feedrate = columns.feedrate; // 0 for a rapid
    this.tolerance = columns.tolerance;
    this.points = axes.map((_, k) => columns['path' + k]);
  }
  isRapid(move) { return this.feedrate[move] === 0; }
}

// A motion of pieces of constant jerk.
class PieceMotion {
  constructor(facts, columns, prefix, programmed, axes) {
    this.facts = facts;
    this.programmed = programmed;
    this.axes = axes;
    const ends = columns[prefix + 't'];
    this.n = ends.length;
    this.t = new Float64Array(this.n + 1);
    this.t.set(ends, 1);
    this.dt = Float64Array.from(ends, (end, i) => end - this.t[i]);
    this.move = columns[prefix + 'move'];
    const each = letter => axes.map((_, k) => columns[prefix + letter + k]);
    this.p = each('p'); this.v = each('v'); this.a = each('a'); this.j = each('j');
    this.d = columns[prefix + 'd'];
    this.blocks = new Map();
    this.duration = this.t[this.n];
  }
  // The piece at a time.
  find(time) {
    let low = 0, high = this.n - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.t[middle] <= time) low = middle; else high = middle - 1;
    }
    return low;
  }
  // Position of an axis in a piece: its cubic, with what rounding left at its end spread over it.
  position(k, i, d) {
    const v = this.v[k][i], a = this.a[k][i], j = this.j[k][i], whole = this.dt[i];
    const cubic = x => (v + (a / 2 + j * x / 6) * x) * x;
    const off = this.p[k][i + 1] - this.p[k][i] - cubic(whole);
    return this.p[k][i] + cubic(d) + (whole > 0 ? off * d / whole : 0);
  }
  state(time) {
    if (this.n === 0) return this.rest();
    const i = this.find(time), d = Math.min(Math.max(time - this.t[i], 0), this.dt[i]);
    const at = { piece: i, move: this.move[i], p: [], v: [], a: [], j: [], deviation: this.d[i] };
    for (let k = 0; k < this.axes.length; k++) {
      const a = this.a[k][i], j = this.j[k][i];
      at.p.push(this.position(k, i, d));
      at.v.push(this.v[k][i] + (a + j * d / 2) * d);
      at.a.push(a + j * d);
      at.j.push(j);
    }
    at.speed = Math.hypot(...at.v);
    return at;
  }
  rest() {
    const zero = this.axes.map(() => 0);
    const p = this.programmed.points.map(axis => axis[0] ?? 0);
    return { piece: 0, move: 0, p, v: zero, a: zero, j: zero, deviation: 0, speed: 0 };
  }
  // Least and greatest value of a curve inside a piece, between two times since its start.
  range(curve, k, i, from, to, out) {
    if (curve === 'd') { note(out, this.d[i]); return; }
    if (curve === 'j') { note(out, this.j[k][i]); return; }
    if (curve === 'a') {
      note(out, this.a[k][i] + this.j[k][i] * from);
      note(out, this.a[k][i] + this.j[k][i] * to);
      return;
    }
    if (curve === 'v') {
      const v = this.v[k][i], a = this.a[k][i], j = this.j[k][i], top = -a / j;
      note(out, v + (a + j * from / 2) * from);
      note(out, v + (a + j * to / 2) * to);
      if (top > from && top < to) note(out, v + a * top / 2);
      return;
    }
    for (let s = 0; s <= 4; s++) {
      const d = from + (to - from) * s / 4;
      let sum = 0;
      for (let axis = 0; axis < this.axes.length; axis++) {
        const v = this.v[axis][i] + (this.a[axis][i] + this.j[axis][i] * d / 2) * d;
        sum += v * v;
      }
      note(out, Math.sqrt(sum));
    }
  }
  // Extremes of whole blocks of pieces, made once a curve.
  blocksOf(curve, k) {
    const key = curve + k;
    if (!this.blocks.has(key)) {
      const count = Math.ceil(this.n / AT_ONCE), low = new Float32Array(count), high = new Float32Array(count);
      for (let b = 0; b < count; b++) {
        const out = [Infinity, -Infinity];
        const end = Math.min(this.n, (b + 1) * AT_ONCE);
        for (let i = b * AT_ONCE; i < end; i++) this.range(curve, k, i, 0, this.dt[i], out);
        [low[b], high[b]] = out;
      }
      this.blocks.set(key, [low, high]);
    }
    return this.blocks.get(key);
  }
  // Least and greatest value of a curve between two times.
  extremes(curve, k, begin, end) {
    const out = [Infinity, -Infinity];
    let i = this.find(begin);
    const last = this.find(end);
    const inside = (i, from, to) => this.range(curve, k, i, Math.max(0, from), Math.min(this.dt[i], to), out);
    while (i <= last) {
      if (i % AT_ONCE === 0 && i > 0 && i + AT_ONCE <= last) {
        const [low, high] = this.blocksOf(curve, k), b = i / AT_ONCE;
        note(out, low[b]);
        note(out, high[b]);
        i += AT_ONCE;
      } else {
        inside(i, begin - this.t[i], end - this.t[i]);
        i++;
      }
    }
    return out;
  }
}

function note(range, value) {
  if (value < range[0]) range[0] = value;
  if (value > range[1]) range[1] = value;
}

// A motion too long to be kept piece by piece: least and greatest values per interval of time.
class EnvelopeMotion {
  constructor(facts, columns, prefix, programmed, axes) {
    this.facts = facts;
    this.programmed = programmed;
    this.axes = axes;
    this.width = facts.envelope_width;
    this.move = columns[prefix + 'move'];
    this.n = this.move.length;
    this.duration = facts.cycle_time;
    const each = (letter, side) => axes.map((_, k) => columns[prefix + letter + k + side]);
    this.p = axes.map((_, k) => columns[prefix + 'p' + k]);
    this.low = { s: [columns[prefix + 'slo']], d: [columns[prefix + 'dlo']] };
    this.high = { s: [columns[prefix + 'shi']], d: [columns[prefix + 'dhi']] };
    for (const letter of 'vaj') {
      this.low[letter] = each(letter, 'lo');
      this.high[letter] = each(letter, 'hi');
    }
  }
  find(time) { return Math.max(0, Math.min(this.n - 1, Math.floor(time / this.width))); }
  state(time) {
    const i = this.find(time), share = Math.min(1, Math.max(0, time / this.width - i));
    const next = Math.min(this.n - 1, i + 1);
    const pick = letter => this.axes.map((_, k) => {
      const [low, high] = [this.low[letter][k][i], this.high[letter][k][i]];
      return Math.abs(high) > Math.abs(low) ? high : low;
    });
    return {
      piece: i, move: this.move[i], v: pick('v'), a: pick('a'), j: pick('j'),
      p: this.p.map(axis => axis[i] + (axis[next] - axis[i]) * share),
      speed: this.high.s[0][i], deviation: this.high.d[0][i],
    };
  }
  extremes(curve, k, begin, end) {
    const out = [Infinity, -Infinity], last = this.find(end);
    const axis = curve === 's' || curve === 'd' ? 0 : k;
    for (let i = this.find(begin); i <= last; i++) {
      note(out, this.low[curve][axis][i]);
      note(out, this.high[curve][axis][i]);
    }
    return out;
  }
}

function motionsOf(meta, columns, programmed) {
  return meta.motions.map((facts, index) => {
    const kind = facts.envelope_width ? EnvelopeMotion : PieceMotion;
    const motion = new kind(facts, columns, 'm' + index, programmed, meta.axes);
    const column = name => columns['m' + index + name];
    motion.spent = {
      line: column('line'), first: column('first'), time: column('time'), ideal: column('ideal'),
      lost: [0, 1, 2, 3].map(cause => column('lost' + cause)),
    };
    return motion;
  });
}
